// What if surfaces were others: highlights, mirrors, smoothness, colours, textures.
#include "validation/diagnosis/experiment.h"
#include "validation/diagnosis/finding.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <set>

namespace penumbra::metrics {
namespace {

std::string looks_as_if(const std::string& what) { return "the reference looks as if " + what; }

void each_lobe(Scene& scene, const std::function<void(SpecularLobe&)>& change) {
    for (Material& m : scene.materials) {
        SpecularLobe own = {
            .specular = m.specular, .shininess = m.shininess, .reflection = m.reflection};
        change(own);
        m.specular = own.specular;
        m.shininess = own.shininess;
        m.reflection = own.reflection;
        if (m.specular_lobes)
            for (SpecularLobe& lobe : m.specular_lobes->lobes) change(lobe);
    }
}

struct Suspect {
    Index material = no_index;
    double share = 0;  ///< of the error, in the pixels that show it
};

// Materials that the error lies on, the most of it first.
std::vector<Suspect> suspects(const Experiment& experiment, double least_share, std::size_t most) {
    std::vector<Suspect> result;
    for (Index i = 0; i < experiment.scene().materials.size(); ++i) {
        const double share = experiment.share(pixels_of_material(experiment, i));
        if (share >= least_share) result.push_back({i, share});
    }
    std::ranges::stable_sort(result, std::greater<>(), &Suspect::share);
    if (result.size() > most) result.resize(most);
    return result;
}

std::string name_of(const Experiment& experiment, Index material) {
    return named(experiment.scene().materials[material].name, material);
}

// ---- highlights -------------------------------------------------------------------------------

void suppose_shininess(Experiment& experiment) {
    const Found found = experiment.seek({.start = 0,
                                         .step = std::log(1.5),
                                         .low = std::log(1 / 20.0),
                                         .high = std::log(20.0),
                                         .change = [](double log_factor) -> Change {
                                             return [=](Variant& v) {
                                                 each_lobe(v.scene, [&](SpecularLobe& lobe) {
                                                     lobe.shininess *= float(std::exp(log_factor));
                                                 });
                                             };
                                         }});
    if (found.value != 0)
        experiment.suppose({found.left, "shininess",
                            looks_as_if(fmt::format("the shininess were {:.2g} times as high",
                                                    std::exp(found.value)))});
}

// ---- mirrors and glass ------------------------------------------------------------------------

void suppose_reflection(Experiment& experiment, std::optional<Index> only) {
    const auto scaled = [=](double factor) -> Change {
        return [=](Variant& v) {
            if (!only)
                return each_lobe(v.scene, [&](SpecularLobe& l) { l.reflection *= float(factor); });
            Material& m = v.scene.materials[*only];
            m.reflection *= float(factor);
            if (m.specular_lobes)
                for (SpecularLobe& lobe : m.specular_lobes->lobes) lobe.reflection *= float(factor);
        };
    };
    const std::string of = only ? " of the material " + name_of(experiment, *only) : std::string();
    const Trial none = experiment.with(scaled(0));
    if (experiment.support(none.linear) < 0.6) return;
    experiment.suppose(
        {none.left, "reflection", looks_as_if("the reflection" + of + " were missing")});
    const Found found =
        experiment.seek({.start = 1, .step = -0.33, .low = 0, .high = 4, .change = scaled});
    experiment.suppose({found.left, "reflection",
                        looks_as_if("the reflection" + of + " were " +
                                    more_or_less(found.value, "stronger", "weaker"))});
}

void suppose_depth(Experiment& experiment) {
    const int own = experiment.options().max_depth;
    for (const int depth : std::set{1, 2, 3, own - 1, own + 1, 2 * own}) {
        if (depth < 1 || depth == own) continue;
        const Trial trial = experiment.with([&](Variant& v) { v.options.max_depth = depth; });
        experiment.suppose({trial.left, "depth",
                            looks_as_if(fmt::format("it were traced {} instead of {} segments deep",
                                                    depth, own))});
        if (trial.left < 0.001) return;
    }
}

void suppose_opacity(Experiment& experiment) {
    const auto& materials = experiment.scene().materials;
    if (std::ranges::all_of(materials, [](const Material& m) { return opaque(m); })) return;
    const Trial closed = experiment.with([](Variant& v) {
        for (Material& m : v.scene.materials) {
            m.opacity = 1;
            m.alpha_map.reset();
        }
    });
    experiment.suppose({closed.left, "transparency", looks_as_if("nothing were transparent")});
    const Trial straight = experiment.with([](Variant& v) {
        for (Material& m : v.scene.materials) m.ior = 1;
    });
    experiment.suppose({straight.left, "refraction", looks_as_if("nothing refracted light")});
}

// ---- colours ----------------------------------------------------------------------------------

void scale_pigment(Material& material, const Color& factor) {
    if (auto* checker = std::get_if<Checker>(&material.pattern))
        for (Color& color : checker->colors) color *= factor;
    else if (auto* noise = std::get_if<Noise>(&material.pattern))
        for (Color& color : noise->colors) color *= factor;
    else
        material.color *= factor;
}

// "0.86 times", or three numbers when the channels differ.
std::string times(const std::array<double, 3>& factor) {
    const auto [least, most] = std::ranges::minmax(factor);
    if (most - least < 0.02 * most) return fmt::format("{:.3g} times", factor[1]);
    return fmt::format("{:.3g}, {:.3g} and {:.3g} times (red, green, blue)", factor[0], factor[1],
                       factor[2]);
}

void suppose_albedo(Experiment& experiment, Index material) {
    constexpr float first = 0.8F;
    const auto scaled = [&](const Color& factor) {
        return experiment.with(
            [&](Variant& v) { scale_pigment(v.scene.materials[material], factor); });
    };
    const Trial darker = scaled(Color(first));
    if (experiment.support(darker.linear) < 0.6) return;
    std::array<double, 3> factor = experiment.fit_channels(darker.linear - experiment.test());
    for (double& k : factor) k = std::clamp(1 - double(1 - first) * k, 0.0, 20.0);
    const Trial trial = scaled({float(factor[0]), float(factor[1]), float(factor[2])});
    experiment.suppose({trial.left, "albedo",
                        looks_as_if("the colour of the material " + name_of(experiment, material) +
                                    " were " + times(factor) + " as bright")});
}

// ---- textures ---------------------------------------------------------------------------------

// A texture lookup as a change of u and v: (u, v) -> (a u + b v + c, d u + e v + f).
struct Relook {
    std::array<double, 6> t = {};
    const char* sentence = "";
};

constexpr std::array relooks = {Relook{{-1, 0, 1, 0, 1, 0}, "mirrored left to right"},
                                Relook{{1, 0, 0, 0, -1, 1}, "upside down"},
                                Relook{{-1, 0, 1, 0, -1, 1}, "turned by 180 degrees"},
                                Relook{{0, 1, 0, 1, 0, 0}, "mirrored at its diagonal"},
                                Relook{{0, 1, 0, -1, 0, 1}, "turned by 90 degrees"},
                                Relook{{0, -1, 1, 1, 0, 0}, "turned by 90 degrees"}};

// Before an image map's own transform has been applied, `t` is applied to what it gives.
void look_elsewhere(ImageMap& map, const std::array<double, 6>& t) {
    const std::array<double, 6> m = map.transform;
    for (std::size_t row = 0; row < 2; ++row) {
        const double a = t[3 * row], b = t[3 * row + 1], c = t[3 * row + 2];
        for (std::size_t k = 0; k < 3; ++k)
            map.transform[3 * row + k] = a * m[k] + b * m[3 + k] + (k == 2 ? c : 0);
    }
}

// The raster whose texel (x, y) is texel (from(x, y)) of the given one, for spheres and planes,
// whose image maps have no transform. Only mirrored ones keep their size.
Raster mirrored(const Raster& raster, bool across, bool along) {
    Raster result = raster;
    const std::size_t size = std::size_t(raster.channels) * std::size_t(raster.depth);
    const auto width = std::size_t(raster.width), height = std::size_t(raster.height);
    for (std::size_t y = 0; y < height; ++y)
        for (std::size_t x = 0; x < width; ++x) {
            const std::size_t u = across ? width - 1 - x : x, v = along ? height - 1 - y : y;
            std::memcpy(result.data.data() + (y * width + x) * size,
                        raster.data.data() + (v * width + u) * size, size);
        }
    return result;
}

ImageMap* image_of(Scene& scene, Index material) {
    return std::get_if<ImageMap>(&scene.materials[material].pattern);
}

bool of_meshes(const Experiment& experiment, Index material) {
    const Scene& scene = experiment.scene();
    return std::ranges::any_of(scene.instances, [&](const Instance& i) {
        return scene.meshes[i.mesh].material == material;
    });
}

void suppose_other_look(Experiment& experiment, Index material, const Relook& relook) {
    const bool mesh = of_meshes(experiment, material);
    const bool mirrors_only = relook.t[1] == 0;
    if (!mesh && !mirrors_only) return;
    const Trial trial = experiment.with([&](Variant& v) {
        ImageMap& map = *image_of(v.scene, material);
        if (mesh) return look_elsewhere(map, relook.t);
        Texture changed = v.scene.textures[map.texture];
        changed.raster = mirrored(changed.raster, relook.t[0] < 0, relook.t[4] < 0);
        map.texture = Index(v.scene.textures.size());
        v.scene.textures.push_back(std::move(changed));
    });
    experiment.suppose({trial.left, "texture",
                        looks_as_if("the texture of the material " + name_of(experiment, material) +
                                    " were " + relook.sentence)});
}

// How far the texture lies off, in texels, along both of its sides.
void suppose_offset(Experiment& experiment, Index material) {
    if (!of_meshes(experiment, material)) return;
    const Scene& scene = experiment.scene();
    const Index texture = std::get<ImageMap>(scene.materials[material].pattern).texture;
    const double width = scene.textures[texture].raster.width;
    const double height = scene.textures[texture].raster.height;
    const auto moved = [=](double u, double v) -> Change {
        return [=](Variant& variant) {
            look_elsewhere(*image_of(variant.scene, material), {1, 0, u / width, 0, 1, v / height});
        };
    };
    // Both signs are found from one of them.
    constexpr std::array<std::array<double, 2>, 4> directions = {
        {{0.5, 0.5}, {0.5, -0.5}, {0.5, 0}, {0, 0.5}}};
    for (const std::array<double, 2>& way : directions) {
        const Found found = experiment.seek(
            {.start = 0, .step = 1, .low = -4, .high = 4, .change = [=](double steps) {
                 return moved(steps * way[0], steps * way[1]);
             }});
        if (found.value == 0) continue;
        const Vec2 texels = Vec2(way[0], way[1]) * -found.value + Vec2(0);
        experiment.suppose(
            {found.left, "texture",
             looks_as_if(fmt::format("the texture of the material {} were moved by ({:+.2g}, "
                                     "{:+.2g}) texels",
                                     name_of(experiment, material), texels.x, texels.y))});
    }
}

void suppose_no_texture(Experiment& experiment, Index material) {
    const Trial plain = experiment.with(
        [&](Variant& v) { v.scene.materials[material].pattern = std::monostate(); });
    experiment.suppose({plain.left, "texture",
                        looks_as_if("the texture of the material " + name_of(experiment, material) +
                                    " were missing")});
    const Trial other = experiment.with([&](Variant& v) {
        for (Texture& texture : v.scene.textures) texture.bilinear = !texture.bilinear;
    });
    experiment.suppose(
        {other.left, "texture", looks_as_if("textures were interpolated in another way")});
}

}  // namespace

void suppose_highlights(Experiment& experiment) {
    const Trial dull = experiment.with(
        [](Variant& v) { each_lobe(v.scene, [](SpecularLobe& lobe) { lobe.specular = 0; }); });
    if (experiment.support(dull.linear) < 0.5) return;
    experiment.suppose({dull.left, "highlights", looks_as_if("highlights were missing")});
    const cv::Mat basis = experiment.test() - dull.linear;
    const double factor = 1 + experiment.fit({basis}).front();
    experiment.suppose(
        {experiment.left(experiment.test() + (factor - 1) * basis), "highlights",
         looks_as_if("highlights were " + more_or_less(factor, "brighter", "dimmer"))});
    suppose_shininess(experiment);
}

void suppose_recursion(Experiment& experiment) {
    const Trial flat = experiment.with([](Variant& v) { v.options.max_depth = 1; });
    if (experiment.support(flat.linear) < 0.6) return;
    suppose_reflection(experiment, std::nullopt);
    suppose_opacity(experiment);
    suppose_depth(experiment);
    for (const Suspect& suspect : suspects(experiment, 0.3, 2))
        if (!experiment.settled()) suppose_reflection(experiment, suspect.material);
}

namespace {

void suppose_sides(Experiment& experiment) {
    const Scene& scene = experiment.scene();
    if (scene.meshes.empty()) return;
    const bool hidden = std::ranges::any_of(scene.meshes, [&](const Mesh& mesh) {
        return scene.materials[mesh.material].sides == Sides::front;
    });
    const Trial other = experiment.with([&](Variant& v) {
        for (Material& m : v.scene.materials) m.sides = hidden ? Sides::both : Sides::front;
    });
    experiment.suppose(
        {other.left, "sides",
         looks_as_if(hidden ? "facets were shown from both sides"
                            : "facets were shown from the front alone (by winding)")});
}

}  // namespace

void suppose_surfaces(Experiment& experiment) {
    suppose_sides(experiment);
    const Scene& scene = experiment.scene();
    const bool smooth = std::ranges::any_of(scene.meshes, [&](const Mesh& mesh) {
        return !mesh.normals.empty() && scene.materials[mesh.material].smooth;
    });
    if (!smooth) return;
    const Trial facets = experiment.with([](Variant& v) {
        for (Material& m : v.scene.materials) m.smooth = false;
    });
    experiment.suppose(
        {facets.left, "smoothing", looks_as_if("meshes were shaded flat, without their normals")});
}

void suppose_pigments(Experiment& experiment) {
    for (const Suspect& suspect : suspects(experiment, 0.25, 3))
        if (!experiment.settled()) suppose_albedo(experiment, suspect.material);
}

void suppose_textures(Experiment& experiment) {
    for (const Suspect& suspect : suspects(experiment, 0.2, 2)) {
        const Material& material = experiment.scene().materials[suspect.material];
        if (!std::holds_alternative<ImageMap>(material.pattern)) continue;
        for (const Relook& relook : relooks)
            if (!experiment.settled()) suppose_other_look(experiment, suspect.material, relook);
        if (!experiment.settled()) suppose_offset(experiment, suspect.material);
        if (!experiment.settled()) suppose_no_texture(experiment, suspect.material);
    }
}

}  // namespace penumbra::metrics
