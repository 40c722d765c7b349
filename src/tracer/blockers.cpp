#include "tracer/blockers.h"

#include "tracer/prepared/scene_boxes.h"

#include <algorithm>
#include <optional>

namespace penumbra {

namespace {

// Do segments between points and sources on those sides of the plane, or some of them, cross it?
// Points may lie on it.
bool plane_between(const PreparedPlane& plane, const Extent& points, const Extent& sources) {
    constexpr double on_it = 1e-9;
    const bool above = points.low >= plane.distance - on_it && sources.low > plane.distance;
    const bool below = points.high <= plane.distance + on_it && sources.high < plane.distance;
    return !above && !below;
}

// Whether a box may lie between points and a light.
class Between {
  public:
    Between(const Bounds& points, const SourceGroup& light) {
        if (light.parallel())
            sweep_ = make_sweep(points, -light.sources.front().axis);
        else
            shaft_ = make_shaft(points, light.box);
    }
    bool operator()(const Bounds& box) const {
        return sweep_ ? touches(*sweep_, box) : touches(*shaft_, box);
    }

  private:
    std::optional<Sweep> sweep_;
    std::optional<Shaft> shaft_;
};

// Whether a sphere whose box does may.
bool may_block(const Sphere& sphere, const Bounds& points, const SourceGroup& light) {
    return touches(make_capsule(points, light.box), sphere.center, sphere.radius);
}

}  // namespace

void PointGroups::clear() {
    all = {};
    boxes.clear();
    normals.clear();
    along.clear();
}

void PointGroups::add(const PreparedScene& prepared, const SurfacePoints& surfaces,
                      const IndexRange& range) {
    boxes.push_back(box_around(surfaces.position, range));
    normals.push_back(box_around(surfaces.normal, range));
    all.extend(boxes.back().min);
    all.extend(boxes.back().max);
    const Vec3View p(surfaces.position);
    scratch_.resize(range.last - range.first);
    for (const PreparedPlane& plane : prepared.planes) {
        const Vec3& n = plane.frame.normal;
        for (std::size_t i = range.first; i < range.last; ++i)
            scratch_[i - range.first] = n.x * p.x[i] + n.y * p.y[i] + n.z * p.z[i];
        along.push_back(extent_of(scratch_.data(), {0, scratch_.size()}));
    }
}

// The largest n . l of normals and directions in their boxes is less than 0.
bool PointGroups::face_away(std::size_t group, const SourceGroup& light) const {
    const Bounds &n = normals[group], &points = boxes[group];
    const auto below = [&](const Vec3& least, const Vec3& most) {
        double highest = 0;
        for (int c = 0; c < 3; ++c)
            highest += std::max(
                {n.min[c] * least[c], n.min[c] * most[c], n.max[c] * least[c], n.max[c] * most[c]});
        return highest < 0;
    };
    const PreparedSource& first = light.sources.front();
    if (light.parallel()) return below(-first.axis, -first.axis);
    return first.type != Light::Type::directional &&
           below(light.box.min - points.max, light.box.max - points.min);
}

void Blockers::find_group(const PreparedScene& prepared, const PointGroups& points,
                          const SourceGroup& light, bool facets) {
    const std::size_t index = groups.size();
    BlockedBy& group = groups.emplace_back();
    group.first_shape = group.last_shape = shapes.size();
    group.away = points.face_away(index, light);
    if (group.away) return;
    const auto add = [&](Index object) {
        group.any = true;
        if (prepared.material_of(object).opaque)
            shapes.push_back(object);
        else
            group.filters = true;
    };
    for (std::size_t k = 0; k < prepared.planes.size(); ++k)
        if (prepared.scene.planes[k].casts_shadow &&
            plane_between(prepared.planes[k], points.along[index * prepared.planes.size() + k],
                          light.along[k]))
            add(prepared.first_plane() + Index(k));
    if (facets || !spheres_.empty()) {
        const Between between(points.boxes[index], light);
        for (const Index object : spheres_) {
            const Sphere& sphere = prepared.sphere(object);
            if (between(box_of(sphere)) && may_block(sphere, points.boxes[index], light))
                add(object);
        }
        group.facets =
            facets && visit_boxes(*prepared.facet_boxes, between, [](Index) { return true; });
        group.filters |= group.facets && visit_boxes(prepared.translucent_boxes, between,
                                                     [](Index) { return true; });
    }
    group.last_shape = shapes.size();
    group.any |= group.facets;
}

void Blockers::find(const PreparedScene& prepared, const PointGroups& points,
                    const SourceGroup& light) {
    groups.clear();
    shapes.clear();
    spheres_.clear();
    const Between between(points.all, light);
    visit_boxes(prepared.sphere_boxes, between, [&](Index sphere) {
        spheres_.push_back(sphere);
        return false;
    });
    const bool facets = visit_boxes(*prepared.facet_boxes, between, [](Index) { return true; });
    for (std::size_t i = 0; i < points.boxes.size(); ++i)
        find_group(prepared, points, light, facets);
}

}  // namespace penumbra
