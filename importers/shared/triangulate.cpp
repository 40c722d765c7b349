#include "importers/shared/triangulate.h"

#include "importers/shared/triangulate_sweep.h"

#include <GL/glu.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <memory>
#include <random>

namespace penumbra {

namespace {

using Triangle = std::array<Index, 3>;

// Largest squared distance from the first corner: the polygon's scale.
double extent2(std::span<const Vec3> corners) {
    double result = 0;
    for (const Vec3& corner : corners) result = std::max(result, (corner - corners[0]).length2());
    return result;
}

// The unit normal, also of a polygon whose signed area is zero, such as a bow-tie; zero when all
// corners lie on a line.
Vec3 plane_normal(std::span<const Vec3> corners, const Vec3& newell, double scale2) {
    constexpr double flat = 1e-12;  // of the squared extent: below it the sum is rounding
    if (newell.length() > flat * scale2) return newell.normalized();
    Vec3 far(0);
    for (const Vec3& corner : corners)
        if ((corner - corners[0]).length2() > far.length2()) far = corner - corners[0];
    Vec3 normal(0);
    for (const Vec3& corner : corners) {
        const Vec3 candidate = far.cross(corner - corners[0]);
        if (candidate.length2() > normal.length2()) normal = candidate;
    }
    return normal.length() > flat * scale2 ? normal.normalized() : Vec3(0);
}

// A fan around corner `first` covers the polygon once when every triangle has the polygon's
// orientation and all corners lie on one side of the first edge, so that the fan cannot wind twice.
// A corner on a straight line at `first` is fine; elsewhere it would give a triangle without area.
bool fan_is_right(std::span<const Vec3> corners, std::size_t first, const Vec3& normal) {
    const std::size_t n = corners.size();
    const auto spoke = [&](std::size_t i) { return corners[(first + i) % n] - corners[first]; };
    const Vec3 edge = spoke(1);
    for (std::size_t i = 1; i + 1 < n; ++i) {
        const Vec3 next = spoke(i + 1);
        if (!(spoke(i).cross(next).dot(normal) > 0)) return false;
        const double side = edge.cross(next).dot(normal);
        if (!(i + 2 < n ? side > 0 : side >= 0)) return false;
    }
    return true;
}

void add_fan(Triangulation& result, std::size_t n, std::size_t first) {
    for (std::size_t i = 1; i + 1 < n; ++i)
        result.triangles.push_back(
            {Index(first), Index((first + i) % n), Index((first + i + 1) % n)});
}

// Two axes of the plane with u x v = normal. Exact when the normal is an axis, so that corners on
// a line stay on it.
std::array<Vec3, 2> plane_axes(const Vec3& normal) {
    const Vec3 size = {std::abs(normal.x), std::abs(normal.y), std::abs(normal.z)};
    const int major = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    Vec3 u(0);
    u[(major + 1) % 3] = 1;
    u = (u - normal * normal[(major + 1) % 3]).normalized();
    return {u, normal.cross(u)};
}

// GLU's tessellator takes time proportional to the corners times the edges at one height. From here
// on simple polygons are better cut by a sweep.
constexpr std::size_t many_corners = 500;

// The plane's axes become x and y, the first corner the origin.
std::vector<Vec2> flattened(std::span<const Vec3> corners, const Vec3& normal) {
    const auto [u, v] = plane_axes(normal);
    std::vector<Vec2> flat;
    flat.reserve(corners.size());
    for (const Vec3& corner : corners)
        flat.emplace_back((corner - corners[0]).dot(u), (corner - corners[0]).dot(v));
    return flat;
}

// Whether edges cross so often, by a sample of pairs, that tessellation would not end.
bool is_tangled(std::span<const Vec2> flat) {
    constexpr int pairs = 4096;
    constexpr double most = 50000;
    std::minstd_rand random;
    const std::size_t n = flat.size();
    const auto split = [&](std::size_t edge, std::size_t other) {
        const Vec2& a = flat[edge];
        const Vec2 along = flat[(edge + 1) % n] - a;
        return along.cross(flat[other] - a) * along.cross(flat[(other + 1) % n] - a) < 0;
    };
    int crossings = 0;
    for (int i = 0; i < pairs; ++i) {
        const std::size_t first = random() % n, second = random() % n;
        if (split(first, second) && split(second, first)) ++crossings;
    }
    return double(crossings) / pairs * double(n) * double(n) / 2 > most;
}

// What GLU's tessellator works on, and the receiver of its callbacks. Vertices go to and fro as
// pointers to their index.
struct Tessellation {
    Triangulation* result = nullptr;
    std::span<const Vec3> corners = {};
    Vec3 u = Vec3(0), v = Vec3(0), normal = Vec3(0);
    Triangle triangle = {};
    int known = 0;                   // corners of `triangle`
    std::deque<Index> indices = {};  // a deque does not move them
    bool failed = false;

    Index* next_index() { return &indices.emplace_back(Index(indices.size())); }

    Vec3 position(std::size_t i) const {
        return i < corners.size() ? corners[i] : result->added[i - corners.size()].position;
    }
};

void GLAPIENTRY on_vertex(void* vertex, void* data) {
    Tessellation& work = *static_cast<Tessellation*>(data);
    work.triangle[std::size_t(work.known++)] = *static_cast<const Index*>(vertex);
    if (work.known < 3) return;
    work.result->triangles.push_back(work.triangle);
    work.known = 0;
}

// With an edge flag callback GLU makes single triangles, neither fans nor strips.
void GLAPIENTRY on_edge_flag(GLboolean, void*) {}

void GLAPIENTRY on_error(GLenum, void* data) { static_cast<Tessellation*>(data)->failed = true; }

// GLU's weights are float32, so the place in the plane comes from its coordinates and only the
// height above the plane from the weights.
void GLAPIENTRY on_combine(const GLdouble* at, void* const* from, const GLfloat* weight, void** out,
                           void* data) {
    Tessellation& work = *static_cast<Tessellation*>(data);
    const Vec3 origin = work.corners[0];
    AddedCorner added;
    double sum = 0, height = 0;
    for (std::size_t i = 0; i < 4; ++i)
        if (from[i]) sum += double(weight[i]);
    for (std::size_t i = 0; i < 4; ++i) {
        if (!from[i]) continue;
        added.from[i] = *static_cast<const Index*>(from[i]);
        added.weight[i] = double(weight[i]) / sum;
        height += added.weight[i] * (work.position(added.from[i]) - origin).dot(work.normal);
    }
    added.position = origin + work.u * at[0] + work.v * at[1] + work.normal * height;
    *out = work.next_index();
    work.result->added.push_back(added);
}

template <class Function>
void set(GLUtesselator* tess, GLenum which, Function* function) {
    gluTessCallback(tess, which, reinterpret_cast<_GLUfuncptr>(function));
}

// A fan where GLU fails.
void tessellate(Triangulation& result, std::span<const Vec3> corners, const Vec3& normal) {
    const std::unique_ptr<GLUtesselator, void (*)(GLUtesselator*)> owner(gluNewTess(),
                                                                         gluDeleteTess);
    GLUtesselator* const tess = owner.get();
    if (!tess) return add_fan(result, corners.size(), 0);
    set(tess, GLU_TESS_VERTEX_DATA, on_vertex);
    set(tess, GLU_TESS_EDGE_FLAG_DATA, on_edge_flag);
    set(tess, GLU_TESS_COMBINE_DATA, on_combine);
    set(tess, GLU_TESS_ERROR_DATA, on_error);
    gluTessProperty(tess, GLU_TESS_WINDING_RULE, GLU_TESS_WINDING_NONZERO);
    gluTessNormal(tess, 0, 0, 1);

    const auto [u, v] = plane_axes(normal);
    Tessellation work = {.result = &result, .corners = corners, .u = u, .v = v, .normal = normal};
    gluTessBeginPolygon(tess, &work);
    gluTessBeginContour(tess);
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const Vec3 offset = corners[i] - corners[0];
        std::array<GLdouble, 3> at = {offset.dot(u), offset.dot(v), 0};
        gluTessVertex(tess, at.data(), work.next_index());
    }
    gluTessEndContour(tess);
    gluTessEndPolygon(tess);
    if (!work.failed && !result.triangles.empty()) return;
    result.triangles.clear();
    result.added.clear();
    add_fan(result, corners.size(), 0);
}

void cut_large(Triangulation& result, std::span<const Vec3> corners, const Vec3& normal) {
    const std::vector<Vec2> flat = flattened(corners, normal);
    if (auto triangles = triangulate_simple(flat)) {
        result.triangles = std::move(*triangles);
    } else if (is_tangled(flat)) {
        result.tangled = true;
        add_fan(result, corners.size(), 0);
    } else {
        tessellate(result, corners, normal);
    }
}

// Compares the triangles' area with the outline's. The tolerances are far above rounding and, for
// bent polygons, where another choice of diagonals would be visible.
void measure(Triangulation& result, std::span<const Vec3> corners, const Vec3& normal,
             double scale2) {
    const auto position = [&](std::size_t i) -> const Vec3& {
        return i < corners.size() ? corners[i] : result.added[i - corners.size()].position;
    };
    double flat = 0;
    for (const Triangle& t : result.triangles) {
        const Vec3& a = position(t[0]);
        const Vec3 cross = (position(t[1]) - a).cross(position(t[2]) - a);
        result.area += 0.5 * cross.length();
        flat += 0.5 * cross.dot(normal);
    }
    const double rounding = 1e-10 * scale2;
    result.crossing = std::abs(flat - result.outline) > 1e-6 * result.outline + rounding;
    result.bent = result.area - flat > 0.05 * flat + rounding;
}

}  // namespace

Vec3 newell_normal(std::span<const Vec3> corners) {
    Vec3 sum(0);
    for (std::size_t i = 1; i + 1 < corners.size(); ++i)
        sum += (corners[i] - corners[0]).cross(corners[i + 1] - corners[0]);
    return sum;
}

Triangulation triangulate(std::span<const Vec3> corners) {
    const std::size_t n = corners.size();
    const Vec3 newell = newell_normal(corners);
    const double scale2 = extent2(corners);
    const Vec3 normal = plane_normal(corners, newell, scale2);
    Triangulation result = {.outline = 0.5 * newell.length()};
    result.triangles.reserve(n - 2);

    if (n == 3 || normal == Vec3(0) || fan_is_right(corners, 0, normal))
        add_fan(result, n, 0);
    else if (n == 4 && fan_is_right(corners, 1, normal))
        add_fan(result, n, 1);
    else if (n < many_corners)
        tessellate(result, corners, normal);
    else
        cut_large(result, corners, normal);
    if (n > 3)
        measure(result, corners, normal, scale2);
    else
        result.area = result.outline;
    return result;
}

}  // namespace penumbra
