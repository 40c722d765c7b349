#include "tracer/light_loops.h"

#include "base/simd.h"

#include <cmath>

namespace penumbra {

namespace {

constexpr double least_light = 1e-10;  // POV-Ray skips a source whose light is weaker

double brightest(const PreparedSource& source) {
    return std::max({source.color.x, source.color.y, source.color.z});
}

PENUMBRA_VECTORISED
void aim_at_point(const Vec3& source, const SurfacePoints& surfaces, const Block& block,
                  LightSamples& out) {
    const Vec3View position(surfaces.position), normal(surfaces.normal);
    auto& [x_axis, y_axis, z_axis] = out.toward.axis;
    double *lx = x_axis.data(), *ly = y_axis.data(), *lz = z_axis.data();
    double *distance = out.distance.data(), *cosine = out.cosine.data(), *share = out.share.data();
    const double sx = source.x, sy = source.y, sz = source.z;
    PENUMBRA_INDEPENDENT
    for (std::size_t i = block.first; i < block.last; ++i) {
        const double x = sx - position.x[i], y = sy - position.y[i], z = sz - position.z[i];
        const double length = std::sqrt(x * x + y * y + z * z), scale = 1 / length;
        const double ux = x * scale, uy = y * scale, uz = z * scale;
        const double facing = normal.x[i] * ux + normal.y[i] * uy + normal.z[i] * uz;
        lx[i] = ux;
        ly[i] = uy;
        lz[i] = uz;
        distance[i] = length;
        cosine[i] = facing;
        share[i] = facing < least_cosine ? 0.0 : 1.0;
    }
}

PENUMBRA_VECTORISED
void aim_along(const PreparedSource& source, const SurfacePoints& surfaces, const Block& block,
               LightSamples& out) {
    const Vec3View position(surfaces.position), normal(surfaces.normal);
    auto& [x_axis, y_axis, z_axis] = out.toward.axis;
    double *lx = x_axis.data(), *ly = y_axis.data(), *lz = z_axis.data();
    double *distance = out.distance.data(), *cosine = out.cosine.data(), *share = out.share.data();
    const double sx = source.position.x, sy = source.position.y, sz = source.position.z;
    const double ax = source.axis.x, ay = source.axis.y, az = source.axis.z;
    PENUMBRA_INDEPENDENT
    for (std::size_t i = block.first; i < block.last; ++i) {
        const double facing = normal.x[i] * -ax + normal.y[i] * -ay + normal.z[i] * -az;
        lx[i] = -ax;
        ly[i] = -ay;
        lz[i] = -az;
        distance[i] =
            (position.x[i] - sx) * ax + (position.y[i] - sy) * ay + (position.z[i] - sz) * az;
        cosine[i] = facing;
        share[i] = facing < least_cosine ? 0.0 : 1.0;
    }
}

// f_a for the usual power, 2.
PENUMBRA_VECTORISED
void fade_by_square(double fade_distance, const Block& block, LightSamples& out) {
    const double* distance = out.distance.data();
    double* share = out.share.data();
    PENUMBRA_INDEPENDENT
    for (std::size_t i = block.first; i < block.last; ++i) {
        const double ratio = distance[i] / fade_distance;
        share[i] *= 2 / (1 + ratio * ratio);
    }
}

PENUMBRA_VECTORISED
void drop_faint(double light, const Block& block, LightSamples& out) {
    double* share = out.share.data();
    PENUMBRA_INDEPENDENT
    for (std::size_t i = block.first; i < block.last; ++i)
        share[i] = light * share[i] < least_light ? 0.0 : share[i];
}

PENUMBRA_VECTORISED
void dot_products(const Vec3Array& a, const Vec3Array& b, const Block& block, double* out) {
    const Vec3View p(a), q(b);
    PENUMBRA_INDEPENDENT
    for (std::size_t i = block.first; i < block.last; ++i)
        out[i] = p.x[i] * q.x[i] + p.y[i] * q.y[i] + p.z[i] * q.z[i];
}

// The falloff of a spot: POV-Ray's cubic smoothstep in the cosine.
double spot_falloff(const PreparedSource& source, const Vec3& toward) {
    const double cosine = -source.axis.dot(toward);
    if (cosine <= 0 || cosine <= source.cos_outer) return 0;
    if (cosine >= source.cos_inner) return 1;
    const double s = (cosine - source.cos_outer) / (source.cos_inner - source.cos_outer);
    return s * s * (3 - 2 * s);
}

PENUMBRA_VECTORISED
void add_from(const PreparedSource& source, const SurfacePoints& surfaces, const Block& block,
              Vec3Array& radiance) {
    const Vec3View position(surfaces.position), normal(surfaces.normal), pigment(surfaces.pigment);
    const double* diffuse = surfaces.diffuse.data();
    double *red = radiance.axis[0].data(), *green = radiance.axis[1].data(),
           *blue = radiance.axis[2].data();
    const double sx = source.position.x, sy = source.position.y, sz = source.position.z;
    const double r = source.color.x, g = source.color.y, b = source.color.z;
    PENUMBRA_INDEPENDENT
    for (std::size_t i = block.first; i < block.last; ++i) {
        const double x = sx - position.x[i], y = sy - position.y[i], z = sz - position.z[i];
        const double scale = 1 / std::sqrt(x * x + y * y + z * z);
        const double cosine =
            normal.x[i] * (x * scale) + normal.y[i] * (y * scale) + normal.z[i] * (z * scale);
        const double amount = diffuse[i] * (cosine < least_cosine ? 0.0 : cosine);
        red[i] += r * (pigment.x[i] * amount);
        green[i] += g * (pigment.y[i] * amount);
        blue[i] += b * (pigment.z[i] * amount);
    }
}

PENUMBRA_VECTORISED
void add_along(const PreparedSource& source, const SurfacePoints& surfaces, const Block& block,
               Vec3Array& radiance) {
    const Vec3View normal(surfaces.normal), pigment(surfaces.pigment);
    const double* diffuse = surfaces.diffuse.data();
    double *red = radiance.axis[0].data(), *green = radiance.axis[1].data(),
           *blue = radiance.axis[2].data();
    const double ax = source.axis.x, ay = source.axis.y, az = source.axis.z;
    const double r = source.color.x, g = source.color.y, b = source.color.z;
    PENUMBRA_INDEPENDENT
    for (std::size_t i = block.first; i < block.last; ++i) {
        const double cosine = normal.x[i] * -ax + normal.y[i] * -ay + normal.z[i] * -az;
        const double amount = diffuse[i] * (cosine < least_cosine ? 0.0 : cosine);
        red[i] += r * (pigment.x[i] * amount);
        green[i] += g * (pigment.y[i] * amount);
        blue[i] += b * (pigment.z[i] * amount);
    }
}

}  // namespace

LightSamples::LightSamples(std::size_t capacity)
    : toward(capacity), distance(capacity), cosine(capacity), share(capacity), reflected(capacity),
      sin_to_facet(capacity), filter(capacity), filtered(capacity) {}

void aim(const PreparedSource& source, const SurfacePoints& surfaces, const Block& block,
         LightSamples& out) {
    if (source.type == Light::Type::directional)
        aim_along(source, surfaces, block, out);
    else
        aim_at_point(source.position, surfaces, block, out);
}

void weigh(const PreparedSource& source, const Block& block, LightSamples& out) {
    const bool spot = source.type == Light::Type::spot;
    const double light = brightest(source);
    if (!source.fades && !spot && light >= least_light) return;
    if (source.fades && source.fade_power == 2)
        fade_by_square(source.fade_distance, block, out);
    else if (source.fades)
        for (std::size_t i = block.first; i < block.last; ++i)
            out.share[i] *=
                2 / (1 + std::pow(out.distance[i] / source.fade_distance, source.fade_power));
    if (spot)
        for (std::size_t i = block.first; i < block.last; ++i)
            if (out.share[i] != 0) out.share[i] *= spot_falloff(source, out.toward[i]);
    drop_faint(light, block, out);
}

void find_sin_to_facet(const SurfacePoints& surfaces, const Block& block, LightSamples& out) {
    dot_products(surfaces.facet_normal, out.toward, block, out.sin_to_facet.data());
    for (std::size_t i = block.first; i < block.last; ++i)
        out.sin_to_facet[i] = std::abs(out.sin_to_facet[i]);
}

void find_reflected(const SurfacePoints& surfaces, const Block& block, LightSamples& out) {
    dot_products(surfaces.reflected, out.toward, block, out.reflected.data());
}

PENUMBRA_VECTORISED
void add_diffuse(const Vec3& color, const Vec3Array& pigments, const std::vector<double>& diffuse,
                 const Block& block, const LightSamples& arrival, Vec3Array& radiance) {
    const Vec3View pigment(pigments);
    const double *scattered = diffuse.data(), *cosine = arrival.cosine.data(),
                 *share = arrival.share.data();
    double *red = radiance.axis[0].data(), *green = radiance.axis[1].data(),
           *blue = radiance.axis[2].data();
    const double r = color.x, g = color.y, b = color.z;
    PENUMBRA_INDEPENDENT
    for (std::size_t i = block.first; i < block.last; ++i) {
        const double amount = scattered[i] * cosine[i] * share[i];
        red[i] += r * (pigment.x[i] * amount);
        green[i] += g * (pigment.y[i] * amount);
        blue[i] += b * (pigment.z[i] * amount);
    }
}

void add_open_matte(const SourceGroup& light, const SurfacePoints& surfaces, const Block& block,
                    Vec3Array& radiance) {
    for (const PreparedSource& source : light.sources)
        if (source.type == Light::Type::directional)
            add_along(source, surfaces, block, radiance);
        else
            add_from(source, surfaces, block, radiance);
}

bool plain(const SourceGroup& light) {
    const PreparedSource& one = light.sources.front();
    return one.type != Light::Type::spot && !one.fades && brightest(one) >= least_light;
}

}  // namespace penumbra
