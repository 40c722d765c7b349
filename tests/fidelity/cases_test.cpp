// Small files by others' bug reports, each with what is right. They lie beside the checkout; what
// they show is covered by files of our own in the rooms' tests as well.
#include "support/parity.h"
#include "support/small_scenes.h"
#include "support/support.h"

#include "penumbra/picture.h"

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

namespace {

using namespace penumbra;
namespace fs = std::filesystem;

fs::path cases() { return fs::path(PENUMBRA_SOURCE_DIR) / "../shared/cases"; }

bool missing() { return !fs::exists(cases()); }

constexpr const char* not_here = "the cases are not here";
constexpr int width = 160, height = 120;

Imported load(const std::string& file, ModelOptions model = {}) {
    Imported imported = load_scene(
        {cases() / file}, {.settings = {"render.size=[160,120]"}, .model = std::move(model)});
    test::meter(imported);
    return imported;
}

std::string sentences(const Losses& losses) {
    std::string text;
    for (const Loss& loss : losses) text += loss.what + "\n";
    return text;
}

Image picture(const std::string& file, const ModelOptions& model = {}) {
    Imported imported = load(file, model);
    return render(normalise(std::move(imported.scene), imported.render), imported.render);
}

Color at(const Image& image, double x, double y) {
    return image.at(int(x * image.width), int(y * image.height));
}

bool near(const Color& a, const Color& b, float margin) {
    const Color d = a - b;
    return std::max({std::abs(d.x), std::abs(d.y), std::abs(d.z)}) <= margin;
}

// What importing says of it; the exporter may say more.
struct Said {
    const char* file;
    const char* part;  // of what is lost; empty: nothing is
};

constexpr Said said[] = {
    {"far/far_sphere_epsg3857.glb", ""},
    {"far/utm.obj", ""},
    {"far/bk_150km.glb", ""},
    {"far/skf_3km.glb", ""},
    {"far/far_and_origin.glb", "so that each is smaller than a pixel; the farthest"},
    {"coincident/43_blend-cube-on-opaque-cube-blend-first.gltf", "lie in one plane with others"},
    {"coincident/44_shared-meshes-coincident-opaque.gltf", "lie exactly on others are left out"},
    {"glass/40_glass-beside-metal-in-one-image.gltf", ""},
    {"glass/05_diffuse-transmission-backlit.gltf", ""},
    {"specular/46_gold-metal-vs-ior0-vs-ior1000.gltf", ""},
    {"specular/42_specular-color.gltf", ""},
    {"obj/col_mixed.obj", ""},
    {"obj/n_vt.obj", "vt that is not finite"},
    {"obj/n_vunused.obj", "no face uses it"},
    {"obj/f_zero_n.obj", "a normal index of 0 is ignored"},
    {"obj/gbk/\u5927\u5730\u5f62.obj", ""},
    {"obj/sjis5c.obj", "is not found; the plain colour is used"},
    {"obj/mrgb.obj", ""},
    {"obj/q_kd255.obj", "it is taken as 0 to 255"},
    {"gltf/nan_TEXCOORD_0.glb", "texture coordinates are not finite"},
    {"gltf/col_u8_notnorm.glb", "are not marked as normalized"},
    {"gltf/01_v2.0-min1.0.gltf", ""},
    {"gltf/01_v2.1.gltf", ""},
    {"gltf/01_v2.123456789.gltf", ""},
    {"gltf/18_animation-pointer-color-translation.gltf", ""},
    {"gltf/23_external-asset-2.1.gltf", ""},
    {"gltf/30_KHR_interactivity-required.gltf", ""},
    {"gltf/19_KHR-primitive-restart-required.gltf", ""},
    {"gltf/28_float64-KHR_accessor_float64.gltf", ""},
    {"gltf/13_gaussian-splats.gltf", "Gaussian splats (KHR_gaussian_splatting) are left out"},
    {"gltf/33_point-light-range.gltf", "its range is ignored"},
    {"gltf/03_ior-0.5-bad.gltf", "KHR_materials_ior allows 0 and what is at least 1"},
    {"gltf/10_meshopt-ext-v1-bad.gltf", "which only KHR_meshopt_compression allows"},
};

// A model far from the origin, or large, and the one that it looks like.
struct Alike {
    const char* file;
    const char* other;
    double off;  // pixels at most, for its own float32 vertices
};

constexpr Alike alike[] = {
    {"far/far_sphere_epsg3857.glb", "far/far_sphere_0.glb", 0},
    {"far/bk_150km.glb", "far/bk_0.glb", 0.002},
    {"far/skf_3km.glb", "far/skf_0.glb", 0},
};

}  // namespace

TEST_CASE("cases, say what is lost of them and nothing else") {
    if (missing()) PENUMBRA_SKIP(not_here);
    for (const auto& [file, part] : said) {
        INFO(file);
        const std::string text = sentences(load(file).losses);
        if (std::string_view(part).empty()) CHECK(text.empty());
        CHECK(text.find(part) != std::string::npos);
    }
}

TEST_CASE("cases, that are invalid are refused in words that help") {
    if (missing()) PENUMBRA_SKIP(not_here);
    const auto message = [](const std::string& file) {
        return test::message_of([&] { load("gltf/" + file); });
    };
    CHECK(message("01_v2.00-bad.gltf").find("two whole numbers without leading zeros") !=
          std::string::npos);
    CHECK(message("od_version20.glb").find("must be a string such as \"2.0\"") !=
          std::string::npos);
    CHECK(message("22_glb3-json2.1.glb").find("is GLB 3, the container of glTF 2.1") !=
          std::string::npos);
}

TEST_CASE("cases, look the same far from the origin") {
    if (missing()) PENUMBRA_SKIP(not_here);
    for (const auto& [file, other, off] : alike) {
        INFO(file);
        CHECK(test::share_off(picture(file), picture(other), 1 / 255.0F) <= off);
    }
}

TEST_CASE("cases, are the same picture in POV-Ray") {
    if (missing()) PENUMBRA_SKIP(not_here);
    if (!test::have_povray()) PENUMBRA_SKIP("POV-Ray is not installed");
    for (const auto& one : fs::recursive_directory_iterator(cases())) {
        const std::string kind = one.path().parent_path().filename().string();
        const std::string extension = one.path().extension().string();
        const bool model = extension == ".gltf" || extension == ".glb" || extension == ".obj";
        const std::vector<std::string> kinds = {"far",   "coincident", "sides",
                                                "glass", "specular",   "tolerance"};
        if (!model || std::ranges::find(kinds, kind) == kinds.end()) continue;
        INFO(one.path().filename());
        const test::TempDir folder;
        CHECK(test::parity_of(one.path(), width, height, folder.path).parity >= 0.9999);
    }
}

TEST_CASE("cases, show one side of a facet, and coloured light from behind") {
    if (missing()) PENUMBRA_SKIP(not_here);
    const Image sides = picture("sides/frontback.glb");
    CHECK(at(sides, 0.25, 0.5) != at(sides, 0.75, 0.5));
    // The pane alone, lit by one lamp behind it: KHR_materials_diffuse_transmission's own colour.
    const Image pane = picture("glass/05_diffuse-transmission-backlit.gltf");
    const Color c = at(pane, 0.25, 0.5);
    CHECK(c.x > 2 * c.y);
}

TEST_CASE("cases, keep what is small in a large scene") {
    if (missing()) PENUMBRA_SKIP(not_here);
    // Beside a plate of 4 mm; and on a see-through sticker 1 mm before a white wall.
    for (const char* plate : {"tolerance/prod_1m.glb", "tolerance/prod_100m.glb"})
        CHECK(at(picture(plate), 0.59, 0.65).x < 0.15F);
    for (const char* sticker : {"tolerance/decal_10m_1mm.glb", "tolerance/decal_200m_1mm.glb"})
        CHECK(at(picture(sticker), 0.475, 0.667).x > 0.8F);
}

TEST_CASE("cases, show the same gold in three spellings") {
    if (missing()) PENUMBRA_SKIP(not_here);
    const Image image = picture("specular/46_gold-metal-vs-ior0-vs-ior1000.gltf");
    const Color metal = at(image, 0.25, 0.52), none = at(image, 0.5, 0.52),
                large = at(image, 0.75, 0.52);
    CHECK(metal.x > 2 * metal.z);
    CHECK(near(none, large, 0.1F));
    CHECK(near(none, metal, 0.1F));
}

TEST_CASE("cases, follow KHR_animation_pointer") {
    if (missing()) PENUMBRA_SKIP(not_here);
    const std::string file = "gltf/18_animation-pointer-color-translation.gltf";
    CHECK(test::share_off(picture(file, {.time = 0}), picture(file, {.time = 1})) > 0.01);
}

TEST_CASE("cases, tell pictures apart by their alpha and not by what it hides") {
    if (missing()) PENUMBRA_SKIP(not_here);
    const auto verdict = [](const char* a, const char* b, bool ignore) {
        return compare(load_picture(cases() / "compare" / a, ignore),
                       load_picture(cases() / "compare" / b, ignore))
            .verdict;
    };
    CHECK(verdict("a_hole.png", "a_rgba.png", false) == Verdict::fail);
    CHECK(verdict("a_hole.png", "a_rgba.png", true) == Verdict::pass);
    const Comparison one = compare(load_picture(cases() / "compare/big_px.png"),
                                   load_picture(cases() / "compare/big.png"));
    CHECK(one.value("parity") < 1);
}
