#include "exporters/pov/objects.h"

#include "exporters/pov/geometry.h"
#include "exporters/pov/material.h"
#include "exporters/pov/object_text.h"
#include "exporters/pov/sdl.h"

#include <fmt/format.h>

namespace penumbra::pov {

namespace {

using sdl::number;

struct Writer {
    const Plan& plan;
    const Scene& scene = *plan.scene;
    std::string out = {};

    // The material and what else stands in an object, after its transform: patterns in world space
    // must not move with it.
    std::string surface(const Look& look, bool with_texture = true, bool passed = false) const {
        const Material& m = scene.materials[look.material];
        std::string text =
            with_texture ? " texture { " + identifier(plan, "Material", look.name) + " }" : "";
        text += interior(m, passed || !opaque(m));
        if (frosted(plan, look) && !passed) text += " interior_texture { " + behind(look) + " }";
        return text;
    }

    // What the look shows to a ray that meets it from behind.
    std::string behind(const Look& look) const {
        return identifier(plan, "Material", look.name) + (frosted(plan, look) ? "__inside" : "");
    }

    void title(const std::string& name) {
        if (!name.empty()) out += "  // " + sdl::comment(name) + "\n";
    }

    // Which side a ray meets POV-Ray asks the normal that shades it: see scene/sides.h.
    std::string backs(std::size_t instance, const MeshPlan& mesh, const Look& look) const {
        const Backs& found = plan.backs[instance];
        if (!found.hidden) return "";
        const std::string nothing = identifier(plan, "Nothing");
        // POV-Ray asks for a texture of the front beside those in the mesh, and does not show it.
        std::string text = mesh.tints.empty() ? "" : " texture { pigment { rgb 0 } }";
        if (found.from == 0) return text + " interior_texture { " + nothing + " }";
        const std::string from = number(found.half_turns());
        return text +
               fmt::format("\n    interior_texture {{ aoi texture_map {{ [{} {}] [{} {}] }} }}",
                           from, behind(look), from, nothing);
    }

    // Backs cast shadows, too. POV-Ray sees that by itself where one plain opaque texture shows;
    // where textures are mixed or let light through it asks the interior texture as well.
    bool needs_shadow(std::size_t index) const {
        const MeshPlan& mesh = plan.meshes[scene.instances[index].mesh];
        if (mesh.name.empty() || !plan.backs[index].hidden) return false;
        const Material& m = scene.materials[plan.looks[mesh.look].material];
        return !opaque(m) || m.specular_lobes || m.blend;
    }

    void instance(std::size_t index) {
        const Instance& instance = scene.instances[index];
        const MeshPlan& mesh = plan.meshes[instance.mesh];
        if (mesh.name.empty()) return;
        if (instance.name != scene.meshes[instance.mesh].name) title(instance.name);
        const std::string where = placement(instance.transform);
        const Look& look = plan.looks[mesh.look];
        const bool passed = plan.backs[index].hidden;
        const std::string text = where + surface(look, mesh.tints.empty(), passed);
        const bool two = needs_shadow(index);
        object(mesh, look,
               text + backs(index, mesh, look) + (two ? " no_shadow" : "") + seen_directly(look));
        if (look.twin != no_index) {
            const Look& twin = plan.looks[look.twin];
            object(mesh, twin,
                   where + surface(twin, mesh.tints.empty(), passed) + backs(index, mesh, twin) +
                       seen_in_mirrors);
        }
        if (two) object(mesh, look, text + " no_image no_reflection");  // the shadow
    }

    // Rays that were mirrored see a single mirror in place of several: see blurs().
    static std::string seen_directly(const Look& look) {
        return look.twin == no_index ? "" : " no_reflection";
    }
    static constexpr const char* seen_in_mirrors = " no_image no_shadow";

    void object(const MeshPlan& mesh, const Look& look, const std::string& text) {
        out += "  object { " + mesh_identifier(plan, mesh, look) + text;
        out += text.find('\n') == std::string::npos ? " }\n" : "\n  }\n";
    }

    // A sphere or a plane, with its twin where it has one.
    void shape(const std::string& text, const Look& look, bool in_mirrors = true,
               const char* flags = "") {
        out += "  " + text + surface(look) + flags +
               (in_mirrors ? seen_directly(look) : " no_reflection") + " }\n";
        if (in_mirrors && look.twin != no_index)
            out += "  " + text + surface(plan.looks[look.twin]) + seen_in_mirrors + " }\n";
    }

    void sphere(const Sphere& sphere, const Look& look) {
        title(sphere.name);
        shape("sphere { " + sdl::vector(sphere.center) + ", " + number(sphere.radius), look);
    }

    void plane(const Plane& plane, const Look& look) {
        title(plane.name);
        const Vec3 normal = plane.normal.normalized();
        shape("plane { " + sdl::vector(normal) + ", " + number(normal.dot(plane.point)), look,
              plane.in_mirrors, plane.casts_shadow ? "" : " no_shadow");
    }

    void objects() {
        for (std::size_t i = 0; i < scene.instances.size(); ++i) instance(i);
        for (std::size_t i = 0; i < scene.spheres.size(); ++i)
            sphere(scene.spheres[i], plan.looks[plan.spheres[i]]);
        for (std::size_t i = 0; i < scene.planes.size(); ++i)
            plane(scene.planes[i], plan.looks[plan.planes[i]]);
    }

    bool has_twin(Index look) const { return plan.looks[look].twin != no_index; }

    std::size_t object_count() const {
        std::size_t count = 0;
        for (const Index look : plan.spheres) count += has_twin(look) ? 2 : 1;
        for (std::size_t i = 0; i < scene.planes.size(); ++i)
            count += has_twin(plan.planes[i]) && scene.planes[i].in_mirrors ? 2 : 1;
        for (std::size_t i = 0; i < scene.instances.size(); ++i) {
            const MeshPlan& mesh = plan.meshes[scene.instances[i].mesh];
            if (is_drawn(mesh)) count += (needs_shadow(i) ? 2 : 1) + (has_twin(mesh.look) ? 1 : 0);
        }
        return count;
    }
};

}  // namespace

bool is_drawn(const MeshPlan& mesh) { return !mesh.name.empty(); }

std::string objects_text(const Plan& plan) {
    Writer writer{plan};
    writer.objects();
    return std::move(writer.out);
}

std::size_t object_count(const Plan& plan) { return Writer{plan}.object_count(); }

}  // namespace penumbra::pov
