// TOML -> typed values. Whatever is wrong is thrown with the place where it stands.
#pragma once

#include "penumbra/error.h"
#include "penumbra/math.h"

#include <toml++/toml.h>

#include <array>
#include <filesystem>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace penumbra {

/// One TOML document that is laid over the scene: a sidecar, or a single "KEY=VALUE" setting.
struct Layer {
    std::string name = {};              ///< the file as the user wrote it; "setting 'KEY=VALUE'"
    std::filesystem::path folder = {};  ///< where relative paths start
    bool setting = false;
    std::string text = {};  ///< of a setting: the value as written
    toml::table table = {};
};

/// Throws Error (input).
Layer read_sidecar(const std::filesystem::path& file);

/// Reads "light.0.intensity=2". A value that is no TOML value is a string: "camera.name=Left door".
/// Names with dots are quoted: "material.'a.b'.color=..." Throws Error (usage).
Layer read_setting(const std::string& setting);

/// What a number may be.
struct Range {
    double low = -std::numeric_limits<double>::infinity();
    double high = std::numeric_limits<double>::infinity();
    bool open_low = false, open_high = false;  ///< the bound itself is excluded
    bool contains(double value) const;         ///< false for NaN and infinities
};
inline constexpr Range any_number = {};
inline constexpr Range positive = {.low = 0, .open_low = true};
inline constexpr Range non_negative = {.low = 0};
inline constexpr Range fraction = {.low = 0, .high = 1};

/// Where the author of a document named something, for messages about the name.
struct Reference {
    Failure failure = Failure::input;
    std::string place = {}, name = {};
};

/// One table of a Layer. Every `read` leaves `value` as it is and returns false when the key is
/// absent; it throws Error when the key has a value of the wrong type or out of range. Asking for a
/// key makes it known: call finish() after the last one.
class Section {
  public:
    /// `title` as messages show it: "[[sphere]]", "penumbra of [[light]]"; "" for the top level.
    Section(const Layer& layer, const toml::table& table, std::string title = "");

    bool has(const std::string& key);
    bool read(const std::string& key, double& value, const Range& range = any_number);
    bool read(const std::string& key, float& value, const Range& range = any_number);
    bool read(const std::string& key, int& value, const Range& range);
    bool read(const std::string& key, bool& value);
    bool read(const std::string& key, std::string& value);
    bool read(const std::string& key, Vec3& value);
    bool read(const std::string& key, std::array<int, 2>& value, const Range& range);
    bool read(const std::string& key, std::optional<Reference>& value);
    bool read_color(const std::string& key, Color& value);
    bool read_colors(const std::string& key, std::array<Color, 2>& value);
    /// A number for all channels, or a colour.
    bool read_factor(const std::string& key, Color& value);
    /// Degrees in the file, radians in `value`.
    bool read_angle(const std::string& key, double& value, const Range& degrees);
    /// One number for all three, or three numbers.
    bool read_scale(const std::string& key, Vec3& value);
    bool read_numbers(const std::string& key, std::span<double> values, const std::string& form);

    /// A list of strings.
    bool read(const std::string& key, std::vector<std::string>& value);
    /// A list of lists of `count` numbers each.
    bool read_rows(const std::string& key, std::size_t count,
                   std::vector<std::vector<double>>& rows, const std::string& form);
    /// The keys that are there, in order; they count as asked for.
    std::vector<std::string> keys();

    /// One of a few words.
    template <class Enum, std::size_t n>
    bool read(const std::string& key, Enum& value,
              const std::pair<const char*, Enum> (&choices)[n]) {
        std::vector<std::string> words;
        for (const auto& choice : choices) words.emplace_back(choice.first);
        const auto chosen = choose(key, words);
        if (chosen) value = choices[*chosen].second;
        return chosen.has_value();
    }

    /// The table under `key`.
    std::optional<Section> table(const std::string& key);
    /// The list of tables [[key]].
    std::vector<Section> list(const std::string& key);
    /// In a setting, the tables `key.0`, `key.1`, ... with their index, which must be below
    /// `count`; empty when `key` is no table. `things` are what is counted: "lights".
    std::vector<std::pair<Index, Section>> edits(const std::string& key, std::size_t count,
                                                 std::string_view things);
    /// The tables [key.NAME] with their names.
    std::vector<std::pair<std::string, Section>> named(const std::string& key);

    bool is_string(const std::string& key);
    bool is_number(const std::string& key);
    bool is_table(const std::string& key);
    bool is_false(const std::string& key);

    /// Throws Error when the table has a key that nobody asked for.
    void finish() const;
    /// Throws Error unless `key` is there.
    void require(const std::string& key);

    /// Throws Error about the value of `key`; about the table when it has no such key.
    [[noreturn]] void fail(const std::string& key, const std::string& problem) const;
    /// Throws Error: "'radius' in [[sphere]] <problem>".
    [[noreturn]] void reject(const std::string& key, const std::string& problem) const;

    const Layer& layer() const { return *source_; }
    const std::string& title() const { return heading_; }

  private:
    const toml::node* find(const std::string& key);
    double number(const std::string& key, const toml::node& node, const Range& range) const;
    double measure(const std::string& key, const toml::node& node, const Range& range) const;
    int whole(const std::string& key, const toml::node& node, const Range& range) const;
    Color color(const std::string& key, const toml::node& node) const;
    std::optional<std::size_t> choose(const std::string& key,
                                      const std::vector<std::string>& words);
    void numbers(const std::string& key, const toml::node& node, std::span<double> values,
                 const std::string& form) const;
    [[noreturn]] void wrong(const std::string& key, const toml::node& node,
                            const std::string& problem) const;
    std::string place(const toml::source_region& region) const;

    const Layer* source_;
    const toml::table* content_;
    std::string heading_;
    std::vector<std::string> known_ = {};
};

}  // namespace penumbra
