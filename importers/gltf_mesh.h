// A glTF primitive on its way to becoming a Mesh.
#pragma once

#include "gltf.h"

#include <array>
#include <initializer_list>
#include <string>
#include <vector>

namespace penumbra::gltf {

/// A primitive, where it stands, and the form that it is wanted in.
struct Part {
    Reader& reader;
    const tinygltf::Primitive& primitive;
    const Form& form;
    std::string pointer;  ///< "/meshes/0/primitives/1"

    const tinygltf::Model& model() const { return reader.document.model; }
    const tinygltf::Accessor& accessor(int index) const {
        return model().accessors[std::size_t(index)];
    }
    [[noreturn]] void fail(const std::string& below, const std::string& problem) const {
        throw Error(Failure::input, reader.document.place(pointer + below), problem);
    }
    std::string place() const { return reader.document.place(pointer); }
    void lose(const std::string& what) const { reader.lose_in_primitive(pointer, what); }
};

/// The accessor types that an attribute may have.
using Types = std::initializer_list<int>;

// ---- gltf_attribute.cpp -----------------------------------------------------------------------

/// The accessor of an attribute, -1 if the primitive has none. Its type, the type of its numbers
/// and its count are checked. Throws Error (input).
int attribute(const Part& part, const std::string& name, Types types);

/// The vertices of an attribute that attribute() has found, `width` numbers each, morphed as far as
/// the form's weights say. Throws Error (input).
void read_vertices(const Part& part, const std::string& name, const Range& range, int width,
                   float* out);

/// Adds what the primitive's vertices have to a mesh that has its triangles: positions, normals,
/// tangents, texture coordinates and colours, in the mesh's own space. Throws Error (input).
void read_attributes(const Part& part, const Range& range, Mesh& mesh);

/// The material, with a coverage for the alpha of vertices.
Index fading(Reader& reader, Index material);

// ---- gltf_texcoord.cpp ------------------------------------------------------------------------

/// The meshes that `mesh` becomes where its material has OtherSets: one for every way in which
/// these follow from its texture coordinates, each with a material of its own, so that one set of
/// texture coordinates is enough. Where there are too many of them those images are given up, and
/// that is said. Throws Error (input).
std::vector<Mesh> lay_by_one_set(const Part& part, const Range& range, Mesh mesh);

// ---- gltf_skin.cpp ----------------------------------------------------------------------------

/// Moves the mesh's vertices to where its skin's joints take them, in the world; false when the
/// primitive is not bound to the skin. Throws Error (input).
bool pose_vertices(const Part& part, const Range& range, const std::vector<Matrix>& joints,
                   Mesh& mesh);

}  // namespace penumbra::gltf
