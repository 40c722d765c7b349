// Models by strangers: which files they may read, and what their text may do to a terminal.
#include "base/text/text.h"
#include "importers/obj/mtl_files.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <sys/stat.h>

using namespace penumbra;
using std::filesystem::path;
namespace fs = std::filesystem;

namespace {

const std::string hint = " (ask for more)";

// A triangle whose positions are in a file.
std::string triangle(const std::string& uri) {
    const nlohmann::json root = {
        {"asset", {{"version", "2.0"}}},
        {"scenes", {{{"nodes", {0}}}}},
        {"nodes", {{{"mesh", 0}}}},
        {"meshes", {{{"primitives", {{{"attributes", {{"POSITION", 0}}}}}}}}},
        {"accessors",
         {{{"bufferView", 0}, {"componentType", 5126}, {"count", 3}, {"type", "VEC3"}}}},
        {"bufferViews", {{{"buffer", 0}, {"byteLength", 36}}}},
        {"buffers", {{{"byteLength", 36}, {"uri", uri}}}}};
    return root.dump();
}

// Three corners.
std::string positions() {
    const float numbers[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    return {reinterpret_cast<const char*>(numbers), sizeof numbers};
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
    for (auto at = text.find(what); at != std::string::npos; at = text.find(what, at + by.size()))
        text.replace(at, what.size(), by);
    return text;
}

bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

// model/ with links out of it, beside secret/ which holds what every model wants.
struct Place {
    test::TempDir top = {};
    path secret = top / "secret", model = top / "model";

    Place() {
        test::write(secret / "a.bin", positions());
        test::write(secret / "a.mtl", "newmtl a\nKd 0.25 0 0\n");
        test::write(secret / "a.ppm", "P3 1 1 255 255 0 0\n");
        for (const char* file : {"a.bin", "a.mtl", "a.ppm"}) {
            test::write(model / "sub" / file, test::read(secret / file));
            fs::create_symlink(secret / file, model / ("link" + path(file).extension().string()));
            fs::create_symlink(model / "sub" / file,
                               model / ("within" + path(file).extension().string()));
        }
        fs::create_symlink("../secret", model / "dir");
        fs::create_symlink("nothing", model / "dangling");
        fs::create_symlink(secret / "nothing", model / "dangling-out");
        fs::create_symlink("circle", model / "circle");
        fs::create_symlink("/dev/zero", model / "zero");
        fs::create_symlink("/proc/self/environ", model / "proc");
        mkfifo((model / "fifo").c_str(), 0600);
    }

    // With the names of the folders as ALL CAPS.
    std::string tidy(const std::string& text) const {
        return replaced(replaced(text, model.string(), "MODEL"), top.path.string(), "TOP");
    }

    // What a glTF file says that names `uri`; "" when it is read.
    std::string gltf(const std::string& uri, const std::vector<path>& allowed = {}) const {
        const path file = test::write(model / "m.gltf", triangle(uri));
        return tidy(test::message_of(
            [&] { read_gltf(file, {.allowed_paths = allowed, .how_to_allow = "ask for more"}); }));
    }

    // The losses of an OBJ file that names a library and an image.
    std::string obj(const std::string& library, const std::string& image,
                    const std::vector<path>& allowed = {}) const {
        test::write(model / "own.mtl", "newmtl a\nmap_Kd " + image + "\n");
        const path file = test::write(model / "m.obj", "mtllib " + library + "\n" + test::facet +
                                                           "usemtl a\nf 1/1 2/2 3/3\n");
        const Imported imported =
            read_obj(file, {.allowed_paths = allowed, .how_to_allow = "ask for more"});
        std::string text;
        for (const Loss& loss : imported.losses) text += loss.place + ": " + loss.what + "\n";
        return tidy(text);
    }
    std::string library(const std::string& name, const std::vector<path>& allowed = {}) const {
        return obj(name, "sub/a.ppm", allowed);
    }
    std::string image(const std::string& name, const std::vector<path>& allowed = {}) const {
        return obj("own.mtl", name, allowed);
    }
};

}  // namespace

TEST_CASE("Hostile glTF, reads only below its own folder") {
    const Place place;
    CHECK(place.gltf("sub/a.bin").empty());
    CHECK(place.gltf("./sub/../sub/%61.bin").empty());
    CHECK(place.gltf("within.bin").empty());
    const std::string at = "MODEL/m.gltf#/buffers/0: ";
    for (const std::string uri : {"../secret/a.bin",
                                  "%2e%2e%2fsecret/a.bin",
                                  "..%5csecret%5Ca.bin",
                                  "sub/../../secret/a.bin",
                                  "../model/sub/a.bin",
                                  "../nothing.bin",
                                  "/etc/passwd",
                                  "%2fetc/passwd",
                                  "\\etc\\passwd",
                                  "/dev/zero",
                                  "/proc/self/environ",
                                  "link.bin",
                                  "dir/a.bin",
                                  "dir/nothing.bin",
                                  "dangling",
                                  "dangling-out",
                                  "circle",
                                  "circle/a",
                                  "zero",
                                  "proc"})
        CHECK(place.gltf(uri) ==
              at + "the uri '" + uri + "' leads out of the model's folder" + hint);
    // RFC 3986, section 5.2.4: removed before any link is looked at.
    CHECK(place.gltf("dir/../a.bin") == at + "MODEL/a.bin: no such file");
    for (const std::string uri : {"http://example.com/a.bin", "file:///etc/passwd", "FILE:a.bin",
                                  "C:\\a.bin", "c:a.bin", "ftp://host/a", "javascript:1"})
        CHECK(place.gltf(uri) ==
              at + "the uri '" + uri + "' is neither a relative path nor a data: URI");
    for (const std::string uri : {"//host/share/a.bin", "\\\\host\\share", "%2f/host/a"})
        CHECK(place.gltf(uri) ==
              at + "the uri '" + uri + "' is on another machine; only local files are read");
    CHECK(place.gltf("sub/a.bin%00.png") ==
          at + "the uri 'sub/a.bin%00.png' has a control character");
    CHECK(place.gltf("a%0ab") == at + "the uri 'a%0ab' has a control character");
    // What is encoded twice is decoded once.
    CHECK(place.gltf("%252e%252e/secret/a.bin") == at + "MODEL/%2e%2e/secret/a.bin: no such file");
    CHECK(place.gltf("fifo") == at + "MODEL/fifo: is not a regular file");
    CHECK(place.gltf("sub") == at + "MODEL/sub: is a folder");
    CHECK(place.gltf("sub/a.bin/b") == at + "MODEL/sub/a.bin/b: cannot be opened: not a directory");
    CHECK(place.gltf("$(touch a)") == at + "MODEL/$(touch a): no such file");
    const std::string deep(300, 'a');
    CHECK(place.gltf(deep).ends_with(deep + ": cannot be opened: file name too long"));
    std::string long_way;
    for (int i = 0; i < 3000; ++i) long_way += "a/";
    CHECK(place.gltf(long_way + "b").ends_with("a/b: no such file"));
    CHECK(place.gltf(long_way + "../../secret/a.bin").ends_with(": no such file"));
    CHECK(place.gltf("~/a") == at + "MODEL/~/a: no such file");
}

TEST_CASE("Hostile glTF, reads below the folders that the user allows") {
    const Place place;
    for (const std::string& uri :
         {std::string("../secret/a.bin"), std::string("%2e%2e/secret/a.bin"),
          std::string("link.bin"), std::string("dir/a.bin"), std::string("sub/a.bin"),
          std::string("../model/sub/a.bin"), (place.secret / "a.bin").string()})
        CHECK(place.gltf(uri, {"/usr", place.secret}).empty());
    CHECK(place.gltf("../secret/a.bin", {place.top / "secret/../secret"}).empty());
    const std::string at = "MODEL/m.gltf#/buffers/0: ";
    for (const std::string uri : {"../secret/a.bin", "link.bin", "/etc/passwd", "dangling-out"})
        CHECK(place.gltf(uri, {place.model / "sub"}) ==
              at + "the uri '" + uri + "' leads out of the model's folder" + hint);
    CHECK(place.gltf("//etc/passwd", {"/"}) ==
          at + "the uri '//etc/passwd' is on another machine; only local files are read");
    CHECK(place.gltf("zero", {"/dev"}) == at + "MODEL/zero: is not a regular file");
    CHECK(place.gltf("file:///dev/zero", {"/"}) ==
          at + "the uri 'file:///dev/zero' is neither a relative path nor a data: URI");
}

TEST_CASE("Hostile glTF, finds a file by another spelling of its name, but not outside") {
    const Place place;
    const std::string at = "MODEL/m.gltf#/buffers/0: ";
    test::write(place.model / "e\u0301" / "\u304c.bin", positions());
    CHECK(place.gltf("e\u0301/\u304c.bin").empty());
    CHECK(place.gltf("\u00e9/\u304b\u3099.bin").empty());
    CHECK(place.gltf("%C3%A9/%E3%81%8B%E3%82%99.bin").empty());
    CHECK(place.gltf("\u00e9/\u304b.bin") == at + "MODEL/\u00e9/\u304b.bin: no such file");
    CHECK(place.gltf("\u00e9/\u304b\u3099.BIN") ==
          at + "MODEL/\u00e9/\u304b\u3099.BIN: no such file");

    fs::create_symlink(place.secret / "a.bin", place.model / "n\u0303.bin");
    fs::create_symlink("../secret", place.model / "o\u0302");
    fs::create_symlink(place.secret, place.model / "e\u0301" / "out");
    for (const std::string uri : {"\u00f1.bin", "\u00f4/a.bin", "\u00f4/nothing.bin",
                                  "\u00e9/out/a.bin", "\u00e9/out/nothing.bin"})
        CHECK(place.gltf(uri) ==
              at + "the uri '" + uri + "' leads out of the model's folder" + hint);
    test::write(place.secret / "u\u0308.bin", positions());
    CHECK(place.gltf("../secret/\u00fc.bin", {place.secret}).empty());
    CHECK(place.gltf("../secret/\u00fc.bin") ==
          at + "the uri '../secret/\u00fc.bin' leads out of the model's folder" + hint);
}

TEST_CASE("Hostile OBJ, reads libraries and images only below its own folder") {
    const Place place;
    const auto expect = [&](const std::string& name, const std::string& why) {
        CHECK(place.library(name + ".mtl")
                  .starts_with(
                      fmt::format("MODEL/m.obj:1: material library '{}.mtl' {}", name, why)));
        CHECK(place.image(name + ".ppm")
                  .starts_with(fmt::format("MODEL/own.mtl:2: material 'a': texture '{}.ppm' {}",
                                           name, why)));
    };
    CHECK(place.obj("sub/a.mtl", "-").empty());
    CHECK(place.obj("within.mtl", "-").empty());
    CHECK(place.image("within.ppm").empty());
    for (const std::string name :
         {"../secret/a", "..\\secret\\a", "sub/../../secret/a", "/etc/a", "//host/share/a",
          "\\\\host\\a", "link", "dir/a", "dir/nothing", "DIR/A"})
        expect(name, "lies outside the model's folder" + hint);
    // Percent signs mean nothing in these formats.
    expect("%2e%2e/secret/a", "is not found");
    expect("http://example.com/a", "is not found");
    expect("$(touch a)", "is not found");
    const auto both = [&](const std::string& name, const std::string& why) {
        CHECK(place.library(name).starts_with("MODEL/m.obj:1: "));
        CHECK(contains(place.library(name), why));
        CHECK(place.image(name).starts_with("MODEL/own.mtl:2: "));
        CHECK(contains(place.image(name), why));
    };
    for (const char* name : {"zero", "proc", "dangling", "dangling-out", "circle"})
        both(name, "lies outside the model's folder" + hint);
    both("fifo", "MODEL/fifo: is not a regular file");
    both("sub", "MODEL/sub: is a folder");
    both(std::string("x\x01y"), "has a control character in its name");
    both(std::string("sub/a.mtl\0.ppm", 14), "has a control character in its name");
}

TEST_CASE("Hostile OBJ, reads below the folders that the user allows") {
    const Place place;
    for (const std::string& name :
         {std::string("../secret/a"), std::string("..\\secret\\a"), std::string("link"),
          std::string("dir/a"), (place.secret / "a").string()}) {
        CHECK(place.obj(name + ".mtl", "-", {place.secret}).empty());
        CHECK(place.image(name + ".ppm", {place.secret}).empty());
    }
    // A library elsewhere names images beside it.
    test::write(place.secret / "b.mtl", "newmtl a\nmap_Kd a.ppm\n");
    CHECK(place.library("../secret/b.mtl", {place.secret}).empty());
    CHECK(place.library((place.secret / "b.mtl").string(), {place.secret}).empty());
    CHECK(contains(place.library("../secret/b.mtl", {place.model / "sub"}),
                   "'../secret/b.mtl' lies outside"));
}

TEST_CASE("Hostile text, does nothing to a terminal") {
    CHECK(one_line("chair \u00e9\u4e2d\U0001f600.glb") == "chair \u00e9\u4e2d\U0001f600.glb");
    CHECK(one_line("a\nb\tc\rd\x1b[2Je\x7f") == "a b c d [2Je ");
    CHECK(one_line("\xc2\x9b"
                   "31m"
                   "\xc2\x80\xc2\x9f\xc2\xa0") == "?31m??\xc2\xa0");
    CHECK(one_line("\x9b"
                   "31m \xff \xe2\x80") == "?31m ? ??");
    CHECK(one_line("\u202egnp.exe \u2066x\u2069 \u200f \u061c \u2028") == "?gnp.exe ?x? ? ? ?");
    CHECK(one_line(std::string("a\0b", 3)) == "a b");
    CHECK(plain_lines("a\x1b[31m\nb\u009bc\n") == "a [31m\nb?c\n");
    const std::string json = nlohmann::json({"a\u009b\u202e\x7f\u00e9\n\x1b"}).dump();
    CHECK(plain_json(json) == "[\"a\\u009b\\u202e\\u007f\u00e9\\n\\u001b\"]");
    CHECK(nlohmann::json::parse(plain_json(json)) == nlohmann::json::parse(json));
}
