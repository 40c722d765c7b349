// A stage on which tests show things to the tracer and to POV-Ray, and how far the two agree.
#pragma once

#include "support/small_scenes.h"
#include "support/support.h"

#include "penumbra/compare.h"
#include "penumbra/exporters.h"
#include "penumbra/povray.h"
#include "penumbra/tracer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <sstream>

namespace test {

inline bool have_povray() {
    static const bool found = test::message_of([] { povray_version(); }).empty();
    return found;
}

// In a test that runs POV-Ray.
#define NEEDS_POVRAY()                                                                             \
    if (!test::have_povray()) PENUMBRA_SKIP("POV-Ray is not installed")

struct Agreement {
    double exact = 0;  ///< fraction of pixels within 1e-4, relative above 1
    double close = 0;  ///< ... within 1/255
    double lit = 0;    ///< fraction that is not black
    Losses losses = {};
};

inline Agreement agreement(const Image& test, const Image& reference) {
    std::size_t exact = 0, close = 0, lit = 0;
    float worst = 0;
    int worst_pixel = 0;
    for (std::size_t i = 0; i < test.pixels.size(); ++i) {
        bool all_exact = true, all_close = true;
        for (int c = 0; c < 3; ++c) {
            const float ours = test.pixels[i][c], theirs = reference.pixels[i][c];
            const float difference = std::abs(ours - theirs) / std::max(1.0F, std::abs(theirs));
            all_exact = all_exact && difference <= 1e-4F;
            all_close = all_close && difference <= 1 / 255.0F;
            if (!(difference <= worst)) {
                worst = difference;
                worst_pixel = int(i);
            }
        }
        exact += all_exact;
        close += all_close;
        lit += reference.pixels[i] != Color(0);
    }
    const auto count = double(test.pixels.size());
    UNSCOPED_INFO("worst difference " << worst << " at " << worst_pixel % test.width << ","
                                      << worst_pixel / test.width << ": ours "
                                      << test.pixels[std::size_t(worst_pixel)] << ", POV-Ray's "
                                      << reference.pixels[std::size_t(worst_pixel)]);
    return {double(exact) / count, double(close) / count, double(lit) / count, {}};
}

// The lines of POV-Ray's log that warn about the scene.
inline std::string warnings(const std::string& log) {
    std::istringstream lines(log);
    std::string found;
    for (std::string line; std::getline(lines, line);)
        if (line.find("Warning:") != line.npos || line.find("Error") != line.npos)
            found += line + '\n';
    return found;
}

inline Agreement agreement(const Scene& scene, RenderOptions options = {}) {
    const test::TempDir folder;
    if (options.width == 800) {
        options.width = 240;
        options.height = 180;
    }
    REQUIRE(defects(scene).empty());
    const NormalisedScene normalised = normalise(scene, options);
    Agreement result;
    const Exported exported = write_pov(normalised, options, folder / "scene.pov");
    const PovrayRun run = run_povray(folder / "scene.ini", options.width, options.height);
    const Image ours = render(normalised, options);
    if (const char* keep = std::getenv("PENUMBRA_KEEP")) {
        fs::copy(folder.path, keep,
                 fs::copy_options::recursive | fs::copy_options::overwrite_existing);
        save_image(fs::path(keep) / "ours.exr", ours);
        save_image(fs::path(keep) / "ours.png", ours);
        save_image(fs::path(keep) / "povray.png", run.image);
        save_image(fs::path(keep) / "difference.png", difference(ours, run.image, 100));
        std::ofstream(fs::path(keep) / "log.txt") << run.log;
    }
    CHECK(warnings(run.log) == "");
    result = agreement(ours, run.image);
    result.losses = exported.losses;
    return result;
}

inline void require_exact(const Agreement& found) {
    CHECK(found.exact >= 0.999);
    CHECK(found.close >= 0.9995);
    CHECK(found.lit > 0.3);
    CHECK(found.losses.empty());
}

// A ball of facets with normals, texture coordinates and, if wanted, vertex colours.
inline Mesh ball(Index material, bool colored = false) {
    constexpr int around = 24, along = 12;
    Mesh mesh{.name = "ball", .material = material};
    for (int j = 0; j <= along; ++j) {
        for (int i = 0; i <= around; ++i) {
            const double a = 2 * std::numbers::pi * i / around, b = std::numbers::pi * j / along;
            const Vec3 n(std::sin(b) * std::cos(a), std::cos(b), std::sin(b) * std::sin(a));
            mesh.positions.emplace_back(n);
            mesh.normals.emplace_back(n);
            mesh.texcoords.emplace_back(-3.0F * float(i) / around, 1.5F * float(j) / along);
            if (colored)
                mesh.colors.emplace_back(0.2F * float(i % 5), 1 - 0.3F * float(j % 3),
                                         0.1F + 0.4F * float((i + j) % 2));
        }
    }
    for (Index j = 0; j < along; ++j) {
        for (Index i = 0; i < around; ++i) {
            const Index p = j * (around + 1) + i, q = p + around + 1;
            if (j > 0) mesh.triangles.push_back({p, p + 1, q + 1});
            if (j + 1 < along) mesh.triangles.push_back({p, q + 1, q});
        }
    }
    return mesh;
}

inline Texture picture(const std::string& name, int channels = 3, Depth depth = Depth::u8) {
    Texture texture{.name = name};
    texture.raster = {.width = 6, .height = 5, .channels = channels, .depth = depth};
    unsigned state = 12345;
    for (int i = 0; i < 6 * 5 * channels; ++i) {
        state = state * 1664525U + 1013904223U;
        const unsigned value = state >> 16U;
        std::array<std::byte, 4> sample{};
        const auto byte = std::uint8_t(value), word8 = byte;
        const auto word = std::uint16_t(value);
        const float real = float(word8) / 64;  // exact in half precision
        const void* from = depth == Depth::u8    ? static_cast<const void*>(&byte)
                           : depth == Depth::u16 ? static_cast<const void*>(&word)
                                                 : static_cast<const void*>(&real);
        std::memcpy(sample.data(), from, std::size_t(depth));
        texture.raster.data.insert(texture.raster.data.end(), sample.begin(),
                                   sample.begin() + std::ptrdiff_t(depth));
    }
    return texture;
}

// A stage for up to 4 x 3 things of radius 1 in front of a dim wall, under two lights.
struct Stage {
    Scene scene = test::empty_scene();
    int things = 0;

    Stage() {
        scene.cameras[0].position = {0.3, 0.2, 11};
        scene.cameras[0].fov = radians(52);
        scene.background = {0.1F, 0.2F, 0.3F};
        scene.ambient = {0.9F, 1, 0.8F};
        scene.planes = {{"wall", {0, 0, -1.6}, {0, 0, 1}, 0}};
        scene.materials[0].diffuse = 0.6F;
        scene.lights = {
            {.name = "key", .position = {4, 6, 9}, .color = {1, 0.9F, 0.8F}, .intensity = 0.8},
            {.name = "fill", .position = {-7, 1, 8}, .color = {0.3F, 0.4F, 0.5F}}};
    }
    Index add(const Material& material) {
        scene.materials.push_back(material);
        return Index(scene.materials.size() - 1);
    }
    Vec3 next() {
        const int i = things++;
        return {2.4 * (i % 4) - 3.6, 2.4 - 2.4 * (i / 4), 0};
    }
    void sphere(const Material& material) {
        scene.spheres.push_back({material.name, next(), 1, add(material)});
    }
    void mesh(Mesh mesh) {
        scene.meshes.push_back(std::move(mesh));
        Instance instance{.name = "thing", .mesh = Index(scene.meshes.size() - 1)};
        const Vec3 p = next();
        for (int i = 0; i < 3; ++i) instance.transform[3][i] = p[i];
        scene.instances.push_back(instance);
    }
    Index add(Texture texture) {
        scene.textures.push_back(std::move(texture));
        return Index(scene.textures.size() - 1);
    }
};

inline Material shiny(const std::string& name) {
    return {.name = name,
            .color = {0.8F, 0.5F, 0.2F},
            .ambient = {0.1F, 0.2F, 0.05F},
            .specular = 0.4F,
            .shininess = 25};
}

}  // namespace test
