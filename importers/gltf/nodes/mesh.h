// A glTF primitive on its way to becoming a Mesh.
#pragma once

#include "importers/gltf/document/accessor.h"
#include "importers/gltf/reader/reader.h"

#include <array>
#include <initializer_list>
#include <optional>
#include <string>
#include <vector>

namespace penumbra::gltf {

/// A primitive, where it stands, and how its mesh is to be shown.
struct Part {
    Reader& reader;
    const tinygltf::Primitive& primitive;
    const MeshKey& key;
    std::string pointer;  ///< "/meshes/0/primitives/1"

    const tinygltf::Model& model() const { return reader.document.model; }
    const tinygltf::Accessor& accessor(int index) const {
        return model().accessors[std::size_t(index)];
    }
    [[noreturn]] void fail(const std::string& below, const std::string& problem) const {
        throw Error(Failure::input, reader.document.place(pointer + below), problem);
    }
    std::string place() const { return reader.document.place(pointer); }
    void note_loss(Loss::Kind kind, const std::string& what) const {
        reader.note_loss_in_primitive(kind, pointer, what);
    }
};

/// The accessor types that an attribute may have.
using Types = std::initializer_list<int>;

// ---- nodes/attributes.cpp ---------------------------------------------------------------------

/// The accessor of an attribute, -1 if the primitive has none. Its type, the type of its numbers
/// and its count are checked. Throws Error (input).
int attribute(const Part& part, const std::string& name, Types types);

/// The vertices of an attribute that attribute() has found, `width` numbers each, morphed as far as
/// the key's weights say. Throws Error (input).
void read_vertices(const Part& part, const std::string& name, const Elements& range, int width,
                   float* out);

/// The texture coordinates of an attribute that attribute() has found, with v running up; a loss
/// names those that are not finite. Throws Error (input).
std::vector<Vec2f> read_texcoord_set(const Part& part, const std::string& name,
                                     const Elements& range);

/// Adds what the primitive's vertices have to a mesh that has its triangles: positions, normals,
/// tangents, texture coordinates and colours, in the mesh's own space. Returns from which point in
/// it the positions are counted. Throws Error (input).
Vec3 read_attributes(const Part& part, const Elements& range, Mesh& mesh);

/// The material, with an alpha map for the alpha of vertices.
Index fading(Reader& reader, Index material);

// ---- nodes/texcoord_sets.cpp ------------------------------------------------------------------

/// The meshes that `mesh` becomes where its material has OtherSets: one for every way in which
/// these follow from its texture coordinates, each with a material of its own, so that one set of
/// texture coordinates is enough. Where there are too many of them those images are given up, and
/// that is said. Throws Error (input).
std::vector<Mesh> lay_by_one_set(const Part& part, const Elements& range, Mesh mesh);

// ---- nodes/variants.cpp -----------------------------------------------------------------------

/// The glTF material of a primitive, which the chosen variant may replace; -1 is glTF's default.
/// Throws Error (usage) where the file does not have that variant.
int material_of(const Reader& reader, const tinygltf::Primitive& primitive);

// ---- nodes/mesh.cpp ---------------------------------------------------------------------------

/// The Scene's meshes for a glTF mesh shown in that way, made on first use.
const std::vector<ShownMesh>& read_mesh(Reader& reader, const MeshKey& key);

/// The triangles of a primitive by numbers of vertices, which may be out of range; none where it
/// has no surface. Throws Error (input).
std::vector<std::array<Index, 3>> read_facets(const Part& part);

/// Gives the mesh these positions, in float32 about a point that is returned.
Vec3 set_positions(const std::vector<Vec3>& positions, Mesh& mesh);

// ---- nodes/laid_facets.cpp --------------------------------------------------------------------

/// Sets MaterialCache::facets.
void offer_facets(Reader& reader);

// ---- nodes/skin.cpp ---------------------------------------------------------------------------

/// Moves the mesh's vertices to where its skin's joints take them, and says from which point in the
/// world they are counted; none when the primitive is not bound to the skin. Throws Error (input).
std::optional<Vec3> pose_vertices(const Part& part, const Elements& range,
                                  const std::vector<Matrix>& joints, Mesh& mesh);

}  // namespace penumbra::gltf
