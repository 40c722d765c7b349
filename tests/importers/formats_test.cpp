// The table of formats, and what follows from it.
#include "importers/gltf/gltf_builder.h"
#include "importers/obj/obj_files.h"
#include "support/inputs.h"

#include <fmt/format.h>

#include <map>

using namespace penumbra;

namespace {

// A small model for each extension.
const std::map<std::string, std::string>& examples() {
    static const std::map<std::string, std::string> all = {
        {".gltf", test::triangle().text()},
        {".glb", test::triangle().glb()},
        {".obj", test::quad + "f 1 2 3 4\n"},
    };
    return all;
}

}  // namespace

TEST_CASE("Formats, are read by extension and named as in the table") {
    std::size_t extensions = 0;
    for (const Format& format : formats())
        for (const std::string& extension : format.extensions) {
            INFO(extension);
            ++extensions;
            test::Inputs inputs;
            inputs.file("model" + extension, examples().at(extension));
            const Imported imported = inputs.load({"model" + extension});
            CHECK(imported.models.at(0).format == format.name);
            CHECK(imported.scene.meshes.size() == 1);
        }
    CHECK(extensions == examples().size());
}

TEST_CASE("Formats, are told in upper case too") {
    test::Inputs inputs;
    inputs.file("MODEL.OBJ", examples().at(".obj"));
    CHECK(inputs.load({"MODEL.OBJ"}).models.at(0).format == "OBJ");
}
