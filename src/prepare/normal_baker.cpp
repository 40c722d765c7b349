#include "prepare/normal_baker.h"

#include <tbb/parallel_for.h>

#include <cmath>

namespace penumbra {

namespace {

/// Steps towards the least squares; two come within some per cent of it.
constexpr int fitting_steps = 2;

/// Vertices of different charts at one point have one normal if theirs differ less (squared).
constexpr double same_normal = 0.05 * 0.05;

const std::array<Index, 3>& corners_of(const NormalBaker& baker, Index facet) {
    return baker.mesh.mesh().triangles[facet];
}

double area_of(const NormalBaker& baker, Index facet) {
    const auto& [a, b, c] = corners_of(baker, facet);
    const std::vector<Vec3f>& positions = baker.mesh.mesh().positions;
    const Vec3 first(positions[a]);
    const Vec3 cross = (Vec3(positions[b]) - first).cross(Vec3(positions[c]) - first);
    return cross.length() / 2 * baker.magnification;
}

// A facet is looked at in the centres of n x n equal parts, about one for four texels.
int parts_of(const NormalBaker& baker, Index facet) {
    // As a number first: texture coordinates may be huge.
    return int(std::max(2.0, std::min(4.0, std::ceil(std::sqrt(texels_on(baker, facet) / 4)))));
}

// Calls visit(weights of the corners) at the centre of each part.
template <class Visit>
void for_each_part(int n, const Visit& visit) {
    const auto at = [&](double i, double j) { visit(Vec3(n - i - j, i, j) * (1.0 / n)); };
    for (int j = 0; j < n; ++j)
        for (int i = 0; i + j < n; ++i) {
            at(i + 1.0 / 3, j + 1.0 / 3);
            if (i + j + 1 < n) at(i + 2.0 / 3, j + 2.0 / 3);
        }
}

Vec3 true_normal(const NormalBaker& baker, Index facet, const Vec3& weights) {
    return perturbed_normal(baker.map, baker.lookup, baker.mesh.mesh(), facet, weights);
}

// Not unit.
Vec3 interpolated(const NormalBaker& baker, Index facet, const Vec3& weights) {
    const auto& [a, b, c] = corners_of(baker, facet);
    return Vec3(baker.normals[a]) * weights.x + Vec3(baker.normals[b]) * weights.y +
           Vec3(baker.normals[c]) * weights.z;
}

// Every look at the map, made once.
struct Samples {
    std::vector<int> parts = {};          // per facet: parts_of()
    std::vector<std::size_t> first = {};  // per facet, and the end
    std::vector<Vec3f> normals = {};
    std::size_t facets() const { return parts.size(); }
};

Samples take_samples(const NormalBaker& baker) {
    const std::size_t facets = baker.mesh.mesh().triangles.size();
    Samples samples;
    samples.parts.resize(facets);
    samples.first.resize(facets + 1, 0);
    for (std::size_t f = 0; f < facets; ++f) {
        const int n = samples.parts[f] = parts_of(baker, Index(f));
        samples.first[f + 1] = samples.first[f] + std::size_t(n * n);
    }
    samples.normals.resize(samples.first.back());
    tbb::parallel_for(std::size_t(0), facets, [&](std::size_t f) {
        std::size_t next = samples.first[f];
        for_each_part(samples.parts[f], [&](const Vec3& weights) {
            samples.normals[next++] = Vec3f(true_normal(baker, Index(f), weights));
        });
    });
    return samples;
}

// For each vertex the first at its place with about the same normal.
std::vector<Index> joined_vertices(const NormalBaker& baker) {
    std::vector<Index> joined(baker.normals.size());
    std::vector<Index> first(baker.mesh.places(), no_index);
    for (Index i = 0; i < joined.size(); ++i) {
        Index& other = first[baker.mesh.place(i)];
        if (other == no_index) other = i;
        const Vec3 difference = Vec3(baker.normals[i]) - Vec3(baker.normals[other]);
        joined[i] = difference.length2() < same_normal ? other : i;
    }
    return joined;
}

// One step of a Richardson iteration on the normal equations: every vertex moves by the mean error
// around it, each weighted as the vertex's normal is there.
void improve(NormalBaker& baker, const Samples& samples, const std::vector<Index>& joined) {
    struct Sum {
        Vec3 error = Vec3(0);
        double weight = 0;
    };
    std::vector<Sum> sums(baker.normals.size());
    for (std::size_t f = 0; f < samples.facets(); ++f) {
        const auto& corners = corners_of(baker, Index(f));
        const int n = samples.parts[f];
        const double area = area_of(baker, Index(f)) / (n * n);
        std::size_t next = samples.first[f];
        for_each_part(n, [&](const Vec3& weights) {
            const Vec3 error =
                Vec3(samples.normals[next++]) - interpolated(baker, Index(f), weights);
            for (int k = 0; k < 3; ++k) {
                Sum& sum = sums[joined[corners[unsigned(k)]]];
                sum.error += error * (area * weights[k]);
                sum.weight += area * weights[k];
            }
        });
    }
    for (std::size_t i = 0; i < sums.size(); ++i)
        if (sums[i].weight > 0) baker.normals[i] += Vec3f(sums[i].error * (1 / sums[i].weight));
    for (std::size_t i = 0; i < joined.size(); ++i) baker.normals[i] = baker.normals[joined[i]];
}

// Mean angle.
double remaining_error(const NormalBaker& baker, const Samples& samples, Index facet) {
    const int n = samples.parts[facet];
    std::size_t next = samples.first[facet];
    double sum = 0;
    for_each_part(n, [&](const Vec3& weights) {
        const Vec3 mixed = interpolated(baker, facet, weights).normalized();
        const double chord = (mixed - Vec3(samples.normals[next++])).length();
        sum += 2 * std::asin(std::min(1.0, chord / 2));
    });
    return sum / (n * n);
}

MeshError remaining_error(const NormalBaker& baker, const Samples& samples) {
    std::vector<double> angles(samples.facets());
    tbb::parallel_for(std::size_t(0), angles.size(), [&](std::size_t f) {
        angles[f] = remaining_error(baker, samples, Index(f));
    });
    MeshError total;
    for (std::size_t f = 0; f < angles.size(); ++f) {
        const double area = area_of(baker, Index(f));
        total.angle += angles[f] * area;
        total.area += area;
    }
    if (total.area > 0) total.angle /= total.area;
    return total;
}

}  // namespace

void add_normals(NormalBaker& baker) {
    const Mesh& mesh = baker.mesh.mesh();
    const std::size_t known = baker.normals.size();
    baker.normals.resize(mesh.positions.size());
    tbb::parallel_for(known, mesh.positions.size(), [&](std::size_t i) {
        const TangentFrame frame = {.normal = Vec3(mesh.normals[i]),
                                    .tangent = Vec3(mesh.tangents[i].direction),
                                    .handedness = mesh.tangents[i].handedness};
        const Vec2 texcoord(mesh.texcoords[i]);
        baker.normals[i] = Vec3f(perturbed_normal(baker.map, baker.lookup, frame, texcoord));
    });
}

FacetError error_of(const NormalBaker& baker, Index facet) {
    const int n = parts_of(baker, facet);
    double sum = 0;
    for_each_part(n, [&](const Vec3& weights) {
        const Vec3 mixed = interpolated(baker, facet, weights).normalized();
        sum += (mixed - true_normal(baker, facet, weights)).length2();
    });
    return {sum / (n * n), area_of(baker, facet)};
}

double texels_on(const NormalBaker& baker, Index facet) {
    const auto& [a, b, c] = corners_of(baker, facet);
    const std::vector<Vec2f>& texcoords = baker.mesh.mesh().texcoords;
    const Vec2 first(texcoords[a]);
    const Vec2 p = Vec2(texcoords[b]) - first, q = Vec2(texcoords[c]) - first;
    const auto& t = baker.map.map.transform;
    const Raster& raster = baker.lookup.texture->raster;
    return std::abs((p.x * q.y - p.y * q.x) * (t[0] * t[4] - t[1] * t[3])) / 2 * raster.width *
           raster.height;
}

MeshError fit_normals(NormalBaker& baker) {
    const Samples samples = take_samples(baker);
    const std::vector<Index> joined = joined_vertices(baker);
    const std::vector<Vec3f> given = baker.normals;
    for (int step = 0; step < fitting_steps; ++step) improve(baker, samples, joined);
    for (std::size_t i = 0; i < given.size(); ++i) {
        const bool usable = baker.normals[i].length() > 0.01F;
        baker.normals[i] = usable ? baker.normals[i].normalized() : given[i];
    }
    return remaining_error(baker, samples);
}

}  // namespace penumbra
