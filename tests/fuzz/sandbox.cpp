#include "canary.h"
#include "fuzz.h"

#include "penumbra/image.h"
#include "penumbra/limits.h"

#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <memory>

namespace fuzz {
namespace {

namespace fs = std::filesystem;

using penumbra::Depth;
using penumbra::Raster;

void write_file(const fs::path& file, Input content) {
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> out(std::fopen(file.c_str(), "wb"),
                                                              std::fclose);
    if (!out || std::fwrite(content.data(), 1, content.size(), out.get()) != content.size()) {
        std::perror(file.c_str());
        std::_Exit(2);
    }
}

Raster raster(int width, int height, int channels, Depth depth = Depth::u8) {
    Raster made = {width, height, channels, depth, {}};
    made.data.resize(made.texels() * std::size_t(channels) * std::size_t(depth));
    for (std::size_t i = 0; i < made.data.size(); ++i) made.data[i] = std::byte(37 * i + 11);
    return made;
}

// Where files cost least; temporary files of the library go there as well.
fs::path new_folder() {
    if (std::getenv("TMPDIR") == nullptr && ::access("/dev/shm", W_OK) == 0)
        ::setenv("TMPDIR", "/dev/shm", 1);
    std::string name = (fs::temp_directory_path() / "penumbra-fuzz-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) {
        std::perror(name.c_str());
        std::_Exit(2);
    }
    return name;
}

constexpr const char* square_obj = "mtllib model.mtl\n"
                                   "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\n"
                                   "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvn 0 0 1\n"
                                   "usemtl a\nf 1/1/1 2/2/1 3/3/1\n"
                                   "usemtl b\nf 1/1/1 3/3/1 4/4/1\n"
                                   "usemtl c\nf 1/1 2/2 5/3\n"
                                   "usemtl d\nf 1 4 5\n";

constexpr const char* plain_obj = "v 0 0 0\nv 1 0 0\nv 1 1 0\nvt 0 0\nvt 1 0\nvt 1 1\n"
                                  "o part\nusemtl clay\nf 1/1 2/2 3/3\n";

// A triangle with a camera and a light; its buffer is 0 0 0, 1 0 0, 0 1 0.
constexpr const char* plain_gltf =
    R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0,1]}],
"nodes":[{"mesh":0,"name":"part"},{"name":"eye","camera":0,"translation":[0,0,4],
"extensions":{"KHR_lights_punctual":{"light":0}}}],
"cameras":[{"type":"perspective","name":"eye","perspective":{"yfov":0.6,"znear":0.1}}],
"materials":[{"name":"clay"}],"extensionsUsed":["KHR_lights_punctual"],
"extensions":{"KHR_lights_punctual":{"lights":[{"type":"point","name":"lamp","intensity":50}]}},
"meshes":[{"primitives":[{"attributes":{"POSITION":0},"material":0}]}],
"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3",
"min":[0,0,0],"max":[1,1,0]}],
"bufferViews":[{"buffer":0,"byteLength":36}],
"buffers":[{"byteLength":36,"uri":"data:application/octet-stream;base64,)"
    "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA\"}]}";

}  // namespace

Sandbox::Sandbox() : top_(new_folder()) {
    penumbra::set_memory_limit(process_limit);
    in = top_ / "in";
    out = top_ / "out";
    fs::create_directories(in / "sub");
    fs::create_directory(out);
    save_raster(in / "a.png", raster(2, 2, 3));
    save_raster(in / "b.png", raster(4, 4, 4));
    save_raster(in / "c.png", raster(3, 2, 1, Depth::u16));
    save_raster(in / "sub/a.png", raster(2, 1, 2));
    penumbra::Image picture(8, 8);
    for (int i = 0; i < 64; ++i) picture.pixels[std::size_t(i)] = penumbra::Color(float(i) / 64);
    save_image(in / "a.jpg", picture);
    save_image(in / "a.exr", picture);
    std::string bytes;
    for (int i = 0; i < 1024; ++i) bytes += char(i % 7 == 0 ? 0x3f : i % 5);
    write_file(in / "a.bin", bytes);
    write("square.obj", square_obj);
    write("plain.obj", plain_obj);
    write("plain.gltf", plain_gltf);

    const Raster canary = {
        int(canary_texels.size()), 1, 1, Depth::u8, {canary_texels.begin(), canary_texels.end()}};
    save_raster(top_ / "outside.png", canary);
    fs::create_symlink("../outside.png", in / "link.png");
}

Sandbox::~Sandbox() {
    std::error_code ignored;
    fs::remove_all(top_, ignored);
}

fs::path Sandbox::write(const char* name, Input content) const {
    fs::path file = in / name;
    write_file(file, content);
    return file;
}

const Sandbox& sandbox() {
    static const Sandbox only;
    return only;
}

}  // namespace fuzz
