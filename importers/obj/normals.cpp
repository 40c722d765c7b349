#include "base/memory.h"
#include "base/parallel.h"
#include "importers/obj/mesh.h"
#include "importers/shared/triangulate.h"

#include <algorithm>
#include <cmath>

namespace penumbra::obj {

namespace {

// The angle between the edges at a corner of a polygon with that unit normal, in [0, 2 pi).
double corner_angle(const Vec3& before, const Vec3& at, const Vec3& after, const Vec3& normal) {
    const Vec3 out = after - at, in = before - at;
    const double angle = std::atan2(out.cross(in).dot(normal), out.dot(in));
    return angle < 0 ? angle + radians(360) : angle;
}

// How many faces' angles are in memory at a time.
constexpr std::size_t run_length = std::size_t(1) << 18;

// Gives the corners of one smoothing group after the other the mean normal of its facets.
// Positions are told apart by index, so that both sides of a sheet modelled twice stay apart.
struct Smoother {
    struct Sum {
        Index position = 0;
        Vec3 sum = Vec3(0);
        double weight = 0;
    };
    Model& model;
    std::vector<Index> sum_of = std::vector<Index>(model.positions.size(), no_index);
    std::vector<Sum> sums = {};       // of the current group
    std::vector<Vec3> normals = {};   // of a run of faces; zero: without area
    std::vector<double> angles = {};  // of their corners, one face after the other

    Sum& sum_at(Index position) {
        Index& at = sum_of[position];
        if (at == no_index) {
            at = Index(sums.size());
            make_room(sums, model.file);
            sums.push_back({.position = position});
        }
        return sums[at];
    }

    void measure(std::span<const Index> faces) {
        std::vector<std::size_t> first_angle(faces.size());
        std::size_t count = 0;
        for (std::size_t k = 0; k < faces.size(); ++k) {
            first_angle[k] = count;
            count += model.faces[faces[k]].count;
        }
        normals.resize(faces.size());
        angles.resize(count);
        for_each_block(faces.size(), [&](std::size_t first, std::size_t last) {
            std::vector<Vec3> outline;
            for (std::size_t k = first; k < last; ++k) {
                outline.clear();
                for (const Corner& corner : model.corners_of(model.faces[faces[k]]))
                    outline.push_back(model.positions[corner.position]);
                const Vec3 area = newell_normal(outline);
                normals[k] = area.length() > 0 ? area.normalized() : Vec3(0);
                const std::size_t n = outline.size();
                for (std::size_t i = 0; i < n; ++i)
                    angles[first_angle[k] + i] = corner_angle(outline[(i + n - 1) % n], outline[i],
                                                              outline[(i + 1) % n], normals[k]);
            }
        });
    }

    // Each facet's normal is weighted by its angle at the corner, so that the result does not
    // depend on how a surface is cut into facets (Thuermer and Wuethrich 1998, "Computing Vertex
    // Normals from Polygonal Facets").
    void add(std::span<const Index> faces) {
        measure(faces);
        const double* angle = angles.data();
        for (std::size_t k = 0; k < faces.size(); ++k)
            for (const Corner& corner : model.corners_of(model.faces[faces[k]])) {
                Sum& sum = sum_at(corner.position);
                sum.sum += normals[k] * *angle;
                sum.weight += *angle++;
            }
    }

    // `faces` are all of one group. Where normals cancel the corner stays flat.
    void smooth(std::span<const Index> faces) {
        for (std::size_t first = 0; first < faces.size(); first += run_length)
            add(faces.subspan(first, std::min(run_length, faces.size() - first)));
        std::vector<Index> normal_of(sums.size(), no_index);
        for (const Index i : faces) {
            const Face& face = model.faces[i];
            for (std::size_t k = face.first; k < face.first + face.count; ++k) {
                Corner& corner = model.corners[k];
                if (corner.normal != no_index) continue;
                const Index at = sum_of[corner.position];
                const Sum& sum = sums[at];
                if (!(sum.sum.length() > 1e-9 * sum.weight)) continue;
                if (normal_of[at] == no_index) {
                    normal_of[at] = Index(model.normals.size());
                    make_room(model.normals, model.file);
                    model.normals.push_back(sum.sum.normalized());
                }
                corner.normal = normal_of[at];
            }
        }
        for (const Sum& sum : sums) sum_of[sum.position] = no_index;
        sums.clear();
    }
};

// Faces that belong to a smoothing group, by group; none if the file gives all normals.
std::vector<Index> smoothed_faces(const Model& model) {
    std::vector<Index> result;
    bool wanted = false;
    for (std::size_t i = 0; i < model.faces.size(); ++i) {
        if (model.faces[i].smoothing == 0) continue;
        result.push_back(Index(i));
        for (const Corner& corner : model.corners_of(model.faces[i]))
            wanted = wanted || corner.normal == no_index;
    }
    if (!wanted) return {};
    std::ranges::stable_sort(result, {}, [&](Index i) { return model.faces[i].smoothing; });
    return result;
}

}  // namespace

void resolve_normals(Model& model, Tally& tally) {
    const std::vector<Index> faces = smoothed_faces(model);
    if (!faces.empty()) {
        const MemoryClaim claim(times(model.positions.size(), sizeof(Index)), model.file);
        Smoother smoother = {.model = model};
        const auto group = [&](Index i) { return model.faces[i].smoothing; };
        for (auto begin = faces.begin(); begin != faces.end();) {
            const auto end = std::ranges::upper_bound(begin, faces.end(), group(*begin), {}, group);
            smoother.smooth({begin, end});
            begin = end;
        }
    }
    for (const Face& face : model.faces)
        for (std::size_t i = face.first; i < face.first + face.count; ++i) {
            Index& normal = model.corners[i].normal;
            if (normal == no_index || model.normals[normal] != Vec3(0)) continue;
            tally.add(Loss::approximated, "a normal without direction is replaced by the facet's",
                      face.line);
            normal = no_index;
        }
}

}  // namespace penumbra::obj
