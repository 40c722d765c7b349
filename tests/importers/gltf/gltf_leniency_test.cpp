// What glTF files get wrong and can be read all the same, with a word about it; and what is newer
// than glTF 2.0.
#include "importers/gltf/gltf_builder.h"

#include <half.h>

#include <cmath>
#include <limits>

using namespace penumbra;
using test::Gltf;
using test::json;
using test::read;

namespace {

const float not_a_number = std::numeric_limits<float>::quiet_NaN();
const float infinite = std::numeric_limits<float>::infinity();
const std::string at_attributes = "box.gltf#/meshes/0/primitives/0/attributes/";

using Triangles = std::vector<std::array<Index, 3>>;

json& primitive_of(Gltf& gltf) { return gltf.root["meshes"][0]["primitives"][0]; }

template <class T>
Gltf with_attribute(const std::string& name, const std::string& type, const std::vector<T>& values,
                    const json& members = {}) {
    Gltf gltf = test::triangle();
    primitive_of(gltf)["attributes"][name] = gltf.accessor(type, values, members);
    return gltf;
}

// Of four points on a line, which are all that a strip or fan needs to show its order.
Gltf indexed(int mode, const std::vector<std::uint8_t>& indices, const std::string& extension) {
    Gltf gltf;
    std::vector<float> points;
    for (int i = 0; i < 8; ++i) points.insert(points.end(), {float(i), float(i % 2), 0});
    const int positions = gltf.accessor("VEC3", points);
    gltf.show({{"attributes", {{"POSITION", positions}}},
               {"indices", gltf.accessor("SCALAR", indices)},
               {"mode", mode}});
    if (!extension.empty())
        gltf.root["extensionsUsed"] = gltf.root["extensionsRequired"] = {extension};
    return gltf;
}

Triangles triangles_of(const Gltf& gltf) {
    const Imported imported = read(gltf);
    CHECK(imported.losses.empty());
    return imported.scene.meshes.at(0).triangles;
}

}  // namespace

TEST_CASE("glTF leniency, puts 0 where texture coordinates are not finite") {
    const Imported imported = read(with_attribute<float>(
        "TEXCOORD_0", "VEC2", {not_a_number, 0.25F, 0.5F, 0.25F, 1, infinite}));
    CHECK(imported.scene.meshes.at(0).texcoords ==
          std::vector<Vec2f>{{0, 0.75F}, {0.5F, 0.75F}, {1, 1}});
    CHECK(imported.losses ==
          Losses{{Loss::approximated, at_attributes + "TEXCOORD_0",
                  "2 of 3 texture coordinates are not finite numbers; 0 takes their place"}});
}

TEST_CASE("glTF leniency, has the facets' normals where normals are not finite") {
    const Imported imported = read(
        with_attribute<float>("NORMAL", "VEC3", {0, 0, 0, 3, 0, 0, 0, infinite, not_a_number}));
    CHECK(imported.scene.meshes.at(0).normals ==
          std::vector<Vec3f>{{0, 0, 1}, {1, 0, 0}, {0, 0, 1}});
    CHECK(imported.losses == Losses{{Loss::approximated, at_attributes + "NORMAL",
                                     "2 of 3 normals have no length or are not finite; those of "
                                     "the facets are used"}});
}

TEST_CASE("glTF leniency, puts 1 where colours are not finite") {
    const Imported imported = read(with_attribute<float>(
        "COLOR_0", "VEC3", {0, not_a_number, 0.5F, 0, 1, 0, -infinite, 0, 0}));
    CHECK(imported.scene.meshes.at(0).colors ==
          std::vector<Color>{{0, 1, 0.5F}, {0, 1, 0}, {1, 0, 0}});
    CHECK(imported.losses ==
          Losses{{Loss::approximated, at_attributes + "COLOR_0",
                  "2 of 3 colours are not finite numbers; 1 takes their place"}});
}

TEST_CASE("glTF leniency, has any tangents where tangents are not finite") {
    Gltf gltf = with_attribute<float>("TANGENT", "VEC4",
                                      {not_a_number, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, not_a_number});
    json& attributes = primitive_of(gltf)["attributes"];
    attributes["NORMAL"] = gltf.accessor("VEC3", std::vector<float>{0, 0, 1, 0, 0, 1, 0, 0, 1});
    attributes["TEXCOORD_0"] = gltf.accessor("VEC2", std::vector<float>{0, 0, 1, 0, 0, 1});
    // An image of one texel.
    gltf.add("images", {{"uri", "data:image/x-portable-pixmap;base64," +
                                    test::base64("P6 1 1 255 \x80\x80\xff")}});
    gltf.add("textures", {{"source", 0}});
    primitive_of(gltf)["material"] = gltf.add("materials", {{"normalTexture", {{"index", 0}}}});
    const Imported imported = read(gltf);
    REQUIRE(imported.scene.meshes.at(0).tangents.size() == 3);
    for (const Tangent& tangent : imported.scene.meshes[0].tangents) {
        CHECK(std::abs(tangent.direction.length() - 1) < 1e-6F);
        CHECK(std::abs(tangent.handedness) == 1);
    }
    CHECK(imported.losses == Losses{{Loss::approximated, at_attributes + "TANGENT",
                                     "1 of 3 tangents have no length or are not finite; any "
                                     "direction is used"}});
}

TEST_CASE("glTF leniency, reads whole numbers of colours as fractions and says so") {
    const std::string said = "its whole numbers are not marked as normalized, as glTF asks; they "
                             "are read as if they were";
    const std::vector<std::uint8_t> bytes = {255, 0, 51, 0, 255, 0, 0, 0, 255};
    Imported imported = read(with_attribute("COLOR_0", "VEC3", bytes));
    CHECK(imported.scene.meshes.at(0).colors ==
          std::vector<Color>{{1, 0, 0.2F}, {0, 1, 0}, {0, 0, 1}});
    CHECK(imported.losses == Losses{{Loss::approximated, at_attributes + "COLOR_0", said}});
    const std::vector<std::uint16_t> words = {65535, 0, 13107, 65535, 0, 0};
    imported = read(with_attribute("TEXCOORD_0", "VEC2", words));
    CHECK(imported.scene.meshes.at(0).texcoords == std::vector<Vec2f>{{1, 1}, {0.2F, 0}, {0, 1}});
    CHECK(imported.losses == Losses{{Loss::approximated, at_attributes + "TEXCOORD_0", said}});
}

TEST_CASE("glTF leniency, leaves whole texture coordinates alone where quantization allows them") {
    Gltf gltf = with_attribute("TEXCOORD_0", "VEC2", std::vector<std::uint16_t>{3, 0, 0, 1, 0, 0});
    gltf.root["extensionsUsed"] = {"KHR_mesh_quantization"};
    const Imported imported = read(gltf);
    CHECK(imported.scene.meshes.at(0).texcoords == std::vector<Vec2f>{{3, 1}, {0, 0}, {0, 1}});
    CHECK(imported.losses.empty());
}

TEST_CASE("glTF leniency, compares versions as numbers") {
    const auto with_versions = [](const json& version, const json& least) {
        Gltf gltf = test::triangle();
        gltf.root["asset"] = {{"version", version}};
        if (!least.is_null()) gltf.root["asset"]["minVersion"] = least;
        return test::problem(gltf);
    };
    CHECK(with_versions("2.0", nullptr).empty());
    CHECK(with_versions("2.0", "1.0").empty());
    CHECK(with_versions("2.0", "0.8").empty());
    CHECK(with_versions("2.123456789", "2.0").empty());
    CHECK(with_versions("2.98765432109876543210", nullptr).empty());
    CHECK(with_versions(2.0, nullptr) ==
          "box.gltf#/asset/version: must be a string such as \"2.0\", but is 2.0");
    CHECK(with_versions("2.0", 2) ==
          "box.gltf#/asset/minVersion: must be a string such as \"2.0\", but is 2");
    for (const std::string wrong : {"2.00", "02.0", "2.", "2", ".0", "", "2.0.1", "2.0-dev", "2.x"})
        CHECK(with_versions(wrong, nullptr) ==
              "box.gltf#/asset/version: is \"" + wrong +
                  "\", but must be two whole numbers without leading zeros, such as \"2.0\"");
    CHECK(with_versions("20.0", nullptr) ==
          "box.gltf#/asset/version: is \"20.0\", only glTF 2 is supported");
    CHECK(with_versions("2.1", "2.1") ==
          "box.gltf#/asset/minVersion: is \"2.1\", only 2.0 is supported");
}

TEST_CASE("glTF leniency, has nothing to say of extensions that change no still picture") {
    for (const char* name :
         {"KHR_interactivity", "KHR_node_selectability", "KHR_node_hoverability", "KHR_xmp_json_ld",
          "EXT_mesh_features", "EXT_structural_metadata", "EXT_instance_features",
          "KHR_physics_rigid_bodies", "KHR_implicit_shapes"}) {
        INFO(name);
        Gltf gltf = test::triangle();
        gltf.root["extensionsUsed"] = gltf.root["extensionsRequired"] = {name};
        gltf.root["nodes"][0]["extensions"][name] = {{"hoverable", false}};
        CHECK(read(gltf).losses.empty());
    }
}

TEST_CASE("glTF leniency, begins strips and fans anew at the largest index") {
    const std::vector<std::uint8_t> indices = {0, 1, 2, 255, 3, 4, 5, 6, 255, 255, 7, 0, 1};
    for (const std::string extension :
         {"KHR_mesh_primitive_restart", "EXT_mesh_primitive_restart"}) {
        CHECK(triangles_of(indexed(5, indices, extension)) ==
              Triangles{{0, 1, 2}, {3, 4, 5}, {4, 6, 5}, {7, 0, 1}});
        CHECK(triangles_of(indexed(6, indices, extension)) ==
              Triangles{{1, 2, 0}, {4, 5, 3}, {5, 6, 3}, {0, 1, 7}});
    }
    CHECK(test::problem(indexed(5, indices, "")) ==
          "box.gltf#/meshes/0/primitives/0/indices: index 255 is used, but there are 8 vertices");
    CHECK(test::problem(indexed(4, {0, 1, 255}, "KHR_mesh_primitive_restart")) ==
          "box.gltf#/meshes/0/primitives/0/indices: index 255 is used, but there are 8 vertices");
}

TEST_CASE("glTF leniency, counts the lines of strips and loops that begin anew") {
    const std::vector<std::uint8_t> indices = {0, 1, 2, 255, 3, 4};
    const auto ignored = [&](int mode) {
        return read(indexed(mode, indices, "KHR_mesh_primitive_restart")).losses.at(0).what;
    };
    CHECK(ignored(3) == "3 lines are ignored");
    CHECK(ignored(2) == "5 lines are ignored");
}

TEST_CASE("glTF leniency, reads doubles about a point near them") {
    const std::vector<double> far = {1e7, 2e7, 0, 1e7 + 0.001, 2e7, 0, 1e7, 2e7 + 0.001, 0};
    Gltf gltf;
    const int positions = gltf.accessor("VEC3", far, {{"componentType", 5130}});
    gltf.show({{"attributes", {{"POSITION", positions}}}});
    gltf.root["extensionsUsed"] = gltf.root["extensionsRequired"] = {"KHR_accessor_float64"};
    const Imported imported = read(gltf);
    CHECK(imported.losses.empty());
    const Mesh& mesh = imported.scene.meshes.at(0);
    const Matrix& world = imported.scene.instances.at(0).transform;
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec3 expected(far[3 * i], far[3 * i + 1], far[3 * i + 2]);
        CHECK((Vec3(mesh.positions.at(i)) * world - expected).length() < 1e-8);
    }
}

TEST_CASE("glTF leniency, refuses doubles that are too large") {
    Gltf gltf;
    const int positions = gltf.accessor("VEC3", std::vector<double>{0, 0, 0, 1, 0, 0, 0, 1e300, 0},
                                        {{"componentType", 5130}});
    gltf.show({{"attributes", {{"POSITION", positions}}}});
    gltf.root["extensionsUsed"] = {"KHR_accessor_float64"};
    CHECK(test::problem(gltf) ==
          "box.gltf#/meshes/0/primitives/0/attributes/POSITION: vertex 2 is too far away");
}

TEST_CASE("glTF leniency, reads half floats, sparse ones as well") {
    std::vector<std::uint16_t> numbers;
    for (const float number : {0.0F, 0.0F, 0.0F, 1.5F, 0.0F, 0.0F, 0.0F, 0.25F, 0.0F})
        numbers.push_back(half(number).bits());
    Gltf gltf;
    const int positions = gltf.accessor("VEC3", numbers, {{"componentType", 5131}});
    const int changed = gltf.view(std::vector<std::uint16_t>{1});
    const int values = gltf.view(std::vector<std::uint16_t>{half(2.0F).bits(), 0, 0});
    gltf.root["accessors"][0]["sparse"] = {
        {"count", 1},
        {"indices", {{"bufferView", changed}, {"componentType", 5123}}},
        {"values", {{"bufferView", values}}}};
    gltf.show({{"attributes", {{"POSITION", positions}}}});
    gltf.root["extensionsUsed"] = gltf.root["extensionsRequired"] = {"KHR_accessor_float16"};
    const Imported imported = read(gltf);
    CHECK(imported.losses.empty());
    CHECK(imported.scene.meshes.at(0).positions ==
          std::vector<Vec3f>{{0, 0, 0}, {2, 0, 0}, {0, 0.25F, 0}});
}

TEST_CASE("glTF leniency, names numbers of a kind that the file does not declare") {
    Gltf gltf;
    const int positions = gltf.accessor("VEC3", std::vector<double>{0, 0, 0, 1, 0, 0, 0, 1, 0},
                                        {{"componentType", 5130}});
    gltf.show({{"attributes", {{"POSITION", positions}}}});
    CHECK(read(gltf).losses == Losses{{Loss::approximated, "box.gltf#/accessors/0/componentType",
                                       "is 5130, which needs KHR_accessor_float64 in "
                                       "extensionsUsed; it is read as if that were there"}});
    gltf.root["asset"]["version"] = "2.1";
    CHECK(read(gltf).losses.empty());
}

TEST_CASE("glTF leniency, names refractive indices that there are none of") {
    const auto said = [](double ior) {
        Gltf gltf = test::triangle();
        primitive_of(gltf)["material"] =
            gltf.add("materials", {{"extensions", {{"KHR_materials_ior", {{"ior", ior}}}}}});
        Losses found = read(gltf).losses;
        std::erase_if(found, [](const Loss& loss) { return !loss.place.ends_with("/ior"); });
        return found;
    };
    CHECK(said(0).empty());
    CHECK(said(1).empty());
    CHECK(said(0.5) ==
          Losses{{Loss::approximated, "box.gltf#/materials/0/extensions/KHR_materials_ior/ior",
                  "is 0.5, but KHR_materials_ior allows 0 and what is at least 1; it is used as it "
                  "is"}});
}

TEST_CASE("glTF leniency, names Gaussian splats and the container of glTF 2.1") {
    Gltf gltf = test::triangle();
    json& primitive = primitive_of(gltf);
    primitive["mode"] = 0;
    primitive["extensions"]["KHR_gaussian_splatting"] = {{"kernel", "ellipse"}};
    gltf.root["extensionsUsed"] = {"KHR_gaussian_splatting"};
    CHECK(
        read(gltf).losses.at(0) ==
        Loss{Loss::dropped, "box.gltf#/meshes/0/primitives/0",
             "its 3 Gaussian splats (KHR_gaussian_splatting) are left out: they have no surface"});
    std::string glb = test::triangle().glb();
    glb[4] = 3;
    CHECK(test::problem(glb, "box.glb") ==
          "box.glb: is GLB 3, the container of glTF 2.1, which is not supported: save it as GLB 2 "
          "or .gltf");
}

TEST_CASE("glTF leniency, names AVIF images that cannot be read, and takes the other one") {
    Gltf gltf = with_attribute<float>("TEXCOORD_0", "VEC2", {0, 0, 1, 0, 0, 1});
    gltf.root["extensionsUsed"] = gltf.root["extensionsRequired"] = {"EXT_texture_avif"};
    gltf.add("images", {{"uri", "data:image/avif;base64,AAAA"}, {"name", "leaf"}});
    gltf.add("textures", {{"extensions", {{"EXT_texture_avif", {{"source", 0}}}}}});
    primitive_of(gltf)["material"] =
        gltf.add("materials", {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}});
    CHECK(read(gltf).losses ==
          Losses{{Loss::dropped, "box.gltf#/textures/0",
                  "the texture is left out, grey stands for its colours: its AVIF image "
                  "(EXT_texture_avif) cannot be read here: leaf: cannot be read as an image "
                  "(unknown format)"}});
    gltf.root["textures"][0]["source"] =
        gltf.add("images", {{"uri", "data:image/x-portable-pixmap;base64," +
                                        test::base64("P6 1 1 255 \x80\x80\xff")}});
    CHECK(read(gltf).losses.empty());
}

TEST_CASE("glTF leniency, reads AVIF images that lie in the file") {
    // 8 x 8 texels of one colour.
    const std::string avif =
        "AAAAHGZ0eXBhdmlmAAAAAGF2aWZtaWYxbWlhZgAAASttZXRhAAAAAAAAACFoZGxyAAAAAAAAAABwaWN0AAAAAAAA"
        "AAAAAAAAAAAAAA5waXRtAAAAAAABAAAANGlsb2MAAAAAREAAAgABAAAAAAFPAAEAAAAAAAAAHgACAAAAAAFtAAEA"
        "AAAAAAAArgAAADhpaW5mAAAAAAACAAAAFWluZmUCAAAAAAEAAGF2MDEAAAAAFWluZmUCAAABAAIAAEV4aWYAAAAA"
        "amlwcnAAAABLaXBjbwAAABNjb2xybmNseAACAAIABoAAAAAMYXYxQ4EADAAAAAAUaXNwZQAAAAAAAAAIAAAACAAA"
        "ABBwaXhpAAAAAAMICAgAAAAXaXBtYQAAAAAAAAABAAEEgYIDhAAAABppcmVmAAAAAAAAAA5jZHNjAAIAAQABAAAA"
        "1G1kYXQSAAoIGAi/YIEBA0IyEBgACiiihAAAr/0k6uz1gMAAAACmRXhpZgAATU0qAAAAAFBvaWlvdG9vbCB0LnBu"
        "ZyAtbyB0LmF2aWYAT3BlbkltYWdlSU8gMi40LjcuMSA6IG9paW90b29sIHQucG5nIC1vIHQuYXZpZgAAAgExAAIA"
        "AAAvAAAAIYdpAAQAAAABAAAAbgAAAAAABJAAAAcAAAAEMDIzMJEBAAcAAAAEAQIDAJITAAIAAAAZAAAACKAAAAcA"
        "AAAEMDEwMAAAAAA=";
    Gltf gltf = with_attribute<float>("TEXCOORD_0", "VEC2", {0, 0, 1, 0, 0, 1});
    gltf.root["extensionsUsed"] = gltf.root["extensionsRequired"] = {"EXT_texture_avif"};
    gltf.add("images", {{"uri", "data:image/avif;base64," + avif}, {"name", "leaf"}});
    gltf.add("textures", {{"extensions", {{"EXT_texture_avif", {{"source", 0}}}}}});
    primitive_of(gltf)["material"] =
        gltf.add("materials", {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}});
    const Imported imported = read(gltf);
    if (!imported.losses.empty() &&
        imported.losses[0].what.find("unknown format") == std::string::npos)
        PENUMBRA_SKIP("OpenImageIO cannot read AVIF here: " + imported.losses[0].what);
    CHECK(imported.losses.empty());
    REQUIRE(imported.scene.textures.size() == 1);
    CHECK(imported.scene.textures[0].raster.width == 8);
    CHECK(imported.scene.textures[0].raster.height == 8);
}
