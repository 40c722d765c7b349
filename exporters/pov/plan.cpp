#include "exporters/pov/plan.h"

#include "base/hash.h"
#include "base/text/ascii.h"
#include "exporters/pov/sdl.h"
#include "scene/check_options.h"
#include "scene/surface/vertex_textures.h"
#include "scene/texture/image_maps.h"

#include "penumbra/light_model.h"

#include <fmt/format.h>
#include <half.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <span>
#include <tuple>
#include <unordered_map>

namespace penumbra::pov {

namespace {

constexpr int most_tiles = 8;           // of a padded image, per axis
constexpr double most_texels = 64e6;    // of a padded image
constexpr int most_trace_levels = 256;  // source/backend/configbackend.h, MAX_TRACE_LEVEL
constexpr int most_subpixels = 9;       // source/backend/scene/view.cpp, Antialias_Depth

// Part of the texture's plane that the scene looks up.
struct Range {
    double min = std::numeric_limits<double>::infinity();
    double max = -std::numeric_limits<double>::infinity();
    void extend(double x) {
        min = std::min(min, x);
        max = std::max(max, x);
    }
};

const ImageMap* image_of(const Material& material) {
    return std::get_if<ImageMap>(&material.pattern);
}

// All images that a material shows.
std::vector<const ImageMap*> maps_of(const Material& material, bool mesh) {
    std::vector<const ImageMap*> maps;
    each_image_map(material, [&](const ImageMap& map, MapUse use) {
        const bool shown = use != MapUse::normal && (mesh || use == MapUse::pattern);
        if (shown && map.texture != no_index) maps.push_back(&map);
    });
    return maps;
}

struct TintBits {
    std::array<std::uint32_t, 7> bits;
    explicit TintBits(const Tint& t)
        : bits{bits_of(t.color.x), bits_of(t.color.y), bits_of(t.color.z), bits_of(t.alpha),
               bits_of(t.other.x), bits_of(t.other.y), bits_of(t.other.z)} {}
    bool operator==(const TintBits&) const = default;
    // Equal numbers have equal bits, 0 and -0 too.
    static std::uint32_t bits_of(float x) { return std::bit_cast<std::uint32_t>(x + 0.0F); }
};

struct TintHash {
    std::size_t operator()(const TintBits& t) const {
        return hash_of(std::as_bytes(std::span(t.bits)));
    }
};

struct Planner {
    Plan plan = {};
    const Scene& scene;
    std::vector<std::array<Range, 2>> ranges = {};  // u and v, per texture
    std::map<std::tuple<Index, Look::Surface, bool>, Index> known = {};
    sdl::Names look_names = {}, mesh_names = {}, file_names = {};

    void note_loss(const Loss& loss) {
        const Losses& known_losses = plan.losses;
        if (std::find(known_losses.begin(), known_losses.end(), loss) == known_losses.end())
            plan.losses.push_back(loss);
    }

    Index add_look(Look look) {
        const Material& material = scene.materials[look.material];
        std::string name = material.name;
        if (look.surface == Look::Surface::sphere) name += "_sphere";
        if (look.surface == Look::Surface::plane) name += "_plane";
        if (look.tinted) name += "_tinted";
        look.name = look_names.unique(name, std::to_string(plan.looks.size() + 1));
        const auto index = Index(plan.looks.size());
        if (!blurs(material)) {
            plan.looks.push_back(std::move(look));
            return index;
        }
        Look twin = look;
        look.twin = index + 1;
        twin.mirrored = true;
        twin.name += "__mirrored";
        plan.looks.push_back(std::move(look));
        plan.looks.push_back(std::move(twin));
        return index;
    }

    Index look_of(Index material, Look::Surface surface, bool tinted = false) {
        const bool mesh = surface == Look::Surface::mesh;
        if (maps_of(scene.materials[material], mesh).empty()) surface = Look::Surface::any;
        const auto [entry, added] = known.try_emplace({material, surface, tinted}, Index(0));
        if (added)
            entry->second = add_look({.material = material, .surface = surface, .tinted = tinted});
        return entry->second;
    }

    Index look_of(const Plane& plane) {
        if (image_of(scene.materials[plane.material]) == nullptr)
            return look_of(plane.material, Look::Surface::plane);
        return add_look({.material = plane.material,
                         .surface = Look::Surface::plane,
                         .frame = plane_frame(plane)});
    }

    void use_texture(Index texture, const std::array<Range, 2>& part) {
        for (std::size_t axis = 0; axis < 2; ++axis) {
            ranges[texture][axis].extend(part[axis].min);
            ranges[texture][axis].extend(part[axis].max);
        }
    }

    void use_image(const Material& material, const std::array<Range, 2>& part) {
        if (const ImageMap* image = image_of(material)) use_texture(image->texture, part);
    }

    // The part of the image that the mesh looks up.
    void use_map(const ImageMap& map, const Mesh& mesh) {
        std::array<Range, 2> part;
        for (const auto& triangle : mesh.triangles) {
            for (const Index corner : triangle) {
                const Vec2 uv = mesh.texcoords.empty() ? Vec2(0) : Vec2(mesh.texcoords[corner]);
                const Vec2 at = map_texcoord(map, uv);
                part[0].extend(at.x);
                part[1].extend(at.y);
            }
        }
        use_texture(map.texture, part);
    }

    void find_tints(const Mesh& mesh, bool colored, bool faded, MeshPlan& out) {
        const Material& material = scene.materials[mesh.material];
        const Color& base = material.color;
        const auto& blend = material.blend;
        std::unordered_map<TintBits, Index, TintHash> seen;
        out.tint_of.reserve(mesh.positions.size());
        for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
            Tint tint = {colored ? base * mesh.colors[i] : base,
                         faded ? std::clamp(mesh.alphas[i], 0.0F, 1.0F) : 1};
            if (blend && colored) tint.other = blend->other[0].color * mesh.colors[i];
            const auto [entry, added] = seen.try_emplace(TintBits(tint), Index(out.tints.size()));
            if (added) out.tints.push_back(tint);
            out.tint_of.push_back(entry->second);
        }
    }

    void add_mesh(const Mesh& mesh, MeshPlan& out) {
        const Material& material = scene.materials[mesh.material];
        const auto [tinted, faded] = vertex_textures(mesh, material);
        out.name = mesh_names.unique(mesh.name, std::to_string(&mesh - scene.meshes.data() + 1));
        out.look = look_of(mesh.material, Look::Surface::mesh, tinted);
        out.normals = material.smooth && !mesh.normals.empty();
        const std::vector<const ImageMap*> maps = maps_of(material, true);
        out.texcoords = !maps.empty() && !mesh.texcoords.empty();
        if (tinted || faded) find_tints(mesh, tinted, faded, out);
        for (const ImageMap* map : maps) use_map(*map, mesh);
    }

    void add_objects() {
        std::vector<bool> placed(scene.meshes.size(), false);
        for (const Instance& i : scene.instances) placed[i.mesh] = true;
        for (std::size_t k = 0; k < scene.meshes.size(); ++k)
            if (placed[k] && !scene.meshes[k].triangles.empty())
                add_mesh(scene.meshes[k], plan.meshes[k]);
        for (const Sphere& s : scene.spheres) {
            plan.spheres.push_back(look_of(s.material, Look::Surface::sphere));
            use_image(scene.materials[s.material], {Range{0, 1}, Range{0, 1}});
        }
        for (const Plane& p : scene.planes) {
            plan.planes.push_back(look_of(p));
            use_image(scene.materials[p.material], {Range{-1e9, 1e9}, Range{-1e9, 1e9}});
        }
    }

    // Texels whose lookup needs no wrapping are left as they are. The border texels of a clamped
    // image are repeated as far as the scene looks; POV-Ray's own `once` takes a coordinate of
    // exactly 1 for 0 and anything beyond for a hole.
    BakedAxis axis(const Texture& texture, Wrap wrap, int size, const Range& range) {
        if (wrap == Wrap::repeat) return {size, 0, size};
        if (wrap == Wrap::mirror) return {size, 0, 2 * size};
        const double slack = 1e-3;  // for coordinates that interpolation rounds
        const double low = std::floor(range.min * size + 0.5 - slack) - 1;
        const double high = std::floor(range.max * size + 0.5 + slack);
        const double first = std::min(0.0, low), last = std::max(size - 1.0, high);
        if (last - first + 1 <= double(most_tiles) * std::max(size, 2))
            return {size, int(first), int(last - first + 1)};
        note_loss({Loss::approximated, texture.name,
                   "the clamped image is used so far outside of its "
                   "edges that it is repeated there"});
        return {size, low < 0 ? -size : 0, size + (low < 0 ? size : 0) + (high >= size ? size : 0)};
    }

    // An earlier texture whose file would be the same; models often use an image with several
    // samplers.
    const TextureFile* same_file(const Texture& texture, const TextureFile& wanted) const {
        const Raster& raster = texture.raster;
        for (std::size_t i = 0; i < scene.textures.size(); ++i) {
            const Texture& other = scene.textures[i];
            const TextureFile& file = plan.textures[i];
            const bool whole_u = wanted.u.count == raster.width;
            const bool whole_v = wanted.v.count == raster.height;
            if (!file.file.empty() && file.u == wanted.u && file.v == wanted.v &&
                (whole_u || other.wrap_u == texture.wrap_u) &&
                (whole_v || other.wrap_v == texture.wrap_v) &&
                other.raster.channels == raster.channels && other.raster.depth == raster.depth &&
                other.raster.data == raster.data)
                return &file;
        }
        return nullptr;
    }

    void add_texture(const Texture& texture, const std::array<Range, 2>& part, TextureFile& out) {
        const Raster& raster = texture.raster;
        out.u = axis(texture, texture.wrap_u, raster.width, part[0]);
        out.v = axis(texture, texture.wrap_v, raster.height, part[1]);
        if (double(out.u.count) * out.v.count > most_texels &&
            (texture.wrap_u != Wrap::repeat || texture.wrap_v != Wrap::repeat)) {
            note_loss({Loss::approximated, texture.name,
                       "the image is too large to hold its mirrored or "
                       "clamped surroundings, and repeats"});
            out.u = {raster.width, 0, raster.width};
            out.v = {raster.height, 0, raster.height};
        }
        if (const TextureFile* same = same_file(texture, out)) {
            out.file = same->file;
            return;
        }
        const bool floats = raster.depth == Depth::f32;
        const std::size_t slash = texture.name.find_last_of("/\\");
        std::string name =
            slash == std::string::npos ? texture.name : texture.name.substr(slash + 1);
        if (const std::size_t dot = name.rfind('.'); dot != std::string::npos && dot > 0)
            name.resize(dot);
        out.file = plan.stem + "_textures/" + file_names.unique(name, "texture") +
                   (floats ? ".exr" : ".png");
        if (floats) check_half(texture);
    }

    // POV-Ray 3.7 reads OpenEXR files in half precision (source/base/image/openexr.cpp).
    void check_half(const Texture& texture) {
        const std::vector<std::byte>& data = texture.raster.data;
        for (std::size_t i = 0; i + sizeof(float) <= data.size(); i += sizeof(float)) {
            float value = 0;
            std::memcpy(&value, data.data() + i, sizeof value);
            if (float(Imath::half(value)) == value) continue;
            note_loss({Loss::approximated, texture.name,
                       "POV-Ray reads float images with 11 significant "
                       "bits"});
            return;
        }
    }

    void note_approximations() {
        for (const Look& look : plan.looks) {
            note_approximations(look, scene.materials[look.material]);
            if (const auto& blend = scene.materials[look.material].blend)
                note_approximations(look, blend->other.front());
        }
    }

    void note_approximations(const Look& look, const Material& m) {
        const bool product = image_of(m) != nullptr && (look.tinted || m.color != Color(1));
        const bool own_tint =
            m.specular_color || (m.specular_lobes && m.specular_lobes->color.texture != no_index);
        if (m.normal_map)
            note_loss({Loss::dropped, m.name,
                       "its normal map is dropped: POV-Ray has none in tangent space"});
        if (product && m.metallic > 0 && !own_tint)
            note_loss({Loss::approximated, m.name,
                       "highlights and reflections of the textured metal take no "
                       "vertex colours: approximate"});
        if (look.tinted && takes_reflected(m) && m.metallic > 0 && !own_tint)
            note_loss(
                {Loss::approximated, m.name,
                 "vertex colours tint what its reflection takes from the light that it scatters"});
        if (product && m.opacity < 1)
            note_loss({Loss::approximated, m.name,
                       "vertex colours over a translucent texture also "
                       "tint what lies behind"});
    }

    void note_limits(const RenderOptions& render) {
        if (render.max_depth > most_trace_levels)
            note_loss({Loss::approximated, "max_depth",
                       fmt::format("POV-Ray follows at most {} ray segments", most_trace_levels)});
        if (!render.antialiasing && render.samples > most_subpixels)
            note_loss(
                {Loss::approximated, "samples",
                 fmt::format("POV-Ray's grid has at most {0} x {0} samples", most_subpixels)});
    }
};

bool plain_stem(const std::string& stem) {
    const auto harmless = [](char c) {
        return is_letter_or_digit(c) || c == '_' || c == '-' || c == '.';
    };
    return !stem.empty() && stem[0] != '-' && std::all_of(stem.begin(), stem.end(), harmless);
}

// FNV-1a and not base/hash.h, for what scenes by others name must stay what it was.
std::uint32_t lasting_hash(const std::string& text) {
    std::uint32_t hash = 2166136261U;
    for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 16777619U;
    return hash;
}

}  // namespace

std::string safe_stem(const std::string& stem) {
    if (plain_stem(stem)) return stem;
    // Keeps "my chair" apart from "my_chair".
    const std::uint32_t hash = lasting_hash(stem);
    const std::string word = sdl::word(stem);
    return fmt::format("{}_{:04x}", word.empty() ? "scene" : word, (hash ^ (hash >> 16)) & 0xFFFFU);
}

std::string safe_identifier(const std::string& stem) {
    std::string word = sdl::word(stem);
    if (!word.empty() && word == stem) return word;
    return fmt::format("{}_{:08x}", word.empty() ? "scene" : word, lasting_hash(stem));
}

bool needs_nothing(const Plan& plan) {
    return std::ranges::any_of(plan.backs, &Backs::hidden) ||
           std::ranges::any_of(plan.looks, [&](const Look& look) {
               return plan.scene->materials[look.material].alpha_map.has_value();
           });
}

const Material& material_of(const Plan& plan, const Look& look) {
    const Material& material = plan.scene->materials[look.material];
    return look.other ? material.blend->other.front() : material;
}

std::string identifier(const Plan& plan, const char* kind, const std::string& name) {
    return fmt::format("{}_{}{}{}", kind, plan.model, in_other_scenes(plan) ? "__" : "", name);
}

std::string identifier(const Plan& plan, const char* only) {
    return fmt::format("{}{}{}", only, in_other_scenes(plan) ? "_" : "", plan.model);
}

Plan make_plan(const Scene& scene, const RenderOptions& render, const std::string& stem,
               PovStyle style) {
    check(render);
    assert(defects(scene).empty());
    Planner planner{.scene = scene};
    planner.plan.scene = &scene;
    planner.plan.stem = safe_stem(stem);
    if (style == PovStyle::include) planner.plan.model = safe_identifier(stem);
    planner.plan.meshes.resize(scene.meshes.size());
    planner.plan.textures.resize(scene.textures.size());
    planner.ranges.resize(scene.textures.size());
    planner.add_objects();
    planner.plan.backs = backs(scene);
    for (const std::optional<Sky>& sky : {scene.sky, scene.mirror_sky})
        if (sky) planner.use_texture(sky->texture, {Range{0, 1}, Range{0, 1}});
    for (std::size_t i = 0; i < scene.textures.size(); ++i)
        if (planner.ranges[i][0].min <= planner.ranges[i][0].max)
            planner.add_texture(scene.textures[i], planner.ranges[i], planner.plan.textures[i]);
    planner.note_approximations();
    planner.note_limits(render);
    return std::move(planner.plan);
}

}  // namespace penumbra::pov
