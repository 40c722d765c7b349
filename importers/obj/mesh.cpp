#include "importers/obj/mesh.h"

#include "base/memory.h"
#include "base/parallel.h"
#include "importers/obj/colors.h"
#include "importers/shared/triangulate.h"
#include "scene/texture/image_maps.h"
#include "scene/transforms.h"

#include <algorithm>
#include <array>
#include <utility>

namespace penumbra::obj {

namespace {

using Triangle = std::array<Index, 3>;

// Of what is used.
Vec3 origin_of(const Model& model) {
    Bounds box;
    for (const Corner& corner : model.corners) box.extend(model.positions[corner.position]);
    return local_origin(box);
}

// The faces of each part, in the order of the file.
std::vector<std::vector<Index>> faces_by_part(const Model& model) {
    std::vector<std::vector<Index>> result(model.parts.size());
    for (std::size_t i = 0; i < model.faces.size(); ++i)
        result[model.faces[i].part].push_back(Index(i));
    return result;
}

bool has_images(const Material& material) {
    bool found = false;
    each_image_map(material, [&](const ImageMap&, MapUse) { found = true; });
    return found;
}

// One value for a vertex where edges cross: the common one of all corners that it comes from, or
// none, or what `blend` makes of them.
template <class Blend>
Index merged(std::span<const Corner> from, Index Corner::* member, Blend blend) {
    const Index first = from[0].*member;
    bool same = true;
    for (const Corner& corner : from) {
        if (corner.*member == no_index) return no_index;
        same = same && corner.*member == first;
    }
    return same ? first : blend();
}

// How many faces are cut into triangles at a time.
constexpr std::size_t run_length = std::size_t(1) << 17;

// Makes one mesh after the other. A vertex is what has one position, texture coordinate and
// normal; those of one position are chained.
struct Builder {
    struct Vertex {
        Index texcoord = no_index, normal = no_index;
        Index next = no_index;
    };

    Model model;
    Tally& tally;
    Vec3 origin = origin_of(model);
    std::vector<Index> first = std::vector<Index>(model.positions.size(), no_index);
    std::vector<Vertex> vertices = {};
    std::vector<Index> touched = {};  // positions in `first`
    std::vector<Corner> corners = {};
    std::vector<Triangulation> cuts = {};  // of a run of faces; empty for triangles
    Mesh mesh = {};
    bool smooth = false, textured = false, colored = false;

    Vec2f texcoord(Index index) const {
        if (index == no_index) return Vec2f(0);
        return Vec2f(model.texcoords[index]);
    }

    // All arrays of vertices grow alike.
    void claim_growth() const {
        constexpr std::size_t each =
            sizeof(Vertex) + sizeof(Index) + 2 * sizeof(Vec3f) + sizeof(Vec2f) + sizeof(Color);
        const MemoryClaim claim(times(2 * mesh.positions.size() + 1, each), model.file);
    }

    Index vertex(const Corner& corner) {
        Index& chain = first[corner.position];
        for (Index at = chain; at != no_index; at = vertices[at].next)
            if (vertices[at].texcoord == corner.texcoord && vertices[at].normal == corner.normal)
                return at;
        if (mesh.positions.size() == mesh.positions.capacity()) claim_growth();
        if (chain == no_index) touched.push_back(corner.position);
        vertices.push_back({corner.texcoord, corner.normal, chain});
        mesh.positions.emplace_back(model.positions[corner.position] - origin);
        if (textured) mesh.texcoords.push_back(texcoord(corner.texcoord));
        if (smooth) mesh.normals.emplace_back(model.normals[corner.normal]);
        if (colored) mesh.colors.push_back(model.colors[corner.position]);
        return chain = Index(vertices.size() - 1);
    }

    // The facet's own normal, on the side of those that its other corners have.
    Index facet_normal(const std::array<Corner, 3>& facet) {
        const Vec3 a = model.positions[facet[0].position];
        const Vec3 cross =
            (model.positions[facet[1].position] - a).cross(model.positions[facet[2].position] - a);
        Vec3 normal = cross.length() > 0 ? cross.normalized() : Vec3(0, 1, 0);
        Vec3 given(0);
        for (const Corner& corner : facet)
            if (corner.normal != no_index) given += model.normals[corner.normal];
        if (given.dot(normal) < 0) normal = -normal;
        model.normals.push_back(normal);
        return Index(model.normals.size() - 1);
    }

    void triangle(std::array<Corner, 3> facet) {
        Index own = no_index;
        for (Corner& corner : facet) {
            if (!smooth || corner.normal != no_index) continue;
            if (own == no_index) own = facet_normal(facet);
            corner.normal = own;
        }
        mesh.triangles.push_back({vertex(facet[0]), vertex(facet[1]), vertex(facet[2])});
    }

    // The corner where edges of a polygon cross, from the corners at their ends.
    Corner add_corner(const AddedCorner& added) {
        std::vector<Corner> from;
        std::vector<double> weight;
        for (std::size_t i = 0; i < added.from.size(); ++i) {
            if (added.weight[i] == 0) continue;
            from.push_back(corners[added.from[i]]);
            weight.push_back(added.weight[i]);
        }
        const auto blend = [&](const auto& values, Index Corner::* member) {
            auto sum = values[0] * 0;
            for (std::size_t i = 0; i < from.size(); ++i)
                sum += values[from[i].*member] * typename decltype(sum)::BaseType(weight[i]);
            return sum;
        };
        Corner corner;
        corner.position = merged(from, &Corner::position, [&] {
            if (!model.colors.empty())
                model.colors.push_back(blend(model.colors, &Corner::position));
            model.positions.push_back(added.position);
            first.push_back(no_index);
            return Index(model.positions.size() - 1);
        });
        corner.texcoord = merged(from, &Corner::texcoord, [&] {
            model.texcoords.push_back(blend(model.texcoords, &Corner::texcoord));
            return Index(model.texcoords.size() - 1);
        });
        corner.normal = merged(from, &Corner::normal, [&] {
            const Vec3 sum = blend(model.normals, &Corner::normal);
            if (!(sum.length() > 1e-9)) return no_index;
            model.normals.push_back(sum.normalized());
            return Index(model.normals.size() - 1);
        });
        return corner;
    }

    void polygon(const Face& face, const Triangulation& result) {
        if (result.tangled)
            tally.add(Loss::approximated,
                      "a polygon crosses itself too often; it is cut as if it were convex",
                      face.line);
        else if (result.crossing)
            tally.add(Loss::approximated,
                      "a polygon crosses itself; what its outline encloses is filled", face.line);
        else if (result.bent)
            tally.add(Loss::approximated,
                      "a polygon is not flat; it is folded along diagonals of our choice",
                      face.line);
        for (const AddedCorner& added : result.added) corners.push_back(add_corner(added));
        for (const Triangle& t : result.triangles)
            triangle({corners[t[0]], corners[t[1]], corners[t[2]]});
    }

    bool has_color(const Corner& corner) const {
        return !model.colors.empty() && obj::has_color(model.colors[corner.position]);
    }

    // Colours are of all vertices of a mesh or of none.
    void begin_colors(std::span<const Index> faces) {
        colored = false;
        Index bare = 0;  // line of the first face that lacks a colour
        for (const Index i : faces)
            for (const Corner& corner : model.corners_of(model.faces[i])) {
                const bool has = has_color(corner);
                colored = colored || has;
                if (bare == 0 && !has) bare = model.faces[i].line;
            }
        if (colored && bare != 0)
            tally.add(Loss::dropped,
                      "vertex colours of an object are ignored: some of its vertices have none",
                      bare);
        colored = colored && bare == 0;
    }

    void begin(const Part& part, std::span<const Index> faces, bool mapped) {
        mesh = {.name = part.name, .material = part.material};
        smooth = textured = false;
        std::size_t facets = 0;
        Index bare = 0;  // line of the first face that lacks a texture coordinate
        for (const Index i : faces) {
            const Face& face = model.faces[i];
            facets += face.count - 2;
            for (const Corner& corner : model.corners_of(face)) {
                smooth = smooth || corner.normal != no_index;
                textured = textured || corner.texcoord != no_index;
                if (bare == 0 && corner.texcoord == no_index) bare = face.line;
            }
        }
        if (!model.colors.empty()) begin_colors(faces);
        const MemoryClaim claim(times(facets, sizeof(Triangle)), model.file);
        mesh.triangles.reserve(facets);
        if (mapped && bare)
            tally.add(Loss::approximated,
                      "facets of a textured material without texture coordinates take those of "
                      "the image's lower left corner",
                      bare);
        for (const Index position : touched) first[position] = no_index;
        touched.clear();
        vertices.clear();
    }

    void cut(std::span<const Index> faces) {
        cuts.resize(faces.size());
        for_each_block(faces.size(), [&](std::size_t from, std::size_t to) {
            std::vector<Vec3> outline;
            for (std::size_t k = from; k < to; ++k) {
                const Face& face = model.faces[faces[k]];
                if (face.count == 3) continue;
                outline.clear();
                for (const Corner& corner : model.corners_of(face))
                    outline.push_back(model.positions[corner.position]);
                cuts[k] = triangulate(outline);
            }
        });
    }

    void add(std::span<const Index> faces) {
        cut(faces);
        for (std::size_t k = 0; k < faces.size(); ++k) {
            const Face face = model.faces[faces[k]];
            const auto given = model.corners_of(face);
            corners.assign(given.begin(), given.end());
            if (face.count == 3)
                triangle({corners[0], corners[1], corners[2]});
            else
                polygon(face, cuts[k]);
        }
    }

    Mesh build(const Part& part, std::span<const Index> faces, bool mapped) {
        begin(part, faces, mapped);
        for (std::size_t from = 0; from < faces.size(); from += run_length)
            add(faces.subspan(from, std::min(run_length, faces.size() - from)));
        return std::move(mesh);
    }
};

}  // namespace

void build_meshes(Model model, Scene& scene, Tally& tally) {
    const auto faces = faces_by_part(model);
    Builder builder = {.model = std::move(model), .tally = tally};
    const Matrix place = Matrix().setTranslation(builder.origin);
    const std::vector<Part> parts = builder.model.parts;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        const Index material = parts[i].material;
        scene.instances.push_back(
            {.name = parts[i].name, .mesh = Index(scene.meshes.size()), .transform = place});
        const bool mapped = material != no_index && has_images(scene.materials[material]);
        scene.meshes.push_back(builder.build(parts[i], faces[i], mapped));
    }
}

}  // namespace penumbra::obj
