#include "tracer/back_light.h"

#include "tracer/direct_light.h"

#include <vector>

namespace penumbra {

namespace {

// A matte surface that faces away from the eye takes each point's place: what that scatters is
// what shows on this side.
void turn_over(const SurfacePoints& surfaces, std::size_t from, SurfacePoints& behind,
               std::size_t to) {
    static const PreparedMaterial matte;
    behind.position.set(to, surfaces.position[from]);
    behind.normal.set(to, -surfaces.normal[from]);
    behind.view.set(to, surfaces.view[from]);
    behind.reflected.set(to, surfaces.reflected[from]);
    behind.facet_normal.set(to, surfaces.facet_normal[from]);
    behind.pigment.set(to, surfaces.from_behind[from]);
    behind.emitted.set(to, Vec3(0));
    behind.diffuse[to] = 1;
    behind.alpha[to] = 1;
    behind.object[to] = surfaces.object[from];
    behind.material[to] = &matte;
    behind.inside[to] = surfaces.inside[from];
}

}  // namespace

void add_back_light(const PreparedScene& prepared, const SurfacePoints& surfaces,
                    Vec3Array& radiance) {
    std::vector<std::size_t> chosen;
    for (std::size_t i = 0; i < surfaces.count; ++i)
        if (surfaces.material[i]->backlit) chosen.push_back(i);
    if (chosen.empty()) return;
    SurfacePoints behind(chosen.size());
    behind.count = chosen.size();
    for (std::size_t i = 0; i < chosen.size(); ++i) turn_over(surfaces, chosen[i], behind, i);
    LightWork work(chosen.size());
    Vec3Array light(chosen.size());
    add_direct_light(prepared, behind, work, light);
    for (std::size_t c = 0; c < 3; ++c)
        for (std::size_t i = 0; i < chosen.size(); ++i)
            radiance.axis[c][chosen[i]] += light.axis[c][i];
}

}  // namespace penumbra
