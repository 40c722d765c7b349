// The documents that say what is carried over say it of the program as it is.
#include "support/manifest.h"
#include "support/support.h"

#include <algorithm>
#include <regex>
#include <set>

namespace {

std::string sources() {
    std::string text;
    for (const char* folder : {"src", "importers", "exporters"})
        for (const auto& entry :
             test::fs::recursive_directory_iterator(test::fs::path(PENUMBRA_SOURCE_DIR) / folder))
            if (entry.path().extension() == ".cpp" || entry.path().extension() == ".h")
                text += test::read(entry.path());
    // Sentences may be broken over several literals.
    return std::regex_replace(text, std::regex("\"\\s*\n\\s*\""), "");
}

std::string mapping() {
    return test::read(test::fs::path(PENUMBRA_SOURCE_DIR) / "docs/mapping.md");
}

// A part of a message, and the kind of loss that its statement names before it.
struct Told {
    std::string text = {}, kind = {};
};

std::vector<Told> told_losses(const std::string& code) {
    const std::regex token(R"re(//[^\n]*|'(?:[^'\\\n]|\\.)'|"((?:[^"\\\n]|\\.)*)")re"
                           R"re(|Loss::(approximated|dropped)\b|;)re");
    std::vector<Told> found;
    std::string kind;
    for (std::sregex_iterator at(code.begin(), code.end(), token), end; at != end; ++at) {
        if ((*at)[2].matched)
            kind = (*at)[2];
        else if (at->str() == ";")
            kind.clear();
        else if (!kind.empty() && (*at)[1].matched)
            found.push_back({(*at)[1], kind});
    }
    return found;
}

}  // namespace

TEST_CASE("docs/mapping.md, quotes losses that the program reports") {
    const std::string code = sources(), document = mapping();
    // The last column of a table: | `text` |
    const std::regex quoted("\\| `([^`|]+)` \\|\n");
    std::size_t count = 0;
    for (std::sregex_iterator row(document.begin(), document.end(), quoted), end; row != end;
         ++row, ++count) {
        INFO("no source says \"" << (*row)[1].str() << "\"");
        CHECK(code.find((*row)[1].str()) != code.npos);
    }
    CHECK(count > 20);
}

TEST_CASE(
    "docs/mapping.md, says of every loss whether it is an approximation, as the program does") {
    const std::string document = mapping();
    const std::vector<Told> told = told_losses(sources());
    // The last two columns: | exact | `text` |, where what is not exact then is approximated.
    const std::regex quoted("\\| (exact|approximate|loss)[^|]* \\| `([^`|]+)` \\|\n");
    std::size_t count = 0;
    for (std::sregex_iterator row(document.begin(), document.end(), quoted), end; row != end;
         ++row) {
        std::set<std::string> found;
        for (const Told& each : told)
            if (each.text.find((*row)[2].str()) != std::string::npos) found.insert(each.kind);
        if (found.empty()) continue;  // the statement gets its kind as an argument
        ++count;
        INFO((*row)[2].str());
        CHECK(found == std::set<std::string>{(*row)[1] == "loss" ? "dropped" : "approximated"});
    }
    CHECK(count > 30);
}

TEST_CASE("docs/mapping.md, names every glTF extension that the importer knows") {
    const std::string code =
        test::read(test::fs::path(PENUMBRA_SOURCE_DIR) / "importers/gltf/document/asset.cpp");
    const std::string document = mapping();
    const std::regex extension("\"((KHR|EXT|AGI|FB|MSFT|OMI)_[A-Za-z0-9_]+)\"");
    for (std::sregex_iterator name(code.begin(), code.end(), extension), end; name != end; ++name) {
        std::string wanted = (*name)[1];
        if (wanted == "KHR_materials_") continue;
        INFO("docs/mapping.md does not mention " << wanted);
        // A list of materials leaves out what all of them begin with.
        constexpr std::string_view common = "KHR_materials";
        const bool told = document.find(wanted) != document.npos ||
                          (wanted.starts_with(common) &&
                           document.find(wanted.substr(common.size())) != document.npos);
        CHECK(told);
    }
}

TEST_CASE("docs/fidelity-models.md, has a row with the required figures for every model") {
    if (!test::fs::exists(test::assets() / "MANIFEST.toml"))
        PENUMBRA_SKIP("the models are not here");
    const std::string document =
        test::read(test::fs::path(PENUMBRA_SOURCE_DIR) / "docs/fidelity-models.md");
    std::vector<double> parities;
    for (const std::string& file : test::models_that_load()) {
        INFO(file << ": write docs/fidelity-models.md anew with scripts/fidelity");
        const std::size_t row = document.find("| " + file + " | ");
        REQUIRE(row != std::string::npos);
        const std::string parity = document.substr(row + file.size() + 5, 8);
        if (parity.find_first_not_of("0123456789.") != parity.npos) continue;  // not to be shown
        parities.push_back(std::stod(parity));
        CHECK(parities.back() >= 0.999);
    }
    REQUIRE(parities.size() > 200);
    std::sort(parities.begin(), parities.end());
    CHECK(parities[parities.size() / 2] >= 0.9999);
}
