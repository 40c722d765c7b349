#include "exporters/pov/object_text.h"

#include "exporters/pov/sdl.h"

#include "penumbra/light_model.h"

#include <fmt/format.h>

namespace penumbra::pov {

using sdl::number;

std::string light_title(const Light& light, std::size_t count) {
    const char* const type = light.type == Light::Type::point  ? "point light"
                             : light.type == Light::Type::spot ? "spot light"
                                                               : "directional light";
    std::string title = light.name.empty() ? type : sdl::comment(light.name) + ": " + type;
    if (count == 1) return title;
    const Penumbra& penumbra = light.penumbra;
    title += fmt::format(", {} virtual sources (", count);
    switch (penumbra.layout) {
    case Penumbra::Layout::axes: title += "axes"; break;
    case Penumbra::Layout::sphere: title += "sphere"; break;
    case Penumbra::Layout::grid:
        title += fmt::format("grid of {} x {}", penumbra.count[0], penumbra.count[1]);
        break;
    }
    return title + ", delta " + number(penumbra.delta) + ")";
}

std::string interior(const Material& m, bool passed) {
    if (!passed && !m.fresnel) return "";
    const bool absorbs = m.absorption && !opaque(m);
    std::string text = " interior { ior " + number(opaque(m) && !m.fresnel ? 1 : m.ior);
    if (absorbs)
        text += " fade_distance " + number(float(m.absorption->distance)) +
                " fade_power 1001 fade_color " + sdl::color(fade_color(*m.absorption));
    return text + " }";
}

std::string placement(const Matrix& m) {
    Matrix linear = m;
    for (int column = 0; column < 3; ++column) linear[3][column] = 0;
    const Vec3 move(m[3][0], m[3][1], m[3][2]);
    if (linear == Matrix()) return move == Vec3(0) ? "" : " translate " + sdl::vector(move);
    std::string text = "\n    matrix <";
    for (int row = 0; row < 4; ++row)
        text += fmt::format("{}{}, {}, {}", row == 0 ? "" : ",\n            ", number(m[row][0]),
                            number(m[row][1]), number(m[row][2]));
    return text + ">\n   ";
}

}  // namespace penumbra::pov
