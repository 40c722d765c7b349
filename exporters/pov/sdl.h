// Words of POV-Ray's scene description language: numbers, vectors, colours, names, comments.
#pragma once

#include "penumbra/math.h"

#include <cstddef>
#include <map>
#include <string>
#include <string_view>

namespace penumbra::sdl {

/// Appends the shortest text that reads back as `value`, independent of the locale; 0 for -0.
void append(std::string& out, float value);
void append(std::string& out, double value);
void append(std::string& out, std::size_t value);

/// Appends `value` to ten decimals. POV-Ray keeps texture coordinates in double, so the shortest
/// text of a float ("0.1") would be another number there.
void append_fixed(std::string& out, float value);

template <class Number>
std::string number(Number value) {
    std::string out;
    append(out, value);
    return out;
}

/// "<1, 2, 3>"
std::string vector(const Vec3& v);

/// "rgb 0.5" for a grey, else "rgb <0.1, 0.2, 0.3>"; "rgbt <0.1, 0.2, 0.3, 0.5>" when something is
/// transmitted.
std::string color(const Color& c, float transmit = 0);

/// `text` as it may stand behind "//" or between "/*" and "*/": one line of printable ASCII, at
/// most `longest` characters.
std::string comment(std::string_view text, std::size_t longest = 100);

/// `text` as part of an identifier or of a file name: ASCII letters, digits and single underscores,
/// at most 48 characters; may be empty.
std::string word(std::string_view text);

/// Hands out words, each only once. Case makes no difference, for file systems where it makes none.
class Names {
  public:
    /// word(text), or `fallback` when that is empty; with a number behind it when it is taken.
    std::string unique(std::string_view text, std::string_view fallback);

  private:
    std::map<std::string, int> taken_ = {};  ///< lower-case word -> how often it was asked for
};

}  // namespace penumbra::sdl
