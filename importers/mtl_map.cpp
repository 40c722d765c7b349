#include "file.h"
#include "obj.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

namespace penumbra::obj {

namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t max_texture_size = std::uintmax_t(256) << 20;

// An option of a texture statement and how many operands may follow it; those of -s, -o and -t are
// one to three numbers.
struct Option {
    std::string_view name = {};
    int operands = 1;
    std::string_view harmless = {};  // operands that change nothing
};

constexpr auto options = std::to_array<Option>({
    {"-blendu", 1, "on"},
    {"-blendv", 1, "on"},
    {"-boost", 1},
    {"-mm", 2, "0 1"},
    {"-o", 3},
    {"-s", 3},
    {"-t", 3},
    {"-texres", 1},
    {"-clamp", 1},
    {"-bm", 1, "1"},
    {"-imfchan", 1, "l"},
    {"-type", 1},
    {"-cc", 1},
    {"-colorspace", 1, "srgb"},
});

const Option* option_of(std::string_view word) {
    const std::string folded = lower_case(word);
    const auto found = std::ranges::find(options, folded, &Option::name);
    return found == options.end() ? nullptr : &*found;
}

float number(std::string_view word) {
    if (word.starts_with('+')) word.remove_prefix(1);
    float value = 0;
    std::from_chars(word.data(), word.data() + word.size(), value);
    return value;
}

// The operands that belong to `option`, taken off `rest`.
std::vector<std::string_view> operands_of(const Option& option, std::string_view& rest) {
    const bool flexible = option.operands == 3;
    std::vector<std::string_view> result;
    while (int(result.size()) < option.operands) {
        std::string_view ahead = rest;
        const std::string_view word = next_word(ahead);
        if (word.empty() || (flexible && kind_of(word) != Word::number)) break;
        result.push_back(word);
        rest = ahead;
    }
    return result;
}

// Whether the operands say what holds without the option.
bool is_harmless(const Option& option, const std::vector<std::string_view>& words,
                 const std::string& given) {
    if (option.name == "-t")
        return std::ranges::all_of(words, [](auto word) { return number(word) == 0; });
    return lower_case(given) == option.harmless;
}

// In u' = scale u + offset, as other readers of the format take -s and -o.
void apply(const Option& option, const std::vector<std::string_view>& words, MapOperands& result) {
    const auto pair = [&](double fallback) {
        return Vec2(words.empty() ? fallback : double(number(words[0])),
                    words.size() < 2 ? fallback : double(number(words[1])));
    };
    std::string given;
    for (const std::string_view word : words) (given += given.empty() ? "" : " ") += word;
    if (option.name == "-clamp")
        result.clamp = lower_case(given) == "on";
    else if (option.name == "-s")
        result.frame.scale = pair(1);
    else if (option.name == "-o")
        result.frame.offset = pair(0);
    else if (!is_harmless(option, words, given))
        result.ignored.emplace_back(option.name);
}

// Takes options off the front of `rest`.
void take_options(std::string_view& rest, MapOperands& result) {
    for (;;) {
        std::string_view ahead = rest;
        const Option* const option = option_of(next_word(ahead));
        if (!option) return;
        rest = ahead;
        apply(*option, operands_of(*option, rest), result);
    }
}

}  // namespace

MapOperands parse_map(std::string_view operands) {
    MapOperands result = {.frame = {.used = true}};
    take_options(operands, result);
    operands = trim(operands);
    // The name goes on to the first option behind it; blanks may be part of it.
    std::size_t end = operands.size();
    for (std::string_view rest = operands; !rest.empty();) {
        const std::string_view word = next_word(rest);
        if (word.empty() || !option_of(word)) continue;
        end = std::size_t(word.data() - operands.data());
        break;
    }
    std::string_view behind = operands.substr(end);
    take_options(behind, result);
    result.file = trim(operands.substr(0, end));
    return result;
}

TextureReader::TextureReader(const fs::path& model, Scene& into, Losses& lost)
    : folder(model.parent_path()), scene(into), losses(lost) {}

Index TextureReader::read(const MtlEntry& entry, const Statement& statement,
                          const MapOperands& operands) {
    const auto lose = [&](const std::string& what) {
        losses.push_back({place_of(entry.file, statement.line),
                          fmt::format("material '{}': texture {}", printable(entry.name), what)});
        return no_index;
    };
    const auto named = fmt::format("'{}'", printable(operands.file));
    if (operands.file.empty()) return lose("without a file name is ignored");
    Found found = find_below(folder, entry.from, operands.file);
    const std::string_view bare = name_without_comment(operands.file);
    if (found.file.empty() && found.refusal.empty() && bare != operands.file)
        found = find_below(folder, entry.from, bare);
    if (found.file.empty())
        return lose(fmt::format("{} {}; the plain colour is used", named,
                                found.refusal.empty() ? "is not found" : found.refusal));
    if (!found.refusal.empty()) lose(fmt::format("{} {}", named, found.refusal));

    const std::string file = found.file.string();
    const auto [entry_of_file, fresh] = known.try_emplace({file, operands.clamp}, no_index);
    if (!fresh && entry_of_file->second != no_index) return entry_of_file->second;
    try {
        Texture texture = {.name = found.file.filename().string()};
        texture.raster = decode_image(read_bytes(found.file, max_texture_size), file);
        texture.wrap_u = texture.wrap_v = operands.clamp ? Wrap::clamp : Wrap::repeat;
        scene.textures.push_back(std::move(texture));
        entry_of_file->second = Index(scene.textures.size() - 1);
        return entry_of_file->second;
    } catch (const Error& error) {
        return lose(fmt::format("is ignored: {}", error.what()));
    }
}

}  // namespace penumbra::obj
