// Small files that call for much memory, each against a limit.
#include "base/memory.h"
#include "support/bombs.h"
#include "support/program.h"
#include "tracer/accel/facets.h"

#include "penumbra/image.h"
#include "penumbra/importers.h"
#include "penumbra/limits.h"

#include <algorithm>
#include <chrono>

using namespace penumbra;
using namespace test;

namespace {

// A command on a file that holds `content`, and what it has to say of the file.
struct Bomb {
    std::string name, content, place;
    int limit = 128;  // MB
    std::string command = "info";
};

// Libraries and the program itself take less than this, in MB.
constexpr std::size_t program_size = 200;

void check_refused(const Bomb& bomb) {
    const TempDir folder;
    write(folder / bomb.name, bomb.content);
    Words words = {bomb.command, bomb.name, "--max-memory", std::to_string(bomb.limit) + "M"};
    if (bomb.command == "compare") words.insert(words.begin() + 1, bomb.name);
    const auto begin = std::chrono::steady_clock::now();
    const Ended ended = run(folder.path, words);
    INFO(ended.err);
    CHECK(ended.status == 3);
    CHECK(ended.out.empty());
    CHECK(std::count(ended.err.begin(), ended.err.end(), '\n') == 1);
    // Under a sanitizer the program itself may be beyond the limit, so that it stops earlier.
    if (!sanitized) CHECK(contains(ended.err, "penumbra: error: " + bomb.place));
    CHECK(contains(ended.err, " of memory, more than the "));
    CHECK(contains(ended.err, "(raise it with --max-memory)"));
    CHECK(std::chrono::steady_clock::now() - begin < std::chrono::seconds(10));
    if (!sanitized) CHECK(ended.peak < (std::size_t(bomb.limit) + program_size) * mega);
}

}  // namespace

TEST_CASE("a PNG file cannot ask for more than the limit") {
    check_refused({.name = "a.png",
                   .content = png(8192, 16, 4, true),
                   .place = "a.png: needs 512 MB",
                   .command = "compare"});
    check_refused({.name = "grey.png",
                   .content = png(8000, 1, 1),
                   .place = "grey.png: needs ",
                   .limit = 64,
                   .command = "compare"});
}

TEST_CASE("a texture beyond the limit ends the reading of its model") {
    check_refused({.name = "a.gltf",
                   .content = textured(png(8192, 16, 4)),
                   .place = "a.gltf#/images/0: texture0: needs 512 MB"});
}

TEST_CASE("a texture that no machine should read is left out") {
    const TempDir folder;
    write(folder / "a.gltf", textured(png(20000, 1, 1)));
    const std::string limit = sanitized ? "4G" : "128M";
    const Ended ended = run(folder.path, {"info", "a.gltf", "--max-memory", limit});
    CHECK(ended.status == 0);
    CHECK(contains(ended.out, "20000 x 20000 pixels, more than is supported"));
    if (!sanitized) CHECK(ended.peak < (128 + program_size) * mega);
}

TEST_CASE("a JPEG file cannot ask for more than the limit") {
    check_refused({.name = "a.jpg",
                   .content = progressive_jpeg(8000, 8000),
                   .place = "a.jpg: needs 183 MB",
                   .command = "compare"});
    // The samples fit, but not with the coefficients of all scans.
    check_refused({.name = "b.jpg",
                   .content = progressive_jpeg(5000, 5000),
                   .place = "b.jpg: needs 1",
                   .command = "compare"});
}

TEST_CASE("a JPEG file cannot ask for a pass over a large picture with every few bytes") {
    const TempDir folder;
    const std::string file = progressive_jpeg(8000, 8000);
    const std::string scan = file.substr(file.rfind("\xff\xda"));
    write(folder / "a.jpg", file + repeated(scan, 40));
    CHECK(message_of([&] { load_image(folder / "a.jpg"); }) ==
          (folder / "a.jpg").string() + ": cannot be read as an image (it has too many scans)");
}

TEST_CASE("an OpenEXR file cannot ask for more than the limit") {
    check_refused({.name = "a.exr",
                   .content = tiled_exr(16, 8000),
                   .place = "a.exr: needs 2.1 GB",
                   .command = "compare"});
    const TempDir folder;
    write(folder / "b.exr", tiled_exr(0x7fffffff, 64));
    CHECK(contains(message_of([&] { load_image(folder / "b.exr"); }),
                   "it has more pixels than are supported"));
}

TEST_CASE("a WebP file cannot ask for more than the limit") {
    check_refused({.name = "a.webp",
                   .content = webp(8000, 8000),
                   .place = "a.webp: needs ",
                   .command = "compare"});
    const TempDir folder;
    write(folder / "b.webp", webp(16384, 16384));
    CHECK(contains(message_of([&] { load_image(folder / "b.webp"); }),
                   "it has more pixels than are supported"));
}

TEST_CASE("primitives cannot share zeros without end") {
    const std::string primitive = R"({"attributes":{"POSITION":0}},)";
    std::string all = repeated(primitive, 2), many = repeated(primitive, 1000);
    all.pop_back();
    many.pop_back();
    const TempDir folder;
    write(folder / "a.gltf", gltf(zeros + R"(,"meshes":[{"primitives":[)" + many + "]}]"));
    CHECK(contains(message_of([&] { read_gltf(folder / "a.gltf"); }),
                   "a.gltf#/meshes/0/primitives/2: uses elements without a buffer view; with those "
                   "of the primitives before they are 50331648, more than the 33554432"));
    check_refused({.name = "a.gltf",
                   .content = gltf(R"("scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],)" + zeros +
                                   R"(,"meshes":[{"primitives":[)" + all + "]}]"),
                   .place = "a.gltf#/meshes/0/primitives/1: needs ",
                   .limit = 400});
}

TEST_CASE("primitives cannot share sparse elements without end") {
    const std::string place =
        "a.gltf#/meshes/0/primitives/256: uses sparse elements; with those of "
        "the primitives before they are 269484032, more than the 268435456";
    std::string many = repeated(R"({"attributes":{"POSITION":0}},)", 300);
    many.pop_back();
    const TempDir folder;
    write(folder / "a.bin", "");
    std::filesystem::resize_file(folder / "a.bin", 12 * mega);
    write(folder / "a.gltf", gltf(R"("buffers":[{"uri":"a.bin","byteLength":12582912}],
        "bufferViews":[{"buffer":0,"byteLength":12582912}],
        "accessors":[{"componentType":5126,"type":"VEC3","count":1048576,"bufferView":0,
            "sparse":{"count":1048576,"indices":{"bufferView":0,"componentType":5121},
                      "values":{"bufferView":0}}}],
        "meshes":[{"primitives":[)" +
                                  many + "]}]"));
    CHECK(contains(message_of([&] { read_gltf(folder / "a.gltf"); }), place));
}

TEST_CASE("instances cannot be had for nothing") {
    check_refused(
        {.name = "a.gltf",
         .content = gltf(R"("scenes":[{"nodes":[0]}],"nodes":[{"mesh":0,"extensions":
             {"EXT_mesh_gpu_instancing":{"attributes":{"TRANSLATION":0}}}}],
             "extensionsUsed":["EXT_mesh_gpu_instancing"],
             "meshes":[{"primitives":[{"attributes":{"POSITION":1}}]}],
             "accessors":[{"componentType":5126,"type":"VEC3","count":16777216},
                          {"componentType":5126,"type":"VEC3","count":3}])"),
         .place = "a.gltf#/nodes/0/extensions/EXT_mesh_gpu_instancing/attributes: needs 2.6 GB"});
}

TEST_CASE("JSON cannot become much larger in memory than the limit") {
    std::string values = repeated("[],", 7 * mega);
    values.pop_back();
    check_refused({.name = "a.gltf",
                   .content = gltf(R"("extras":[)" + values + "]"),
                   .place = "a.gltf: needs ",
                   .limit = 256});
    std::string nodes = repeated("{},", 200'000);
    nodes.pop_back();
    check_refused({.name = "b.gltf",
                   .content = gltf(R"("nodes":[)" + nodes + "]"),
                   .place = "b.gltf: needs ",
                   .limit = 128});
}

TEST_CASE("an OBJ file cannot become much larger in memory than the limit") {
    check_refused({.name = "faces.obj",
                   .content = "v 0 0 0\nv 1 0 0\nv 0 1 0\n" + repeated("f 1 2 3\n", mega),
                   .place = "faces.obj: needs ",
                   .limit = 64});
    check_refused({.name = "groups.obj",
                   .content = "v 0 0 0\n" + repeated("g\ns\n", mega) + "f 1 1 1\n",
                   .place = "groups.obj: needs ",
                   .limit = 64});
    check_refused({.name = "names.obj",
                   .content = "v 0 0 0\ng " + std::string(mega, 'x') + '\n' +
                              [] {
                                  std::string text;
                                  for (int i = 0; i < 30'000; ++i)
                                      text += "usemtl " + std::to_string(i) + "\nf 1 1 1\n";
                                  return text;
                              }(),
                   .place = "names.obj: needs ",
                   .limit = 64});
}

TEST_CASE("a sidecar cannot become much larger in memory than the limit") {
    check_refused({.name = "a.toml",
                   .content = "x = [" + repeated("0,", 4 * mega) + "]\n",
                   .place = "a.toml: needs "});
    const TempDir folder;
    for (const std::string& content :
         {repeated("a.", 100'000) + "a = 1\n", '[' + repeated("a.", 100'000) + "a]\n",
          "a = " + repeated("[", 100'000), "a = " + repeated("{a=", 100'000)}) {
        write(folder / "b.toml", content);
        const Ended ended = run(folder.path, {"info", "b.toml"});
        CHECK(ended.status == 3);
        if (contains(content, "a.a."))
            CHECK(ended.err == "penumbra: error: b.toml:1: a key has more than 16 parts\n");
    }
}

TEST_CASE("a file larger than the limit is not read") {
    const TempDir folder;
    write(folder / "a.obj", "");
    std::filesystem::resize_file(folder / "a.obj", 1U << 30);  // a hole
    const Ended ended = run(folder.path, {"info", "a.obj", "--max-memory", "100M"});
    CHECK(ended.status == 3);
    CHECK(contains(ended.err, "a.obj: needs 1.0 GB of memory, more than the "));
}

TEST_CASE("the tree of facets is within the limit as well") {
    Scene scene;
    scene.materials.emplace_back();
    Mesh& mesh = scene.meshes.emplace_back();
    mesh.material = 0;
    for (Index i = 0; i < 100'000; ++i) {
        const auto x = float(i % 300), y = float(i / 300);
        for (const Vec3f& p : {Vec3f(x, y, 0), Vec3f(x + 1, y, 0), Vec3f(x, y + 1, 0)})
            mesh.positions.push_back(p);
        mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    scene.instances.push_back({});
    CHECK_FALSE(FacetAccel(scene).empty());
    set_memory_limit(1);
    const std::string message = message_of([&] { FacetAccel{scene}; });
    set_memory_limit(0);
    CHECK(contains(message, "the scene has more facets than the 1 bytes of memory"));
}

TEST_CASE("long names are cut") {
    const TempDir folder;
    const std::string name(mega, 'n');
    write(folder / "a.gltf", gltf(R"("scenes":[{"nodes":[0]}],"nodes":[{"mesh":0,"name":")" + name +
                                  R"("}],"meshes":[{"name":")" + name +
                                  R"(","primitives":[{"attributes":{"POSITION":0}}]}],
        "accessors":[{"componentType":5126,"type":"VEC3","count":3}])"));
    const Imported imported = read_gltf(folder / "a.gltf");
    CHECK(imported.scene.instances.at(0).name == std::string(max_name - 3, 'n') + "...");
    CHECK(imported.scene.meshes.at(0).name.size() == max_name);
    CHECK(kept_name("short") == "short");
    std::string umlauts;
    while (umlauts.size() < 2 * max_name) umlauts += "\xc3\xa4";
    CHECK(kept_name(umlauts).size() == max_name - 1);  // between two characters

    write(folder / "a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\ng " + name + "\nf 1 2 3\n");
    CHECK(read_obj(folder / "a.obj").scene.meshes.at(0).name.size() == max_name);
}
