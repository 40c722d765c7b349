#include "importers/obj/mtl/values.h"

#include "importers/obj/text/encoding.h"
#include "importers/obj/text/words.h"

#include <fmt/format.h>
#include <tiny_obj_loader.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>
#include <span>
#include <sstream>

namespace penumbra::obj {

namespace {

// A statement with numbers: how tinyobjloader spells it and what it may hold.
struct Key {
    std::string_view folded = {};
    std::string_view spelled = {};
    int operands = 1;
    double most = std::numeric_limits<float>::max();  // of one operand; the least is 0
};

constexpr auto keys = std::to_array<Key>({
    {"ka", "Ka", 3},
    {"kd", "Kd", 3},
    {"ks", "Ks", 3},
    {"ke", "Ke", 3},
    {"tf", "Tf", 3},
    {"ns", "Ns"},
    {"ni", "Ni"},
    {"d", "d", 1, 1},
    {"tr", "Tr", 1, 1},
    {"illum", "illum", 1, 10},
    {"pr", "Pr", 1, 1},
    {"pm", "Pm", 1, 1},
    {"ps", "Ps"},
    {"pc", "Pc", 1, 1},
    {"pcr", "Pcr", 1, 1},
    {"aniso", "aniso"},
    {"anisor", "anisor"},
});

// The statements of one material, checked, with the numbers that tinyobjloader reads from them.
struct Reader {
    struct Given {
        const Key* key = nullptr;
        std::string words = {};
        Index line = 0;
    };
    const MtlEntry& entry;
    LossTally& tally;
    std::map<std::string, Given, std::less<>> given = {};  // by folded key; the last one counts
    bool counts_to_255 = false;                            // a share() does

    // One Loss a key.
    void note_loss(Loss::Kind kind, std::string_view key, Index line, const std::string& what) {
        obj::note_loss(tally, entry, {kind, line, what, std::string(key)});
    }

    void numbers(const Key& key, const Statement& statement) {
        std::string_view rest = without_comment(statement.operands);
        std::string_view ahead = rest;
        const std::string first = lower_case(next_word(ahead));
        if (first == "spectral" || first == "xyz")
            return note_loss(Loss::dropped, key.folded, statement.line,
                             fmt::format("{} {} is ignored: only RGB is read", key.spelled, first));
        Given result = {.key = &key, .line = statement.line};
        std::string_view last;
        int count = 0;
        for (auto word = next_word(rest); !word.empty(); word = next_word(rest)) {
            if (key.folded == "d" && word == "-halo") {
                note_loss(Loss::dropped, "-halo", statement.line, "the halo of d is ignored");
                continue;
            }
            if (kind_of(word) != Word::number)
                return note_loss(Loss::dropped, key.folded, statement.line,
                                 fmt::format("{} '{}' is not a number and is ignored", key.spelled,
                                             printable(statement.operands)));
            if (++count > key.operands) break;
            (result.words += ' ') += last = word;
        }
        if (count == 0)
            return note_loss(Loss::dropped, key.folded, statement.line,
                             fmt::format("{} without a number is ignored", key.spelled));
        for (; count < key.operands; ++count) (result.words += ' ') += last;  // "Kd 0.5" is grey
        given[std::string(key.folded)] = std::move(result);
    }

    void read(const Statement& statement, MtlValues& values) {
        if (names_a_texture(statement.key)) {
            values.maps.push_back(statement);
            return;
        }
        const auto key = std::ranges::find(keys, statement.key, &Key::folded);
        if (key != keys.end()) return numbers(*key, statement);
        note_loss(Loss::dropped, statement.key, statement.line,
                  fmt::format("{} is ignored", printable(statement.word)));
    }

    double single(std::string_view key) const {
        std::string_view word = given.find(key)->second.words;
        word.remove_prefix(word.find_first_not_of(" +"));
        double value = 0;
        std::from_chars(word.data(), word.data() + word.size(), value);
        return value;
    }

    // tinyobjloader keeps d and 1 - Tr in one member. d wins: Tr is not part of the format. Some
    // programs write Tr where they mean d, and a material that nobody can see is not meant.
    void choose_transparency() {
        if (!given.contains("tr")) return;
        const Index line = given.find("tr")->second.line;
        if (given.contains("d")) {
            if (!(std::abs(single("d") + single("tr") - 1) <= 1e-3))
                note_loss(Loss::approximated, "tr", line, "Tr contradicts d; d is used");
            given.erase("tr");
        } else if (single("tr") >= 1) {
            note_loss(Loss::approximated, "tr", line,
                      "Tr 1 would make it invisible; it is taken as opaque");
            given.erase("tr");
        }
    }

    tinyobj::material_t parse() const {
        std::string text = "newmtl m\n";
        for (const auto& [folded, statement] : given)
            ((text += statement.key->spelled) += statement.words) += '\n';
        std::istringstream stream(text);
        std::map<std::string, int> names;
        std::vector<tinyobj::material_t> materials;
        std::string warnings, errors;
        tinyobj::LoadMtl(&names, &materials, &stream, &warnings, &errors);
        return materials.at(0);
    }

    // A number that tinyobjloader read, if the file has it, brought into its range.
    std::optional<float> value(std::string_view folded, double read) {
        const auto at = given.find(folded);
        if (at == given.end()) return {};
        const Key& key = *at->second.key;
        const double inside = std::isnan(read) ? 0 : std::clamp(read, 0.0, key.most);
        if (inside != read)
            note_loss(Loss::approximated, folded, at->second.line,
                      fmt::format("{} {:.4g} is out of range; {:.4g} is used", key.spelled, read,
                                  inside));
        return float(inside);
    }

    std::optional<Color> color(std::string_view folded, const double* read) {
        if (!given.contains(folded)) return {};
        Color result(0);
        for (int i = 0; i < 3; ++i) result[i] = *value(folded, read[i]);
        return result;
    }

    // A share of light. A little more than 1 is an artist's; much more is what a program writes
    // that counts to 255, as it does in colours of vertices.
    std::optional<Color> share(std::string_view folded, const double* read) {
        std::optional<Color> result = color(folded, read);
        constexpr float most = 2;
        if (!result || std::max({result->x, result->y, result->z}) <= most) return result;
        const auto& [key, words, line] = given.find(folded)->second;
        note_loss(Loss::approximated, std::string(folded) + " scale", line,
                  fmt::format("{} exceeds 1; it is taken as 0 to 255", key->spelled));
        for (float& part : std::span(&(*result)[0], 3)) part = std::min(part / 255, 1.0F);
        counts_to_255 = true;
        return result;
    }

    // Part of the PBR extension that a Phong surface cannot show.
    void lose_layers(const tinyobj::material_t& read) {
        const auto layers = std::to_array<std::pair<std::string_view, double>>({
            {"ps", read.sheen},
            {"aniso", read.anisotropy},
        });
        for (const auto& [folded, amount] : layers) {
            const auto at = given.find(folded);
            if (at != given.end() && amount != 0)
                note_loss(Loss::dropped, folded, at->second.line,
                          fmt::format("{} is ignored", at->second.key->spelled));
        }
    }
};

}  // namespace

bool names_a_texture(std::string_view key) {
    constexpr auto others =
        std::to_array<std::string_view>({"bump", "disp", "decal", "refl", "norm"});
    return key.starts_with("map_") || std::ranges::find(others, key) != others.end();
}

MtlValues read_values(const MtlEntry& entry, LossTally& tally) {
    Reader reader = {.entry = entry, .tally = tally};
    MtlValues values;
    for (const Statement& statement : entry.statements) reader.read(statement, values);
    reader.choose_transparency();
    const tinyobj::material_t read = reader.parse();
    values.diffuse = reader.share("kd", read.diffuse);
    values.specular = reader.share("ks", read.specular);
    values.filter = reader.share("tf", read.transmittance);
    // Alone it may be what makes a lamp bright.
    values.ambient =
        reader.counts_to_255 ? reader.share("ka", read.ambient) : reader.color("ka", read.ambient);
    values.emission = reader.color("ke", read.emission);
    values.shininess = reader.value("ns", read.shininess);
    values.ior = reader.value("ni", read.ior);
    values.dissolve = reader.value("d", read.dissolve);
    // An out of range Tr was clamped as the d that it stands for.
    if (!values.dissolve) values.dissolve = reader.value("tr", read.dissolve);
    values.roughness = reader.value("pr", read.roughness);
    values.metallic = reader.value("pm", read.metallic);
    values.coat = reader.value("pc", read.clearcoat_thickness);
    values.coat_roughness = reader.value("pcr", read.clearcoat_roughness);
    if (const auto illum = reader.value("illum", read.illum)) values.illum = int(*illum);
    reader.lose_layers(read);
    return values;
}

}  // namespace penumbra::obj
