// The documents that say what is carried over say it of the program as it is.
#include "manifest.h"
#include "support.h"

#include <algorithm>
#include <regex>

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

TEST_CASE("docs/mapping.md, names every glTF extension that the importer knows") {
    const std::string code =
        test::read(test::fs::path(PENUMBRA_SOURCE_DIR) / "importers/gltf_asset.cpp");
    const std::string document = mapping();
    const std::regex extension("\"((KHR|EXT)_[A-Za-z_]+)\"");
    for (std::sregex_iterator name(code.begin(), code.end(), extension), end; name != end; ++name) {
        std::string wanted = (*name)[1];
        if (wanted == "KHR_materials_") continue;
        const std::string shortened = wanted.substr(std::string("KHR_materials").size());
        INFO("docs/mapping.md does not mention " << wanted);
        CHECK((document.find(wanted) != document.npos ||
               (wanted.starts_with("KHR_materials") && document.find(shortened) != document.npos)));
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
