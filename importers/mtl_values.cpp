#include "obj.h"

#include <fmt/format.h>
#include <tiny_obj_loader.h>

#include <algorithm>
#include <charconv>
#include <cmath>
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

bool names_a_texture(std::string_view key) {
    constexpr auto others =
        std::to_array<std::string_view>({"bump", "disp", "decal", "refl", "norm"});
    return key.starts_with("map_") || std::ranges::find(others, key) != others.end();
}

// The statements of one material, checked, with the numbers that tinyobjloader reads from them.
struct Reader {
    struct Given {
        const Key* key = nullptr;
        std::string words = {};
        Index line = 0;
    };
    const MtlEntry& entry;
    MaterialTally& tally;
    std::map<std::string, Given, std::less<>> given = {};  // by folded key; the last one counts
    std::vector<std::string> told = {};

    // One Loss a key.
    void lose(std::string_view key, Index line, const std::string& what) {
        if (std::ranges::find(told, key) != told.end()) return;
        told.emplace_back(key);
        tally.add(entry, line, what);
    }

    void numbers(const Key& key, const Statement& statement) {
        std::string_view rest = without_comment(statement.operands);
        std::string_view ahead = rest;
        const std::string first = lower_case(next_word(ahead));
        if (first == "spectral" || first == "xyz")
            return lose(key.folded, statement.line,
                        fmt::format("{} {} is ignored: only RGB is read", key.spelled, first));
        Given result = {.key = &key, .line = statement.line};
        std::string_view last;
        int count = 0;
        for (auto word = next_word(rest); !word.empty(); word = next_word(rest)) {
            if (key.folded == "d" && word == "-halo") {
                lose("-halo", statement.line, "the halo of d is ignored");
                continue;
            }
            if (kind_of(word) != Word::number)
                return lose(key.folded, statement.line,
                            fmt::format("{} '{}' is not a number and is ignored", key.spelled,
                                        printable(statement.operands)));
            if (++count > key.operands) break;
            (result.words += ' ') += last = word;
        }
        if (count == 0)
            return lose(key.folded, statement.line,
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
        lose(statement.key, statement.line,
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
                lose("tr", line, "Tr contradicts d; d is used");
            given.erase("tr");
        } else if (single("tr") >= 1) {
            lose("tr", line, "Tr 1 would make it invisible; it is taken as opaque");
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
            lose(folded, at->second.line,
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

    // Part of the PBR extension that a Phong surface cannot show.
    void lose_layers(const tinyobj::material_t& read) {
        const auto layers = std::to_array<std::pair<std::string_view, double>>({
            {"ps", read.sheen},
            {"aniso", read.anisotropy},
        });
        for (const auto& [folded, amount] : layers) {
            const auto at = given.find(folded);
            if (at != given.end() && amount != 0)
                lose(folded, at->second.line,
                     fmt::format("{} is ignored", at->second.key->spelled));
        }
    }
};

}  // namespace

MtlValues read_values(const MtlEntry& entry, MaterialTally& tally) {
    Reader reader = {.entry = entry, .tally = tally};
    MtlValues values;
    for (const Statement& statement : entry.statements) reader.read(statement, values);
    reader.choose_transparency();
    const tinyobj::material_t read = reader.parse();
    values.ambient = reader.color("ka", read.ambient);
    values.diffuse = reader.color("kd", read.diffuse);
    values.specular = reader.color("ks", read.specular);
    values.emission = reader.color("ke", read.emission);
    values.filter = reader.color("tf", read.transmittance);
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
