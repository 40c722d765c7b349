#include "importers/gltf/nodes/light_cube.h"

#include "base/memory.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>

namespace penumbra::gltf {

namespace {

constexpr int widest = 2048;  // pixels of the image

// Where a direction meets a cube of side 2: the face, and its coordinates in [-1, 1] to the right
// and down (OpenGL 4.6, table 8.19).
struct CubePoint {
    std::size_t face = 0;
    double s = 0, t = 0;
};

CubePoint on_cube(const Vec3& d) {
    const double x = std::abs(d.x), y = std::abs(d.y), z = std::abs(d.z);
    if (x >= y && x >= z)
        return d.x > 0 ? CubePoint{0, -d.z / x, -d.y / x} : CubePoint{1, d.z / x, -d.y / x};
    if (y >= z) return d.y > 0 ? CubePoint{2, d.x / y, d.z / y} : CubePoint{3, d.x / y, -d.z / y};
    return d.z > 0 ? CubePoint{4, d.x / z, -d.y / z} : CubePoint{5, -d.x / z, -d.y / z};
}

Vec3 from_cube(const CubePoint& p) {
    switch (p.face) {
    case 0: return {1, -p.t, -p.s};
    case 1: return {-1, -p.t, p.s};
    case 2: return {p.s, 1, p.t};
    case 3: return {p.s, -1, -p.t};
    case 4: return {p.s, -p.t, 1};
    default: return {-p.s, -p.t, -1};
    }
}

// How much what lies on one side of the cube's edges differs from the other side.
double torn(const LightCube& cube) {
    const double step = 1.0 / cube.size;
    double sum = 0;
    for (std::size_t face = 0; face < 6; ++face)
        for (int i = 0; i < cube.size; ++i) {
            const double along = (2 * i + 1) * step - 1;
            for (const double side : {-1.0, 1.0}) {
                const double in = side * (1 - step), out = side * (1 + step);
                const Color row =
                    cube.at(from_cube({face, along, in})) - cube.at(from_cube({face, along, out}));
                const Color column =
                    cube.at(from_cube({face, in, along})) - cube.at(from_cube({face, out, along}));
                sum += double(row.length()) + double(column.length());
            }
        }
    return sum;
}

// The mean over n x n directions of equal area.
Color mean_in(const LightCube& cube, int x, int y, int width, int n) {
    const int height = width / 2;
    const double top = std::cos(std::numbers::pi * y / height);
    const double bottom = std::cos(std::numbers::pi * (y + 1) / height);
    Vec3 sum(0);
    for (int j = 0; j < n; ++j) {
        const double up = top + (bottom - top) * (j + 0.5) / n, level = std::sqrt(1 - up * up);
        for (int i = 0; i < n; ++i) {
            const double turn = ((x + (i + 0.5) / n) / width - 0.5) * 2 * std::numbers::pi;
            sum += Vec3(cube.at({std::sin(turn) * level, up, -std::cos(turn) * level}));
        }
    }
    return Color(sum / (n * n));
}

}  // namespace

const Color& LightCube::at(const Vec3& direction) const {
    const auto [face, s, t] = on_cube(direction);
    const auto texel = [&](double place, bool back) {
        const int i = std::clamp(int(std::floor((place + 1) / 2 * size)), 0, size - 1);
        return std::size_t(back ? size - 1 - i : i);
    };
    return faces[face][texel(t, flip.rows) * std::size_t(size) + texel(s, flip.columns)];
}

void set_flip(LightCube& cube) {
    double least = 0;
    LightCube::Flip best;
    bool first = true;
    for (const bool rows : {true, false})
        for (const bool columns : {false, true}) {
            cube.flip = {.columns = columns, .rows = rows};
            const double found = torn(cube);
            if (first || found < least) {
                least = found;
                best = cube.flip;
            }
            first = false;
        }
    cube.flip = best;
}

Texture equirectangular(const LightCube& cube, const std::string& name) {
    const int width = std::min(4 * cube.size, widest);
    const int each = 4 * std::max(1, 4 * cube.size / width);
    Texture texture = {.name = name, .srgb = false};
    Raster& raster = texture.raster;
    raster = {.width = width, .height = width / 2, .channels = 3, .depth = Depth::f32};
    const std::size_t bytes = raster.texels() * sizeof(Color);
    const MemoryClaim claim(bytes, "environment " + name);
    raster.data.resize(bytes);
    for (int y = 0; y < raster.height; ++y)
        for (int x = 0; x < width; ++x) {
            const Color color = mean_in(cube, x, y, width, each);
            const auto pixel = std::size_t(y) * std::size_t(width) + std::size_t(x);
            std::memcpy(raster.data.data() + pixel * sizeof color, &color.x, sizeof color);
        }
    return texture;
}

}  // namespace penumbra::gltf
