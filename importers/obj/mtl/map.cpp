#include "importers/obj/mtl/map.h"

#include "base/memory.h"
#include "image/texels.h"
#include "importers/obj/text/encoding.h"
#include "importers/obj/text/words.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <utility>

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
    {"-mm", 2},
    {"-o", 3},
    {"-s", 3},
    {"-t", 3},
    {"-texres", 1},
    {"-clamp", 1},
    {"-bm", 1},
    {"-imfchan", 1},
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

// -s and -o in u' = scale u + offset, as other readers of the format take them.
bool apply_numbers(const Option& option, const std::vector<std::string_view>& words,
                   MapOperands& result) {
    const auto given = [&](std::size_t i, double fallback) {
        return i < words.size() ? double(number(words[i])) : fallback;
    };
    auto& t = result.transform;
    if (option.name == "-s") {
        if (given(0, 1) == 0 || given(1, 1) == 0) return false;
        t[0] = given(0, 1);
        t[4] = given(1, 1);
    } else if (option.name == "-o") {
        t[2] = given(0, 0);
        t[5] = given(1, 0);
    } else if (option.name == "-mm") {
        result.base = given(0, 0);
        result.gain = given(1, 1);
    } else if (option.name == "-bm") {
        result.bump = given(0, 1);
    } else {
        return false;
    }
    return true;
}

void apply(const Option& option, const std::vector<std::string_view>& words, MapOperands& result) {
    std::string given;
    for (const std::string_view word : words) (given += given.empty() ? "" : " ") += word;
    const std::string folded = lower_case(given);
    if (option.name == "-clamp")
        result.clamp = folded == "on";
    else if (option.name == "-imfchan" && folded.size() == 1 &&
             std::string_view("rgbml").find(folded) != std::string_view::npos)
        result.channel = folded.front();
    else if (!apply_numbers(option, words, result) && !is_harmless(option, words, given))
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
    MapOperands result;
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

TextureReader::TextureReader(ModelFolders of_model, Scene& into, LossTally& lost)
    : folders_(std::move(of_model)), scene_(into), tally_(lost) {}

Raster TextureReader::decode(const fs::path& file) const {
    return decode_image(read_allowed(folders_, file, max_texture_size), file.string());
}

// A name may have a comment behind it, or hold what looks like one.
Found TextureReader::locate(const MtlEntry& entry, const std::string& name) const {
    Found found = find_below(folders_, entry.from, name);
    const std::string_view bare = name_without_comment(name);
    if (found.file.empty() && found.refusal.empty() && bare != name)
        found = find_below(folders_, entry.from, bare);
    return found;
}

fs::path TextureReader::file(const MtlEntry& entry, const Statement& statement) const {
    const std::string name = parse_map(statement.operands).file;
    return name.empty() ? fs::path() : locate(entry, name).file;
}

void TextureReader::expect(const MtlEntry& entry, const Statement& statement) {
    const fs::path file = this->file(entry, statement);
    if (!file.empty()) store_.expect(file.string(), [this, file] { return decode(file); });
}

std::optional<MapImage> TextureReader::open(const MtlEntry& entry, const Statement& statement) {
    MapImage image = {
        .word = statement.word, .line = statement.line, .operands = parse_map(statement.operands)};
    const std::string& file = image.operands.file;
    const auto named = fmt::format("'{}'", printable(file));
    const auto note = [&](Loss::Kind kind, const std::string& what) {
        note_loss(tally_, entry, {kind, statement.line, fmt::format("texture {}", what)});
        return std::nullopt;
    };
    if (file.empty()) return note(Loss::dropped, "without a file name is ignored");
    const Found found = locate(entry, file);
    if (found.file.empty())
        return note(Loss::dropped,
                    fmt::format("{} {}{}", named,
                                found.refusal.empty() ? "is not found" : found.refusal,
                                statement.key == "map_kd" ? "; the plain colour is used" : ""));
    if (!found.refusal.empty())  // another file is used
        note(Loss::approximated, fmt::format("{} {}", named, found.refusal));
    image.file = found.file;
    try {
        raster(image);
    } catch (const MemoryError&) {
        throw;
    } catch (const Error& error) {
        broken_.try_emplace(image.file.string(), error.what());
        return note(Loss::dropped, fmt::format("is ignored: {}", error.what()));
    }
    for (const std::string& option : image.operands.ignored)
        note_loss(tally_, entry,
                  {Loss::dropped, statement.line,
                   fmt::format("option {} of {} is ignored", option, printable(statement.word))});
    return image;
}

const Raster& TextureReader::raster(const MapImage& image) {
    const std::string file = image.file.string();
    if (const Raster* raster = store_.find(scene_, file)) return *raster;
    if (const auto found = broken_.find(file); found != broken_.end())
        throw Error(Failure::input, "", found->second);
    store_.add(file, decode(image.file));
    return *store_.find(scene_, file);
}

Index TextureReader::texture(const MapImage& image, bool srgb) {
    const MapOperands& operands = image.operands;
    if (operands.is_ranged())
        return derived(image, fmt::format("mm {} {} {}", operands.base, operands.gain, srgb), srgb,
                       [&] { return remapped(raster(image), operands.base, operands.gain); });
    const std::string file = image.file.string();
    const auto [place, fresh] =
        known_.try_emplace(fmt::format("{} {} {}", operands.clamp, srgb, file), no_index);
    if (!fresh) return place->second;
    raster(image);
    const Wrap wrap = operands.clamp ? Wrap::clamp : Wrap::repeat;
    return place->second = store_.place(scene_, file,
                                        {.name = in_utf8(image.file.filename().string()),
                                         .srgb = srgb,
                                         .wrap_u = wrap,
                                         .wrap_v = wrap});
}

Index TextureReader::derived(const MapImage& image, const std::string& use, bool srgb,
                             const std::function<Raster()>& make) {
    const auto [place, fresh] = known_.try_emplace(
        fmt::format("{} {} {}", image.operands.clamp, use, image.file.string()), no_index);
    if (!fresh) return place->second;
    const Wrap wrap = image.operands.clamp ? Wrap::clamp : Wrap::repeat;
    const MemoryClaim claim(this->raster(image).data.size(), image.file.string());
    Raster raster = make();
    scene_.textures.push_back(
        {.name = in_utf8(image.file.stem().string()) + '_' + use.substr(0, use.find(' ')),
         .raster = std::move(raster),
         .srgb = srgb,
         .wrap_u = wrap,
         .wrap_v = wrap});
    return place->second = Index(scene_.textures.size() - 1);
}

}  // namespace penumbra::obj
