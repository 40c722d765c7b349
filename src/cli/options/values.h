// The text of an option -> its value. `option` is for messages; all throw Error (usage).
#pragma once

#include "cli/options/arguments.h"

#include "penumbra/math.h"

#include <array>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace penumbra::cli {

struct Interval {
    double low = 0, high = 0;  ///< inclusive
};

int read_integer(const std::string& option, std::string_view text, Interval range);
double read_number(const std::string& option, std::string_view text, Interval range);

/// Bytes, or with K, M, G or T a multiple of 1024, 1024^2, ...: "512M", "1.5G".
std::size_t read_memory(const std::string& option, std::string_view text);

/// The position of `text` in `words`.
std::size_t read_choice(const std::string& option, std::string_view text,
                        const std::vector<std::string>& words);

/// "800x600".
std::array<int, 2> read_size(const std::string& option, std::string_view text);

/// "0.1,0.2,0.3", linear and not negative.
Color read_color(const std::string& option, const std::string& text);

/// "studio", "hall.hdr" or "0.5,0.5,0.6" as a setting of [environment].
std::string environment_setting(const std::string& text);

/// "10,20,110,220": x0 < x1 and y0 < y1.
PixelBox read_box(const std::string& option, const std::string& text);

/// "bias=0.002".
std::pair<std::string, double> read_limit(const std::string& option, const std::string& text);

/// "Cycles=render.sh --size {width} '{pov}'": a name and a command, split into words as a shell
/// would, of which nothing is expanded.
OtherRenderer read_renderer(const std::string& option, const std::string& text);

/// A TOML basic string of `text`, quotes included.
std::string toml_string(const std::string& text);

/// `words` as a shell command that means them.
std::string shell_command(const std::vector<std::string>& words);

}  // namespace penumbra::cli
