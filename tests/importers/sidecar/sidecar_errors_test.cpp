// What may be wrong with a sidecar, message by message.
#include "base/text/suggest.h"
#include "support/support.h"

#include "penumbra/importers.h"

using namespace penumbra;

namespace {

// The message about a sidecar studio.toml with this text, without its folder.
std::string problem(const std::string& text) {
    const test::TempDir folder;
    const auto file = test::write(folder / "studio.toml", text);
    std::string message = test::message_of([&] { load_scene({file}); });
    const std::string prefix = folder.path.string() + "/";
    for (auto at = message.find(prefix); at != message.npos; at = message.find(prefix))
        message.erase(at, prefix.size());
    return message;
}

}  // namespace

TEST_CASE("A mistyped key is named with what was meant") {
    CHECK(problem("[[sphere]]\nraduis = 1") ==
          "studio.toml:2:1: unknown key 'raduis' in [[sphere]] (did you mean 'radius'?)");
    CHECK(problem("[[sphere]]\ncenter = [0, 0, 0]\n  colour = 1") ==
          "studio.toml:3:3: unknown key 'colour' in [[sphere]] (known keys: name, center, radius, "
          "backdrop, material)");
    CHECK(problem("[lihgting]\nambient = 1") ==
          "studio.toml:1:2: unknown key 'lihgting' at the top level (did you mean 'lighting'?)");
    CHECK(problem("[[light]]\nposition = [0, 1, 0]\npenumbra = { dleta = 1 }") ==
          "studio.toml:3:14: unknown key 'dleta' in penumbra of [[light]] (did you mean 'delta'?)");
    CHECK(problem("[material.floor]\nshinines = 1") ==
          "studio.toml:2:1: unknown key 'shinines' in [material.floor] (did you mean "
          "'shininess'?)");
    CHECK(problem("[render]\nsample = 1") ==
          "studio.toml:2:1: unknown key 'sample' in [render] (did you mean 'samples'?)");
    CHECK(problem("[camera]\nlookat = 1") ==
          "studio.toml:2:1: unknown key 'lookat' in [camera] (did you mean 'look_at'?)");
}

TEST_CASE("A value of the wrong type is named with its place") {
    CHECK(problem("[[sphere]]\nradius = \"big\"") ==
          "studio.toml:2:10: 'radius' in [[sphere]] must be a number, not a string");
    CHECK(problem("[[sphere]]\ncenter = 3") ==
          "studio.toml:2:10: 'center' in [[sphere]] must be [x, y, z], not a number");
    CHECK(problem("[[sphere]]\ncenter = [1, 2]") ==
          "studio.toml:2:10: 'center' in [[sphere]] must be [x, y, z]: 3 numbers, not 2");
    CHECK(problem("[[sphere]]\ncenter = [1, true, 2]") ==
          "studio.toml:2:14: 'center' in [[sphere]] must be [x, y, z] of numbers, not a boolean");
    CHECK(problem("[[sphere]]\nmaterial = 1") ==
          "studio.toml:2:12: 'material' in [[sphere]] must be a string, not a number");
    CHECK(problem("[material.a]\nsmooth = 1") ==
          "studio.toml:2:10: 'smooth' in [material.a] must be true or false, not a number");
    CHECK(problem("[material.a]\ncolor = \"red\"") ==
          "studio.toml:2:9: 'color' in [material.a] must be [r, g, b] or \"#rrggbb\", not \"red\"");
    CHECK(problem("[material.a]\nambient = true") ==
          "studio.toml:2:11: 'ambient' in [material.a] must be a number, [r, g, b] or "
          "\"#rrggbb\", not a boolean");
    CHECK(problem("[render]\nsize = [320, 1.5]") ==
          "studio.toml:2:14: 'size' in [render] must be a whole number, not 1.5");
    CHECK(problem("[render]\nsize = 320") ==
          "studio.toml:2:8: 'size' in [render] must be a list of two whole numbers");
    CHECK(problem("render = 1") == "studio.toml:1:10: [render] must be a table");
    CHECK(problem("[light]\nposition = [0, 0, 0]") ==
          "studio.toml:1:1: 'light' must be a list of tables: [[light]]");
    CHECK(problem("[material]\ncolor = [1, 1, 1]") ==
          "studio.toml:2:9: 'color' in [material] must be a table: [material.NAME]");
    CHECK(problem("[material.a]\nchecker = { colors = [[1, 1, 1]] }") ==
          "studio.toml:2:22: 'colors' in checker of [material.a] must be a list of two colours");
    CHECK(problem("[[sphere]]\nradius = 2024-01-01") ==
          "studio.toml:2:10: 'radius' in [[sphere]] must be a number, not a date or time");
}

TEST_CASE("A value out of range is named with the range") {
    CHECK(problem("[[sphere]]\nradius = 0") ==
          "studio.toml:2:10: 'radius' in [[sphere]] must be greater than 0, not 0");
    CHECK(problem("[[sphere]]\nradius = inf") ==
          "studio.toml:2:10: 'radius' in [[sphere]] must be finite, not inf");
    CHECK(problem("[[sphere]]\ncenter = [0, nan, 0]") ==
          "studio.toml:2:14: 'center' in [[sphere]] must be finite, not nan");
    CHECK(problem("[material.a]\nopacity = 1.5") ==
          "studio.toml:2:11: 'opacity' in [material.a] must be from 0 to 1, not 1.5");
    CHECK(problem("[material.a]\nspecular = -1") ==
          "studio.toml:2:12: 'specular' in [material.a] must be 0 or more, not -1");
    CHECK(problem("[material.a]\nshininess = 1e300") ==
          "studio.toml:2:13: 'shininess' in [material.a] is too large: 1e+300");
    CHECK(problem("[material.a]\nior = 1e-300") ==
          "studio.toml:2:7: 'ior' in [material.a] is too near to the end of its range: 1e-300");
    CHECK(problem("[material.a]\ncolor = [0, -0.5, 0]") ==
          "studio.toml:2:9: 'color' in [material.a] must have channels of 0 or more, not -0.5");
    CHECK(problem("[camera]\nfov = 180") ==
          "studio.toml:2:7: 'fov' in [camera] must be above 0 and below 180, not 180");
    CHECK(problem("[render]\nsamples = 10") ==
          "studio.toml:2:11: 'samples' in [render] must be from 1 to 9, not 10");
    CHECK(problem("[render]\nantialias_depth = 10") ==
          "studio.toml:2:19: 'antialias_depth' in [render] must be from 1 to 9, not 10");
    CHECK(problem("[render]\nantialias = -1") ==
          "studio.toml:2:13: 'antialias' in [render] must be from 0 to 1000, not -1");
    CHECK(problem("[render]\nsamples = 2\nantialias = 0.1") ==
          "studio.toml:3:13: 'antialias' in [render] cannot stand beside samples");
    CHECK(problem("[render]\nsize = [0, 10]") ==
          "studio.toml:2:9: 'size' in [render] must be from 1 to 32767, not 0");
    CHECK(problem("[[plane]]\nnormal = [0, 0, 0]") ==
          "studio.toml:2:10: 'normal' in [[plane]] must not have length zero");
    CHECK(problem("[render]\nmax_depth = 9223372036854775807") ==
          "studio.toml:2:13: 'max_depth' in [render] must be from 1 to 256, not "
          "9.223372036854776e+18");
}

TEST_CASE("A word that is none of the choices is answered with the choices") {
    CHECK(problem("[[light]]\ntype = \"sun\"\nposition = [0, 0, 0]") ==
          "studio.toml:2:8: 'type' in [[light]] must be one of \"point\", \"spot\", "
          "\"directional\", not "
          "\"sun\"");
    CHECK(
        problem("[[light]]\nposition = [0, 0, 0]\npenumbra = { delta = 1, pattern = \"cube\" }") ==
        "studio.toml:3:35: 'pattern' in penumbra of [[light]] must be one of \"axes\", \"sphere\", "
        "\"grid\", not \"cube\"");
}

TEST_CASE("What is missing is named at its table") {
    CHECK(problem("\n[[model]]\nscale = 2") == "studio.toml:2:1: [[model]] needs 'file'");
    CHECK(problem("[[light]]\nintensity = 2") == "studio.toml:1:1: [[light]] needs 'position'");
    CHECK(problem("[[light]]\ntype = \"spot\"\nposition = [0, 0, 0]") ==
          "studio.toml:2:8: [[light]] needs 'direction' or 'target'");
    CHECK(problem("[[light]]\nposition = [0, 1, 0]\npenumbra = { pattern = \"axes\" }") ==
          "studio.toml:3:12: penumbra of [[light]] needs 'delta'");
    CHECK(problem("[[light]]\nposition = [0, 1, 0]\nattenuation = { power = 2 }") ==
          "studio.toml:3:15: attenuation of [[light]] needs 'distance'");
    CHECK(
        problem("[[light]]\nposition = [0, 1, 0]\npenumbra = { delta = 1, pattern = \"grid\" }") ==
        "studio.toml:3:12: [[light]] needs a 'target' that its grid faces");
}

TEST_CASE("What contradicts itself is an error") {
    CHECK(problem("[[light]]\nposition = [0, 1, 0]\nouter = 20") ==
          "studio.toml:3:9: 'outer' in [[light]] has no meaning for a point light");
    CHECK(problem("[[light]]\ntype = \"spot\"\nposition = [0, 1, 0]\ndirection = [0, -1, 0]\n"
                  "inner = 30\nouter = 20") ==
          "studio.toml:5:9: 'inner' in [[light]] must be smaller than 'outer'");
    CHECK(problem("[[light]]\ntype = \"spot\"\nposition = [0, 1, 0]\ndirection = [0, -1, 0]\n"
                  "target = [0, 0, 0]") ==
          "studio.toml:5:10: 'target' in [[light]] cannot stand beside 'direction'");
    CHECK(problem("[[light]]\nposition = [0, 1, 0]\npenumbra = { delta = 1, count = 9 }") ==
          "studio.toml:3:33: 'count' in penumbra of [[light]] is fixed for pattern \"axes\": 7");
    CHECK(problem("[camera]\nfov = 40\northographic = 2") ==
          "studio.toml:3:16: 'orthographic' in [camera] cannot stand beside 'fov'");
    CHECK(problem("[camera]\nposition = [0, 1, 0]\nlook_at = [0, 1, 0]") ==
          "studio.toml:3:11: the camera stands at the point that it looks at");
    CHECK(problem("[camera]\nposition = [0, 5, 0]\nlook_at = [0, 0, 0]") ==
          "studio.toml:1:1: the camera looks along its 'up': give another 'up'");
    CHECK(problem("[material.a]\nchecker = { size = 1 }\nnoise = { size = 1 }") ==
          "studio.toml:1:1: [material.a] may have one of texture, checker and noise");
    CHECK(problem("[[model]]\nfile = \"a.obj\"\nscale = 2\nmatrix = "
                  "[1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1]") ==
          "studio.toml:4:10: 'matrix' in [[model]] cannot stand beside translate, rotate or scale");
    CHECK(problem("[[model]]\nfile = \"a.obj\"\nmatrix = [1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,2]") ==
          "studio.toml:3:10: 'matrix' in [[model]] must be affine: its numbers 4, 8, 12 and 16 "
          "must be 0, 0, 0, 1");
    CHECK(problem("[[model]]\nfile = \"a.obj\"\nscale = [1, 0, 1]") ==
          "studio.toml:3:9: 'scale' in [[model]] must not be 0");
}

TEST_CASE("An unknown name is answered with the names that are there") {
    CHECK(problem("[[sphere]]\nmaterial = \"mirorr\"\n[material.mirror]\n[material.floor]") ==
          "studio.toml:2:12: no material 'mirorr' (did you mean 'mirror'?)");
    CHECK(problem("[[plane]]\nmaterial = \"x\"\n[material.mirror]\n[material.floor]") ==
          "studio.toml:2:12: no material 'x' (materials: floor, mirror)");
    CHECK(problem("[[sphere]]\nmaterial = \"red\"") == "studio.toml:2:12: no material 'red'");
    CHECK(problem("[camera]\nname = \"Front\"") ==
          "studio.toml:2:8: no camera 'Front' (the scene has no cameras)");
    CHECK(problem("[[model]]\nfile = \"bunny.obj\"") == "studio.toml:2:8: no such file: bunny.obj");
    CHECK(problem("[[model]]\nfile = \"bunny.stl\"") ==
          "studio.toml:2:8: 'file' in [[model]] must be a .gltf, .glb or .obj file");
    CHECK(problem("[material.a]\ntexture = \"wood.png\"") ==
          "studio.toml:2:11: 'texture' in [material.a] is 'wood.png': no such file");
}

TEST_CASE("A syntax error is one line with its place") {
    const std::string message = problem("[[sphere]]\nradius = = 2\n");
    CHECK(message.rfind("studio.toml:2:", 0) == 0);
    CHECK(message.find('\n') == std::string::npos);
    CHECK(message.back() != '.');
    CHECK(problem("[[sphere]]\nradius = 1\nradius = 2").rfind("studio.toml:3:", 0) == 0);
    CHECK(problem("\xff\xfe").rfind("studio.toml:1:", 0) == 0);
}

TEST_CASE("A message shows no control characters") {
    CHECK(problem("[[sphere]]\n\"a\\u0007\\n\" = 1").find_first_of("\a\n") == std::string::npos);
}

TEST_CASE("The edit distance counts changes and swaps") {
    CHECK(edit_distance("radius", "radius") == 0);
    CHECK(edit_distance("raduis", "radius") == 1);
    CHECK(edit_distance("radiu", "radius") == 1);
    CHECK(edit_distance("RADIUS", "radius") == 0);
    CHECK(edit_distance("", "abc") == 3);
    CHECK(edit_distance("kitten", "sitting") == 3);
    CHECK(hint("fvo", {"position", "fov"}, "keys") == " (did you mean 'fov'?)");
    CHECK(hint("zzz", {"position", "fov"}, "keys") == " (keys: position, fov)");
    CHECK(hint("zzz", {}, "keys").empty());
}
