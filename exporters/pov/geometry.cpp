#include "exporters/pov/geometry.h"

#include "base/memory.h"
#include "exporters/pov/material.h"
#include "exporters/pov/sdl.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>

namespace penumbra::pov {

namespace {

constexpr std::size_t line_length = 96;

// Comma-separated items, as many to a line as fit; append_item(text, i) writes one. Long lists are
// written in parts, by all processors.
template <class Append>
void append_list(std::string& out, const char* keyword, std::size_t count, Append append_item) {
    constexpr std::size_t part = 1 << 14;
    std::vector<std::string> texts((count + part - 1) / part);
    tbb::parallel_for(std::size_t(0), texts.size(), [&](std::size_t index) {
        std::string& text = texts[index];
        std::size_t line_start = 0;
        const std::size_t first = index * part, last = std::min(first + part, count);
        for (std::size_t i = first; i < last; ++i) {
            text += ',';
            if (i == first || text.size() - line_start >= line_length) {
                line_start = text.size() + 1;
                text += "\n    ";
            } else {
                text += ' ';
            }
            append_item(text, i);
        }
    });
    out += "  ";
    out += keyword;
    out += " { ";
    sdl::append(out, count);
    for (std::string& text : texts) {
        out += text;
        text = {};
    }
    out += "\n  }\n";
}

void append_vector(std::string& out, const Vec3f& v) {
    out += '<';
    sdl::append(out, v.x);
    out += ',';
    sdl::append(out, v.y);
    out += ',';
    sdl::append(out, v.z);
    out += '>';
}

void append_vectors(std::string& out, const char* keyword, const std::vector<Vec3f>& vectors) {
    append_list(out, keyword, vectors.size(),
                [&](std::string& text, std::size_t i) { append_vector(text, vectors[i]); });
}

// POV-Ray replaces a normal of length zero by x, and warns.
void append_normals(std::string& out, const std::vector<Vec3f>& normals) {
    append_list(out, "normal_vectors", normals.size(), [&](std::string& text, std::size_t i) {
        append_vector(text, normals[i] == Vec3f(0) ? Vec3f(1, 0, 0) : normals[i]);
    });
}

void append_texcoords(std::string& out, const std::vector<Vec2f>& texcoords) {
    append_list(out, "uv_vectors", texcoords.size(), [&](std::string& item, std::size_t i) {
        item += '<';
        sdl::append_fixed(item, texcoords[i].x);
        item += ',';
        sdl::append_fixed(item, texcoords[i].y);
        item += '>';
    });
}

std::string tint_name(const Plan& plan, const MeshPlan& mesh, const Look& look, std::size_t tint) {
    return identifier(plan, "Tint",
                      mesh.name + (look.mirrored ? "__mirrored_" : "_") + std::to_string(tint + 1));
}

// Textures of several layers can only be listed by name.
void append_texture_list(std::string& out, const Plan& plan, const MeshPlan& mesh,
                         const Look& look) {
    const bool single = is_single(plan, look);
    out += "  texture_list { " + std::to_string(mesh.tints.size());
    for (std::size_t i = 0; i < mesh.tints.size(); ++i)
        out += ",\n    texture { " +
               (single ? single_texture(plan, look, mesh.tints[i].color)
                       : tint_name(plan, mesh, look, i)) +
               " }";
    out += "\n  }\n";
}

void declare_tints(std::string& out, const Plan& plan, const MeshPlan& mesh, const Look& look) {
    if (is_single(plan, look)) return;
    for (std::size_t i = 0; i < mesh.tints.size(); ++i)
        out += tint_declaration(plan, look, tint_name(plan, mesh, look, i), mesh.tints[i]);
}

// A facet's front is for POV-Ray where its corners run clockwise in a right-handed space.
std::array<Index, 3> povray_order(const std::array<Index, 3>& corners, bool sides_differ) {
    const auto& [a, b, c] = corners;
    return sides_differ ? std::array{a, c, b} : corners;
}

void append_faces(std::string& out, const Mesh& mesh, const MeshPlan& plan, bool sides_differ) {
    append_list(out, "face_indices", mesh.triangles.size(), [&](std::string& item, std::size_t i) {
        const auto [a, b, c] = povray_order(mesh.triangles[i], sides_differ);
        item += '<';
        sdl::append(item, std::size_t(a));
        item += ',';
        sdl::append(item, std::size_t(b));
        item += ',';
        sdl::append(item, std::size_t(c));
        item += '>';
        if (plan.tints.empty()) return;
        const Index first = plan.tint_of[a];
        const bool one = plan.tint_of[b] == first && plan.tint_of[c] == first;
        for (const Index corner : {a, b, c}) {
            item += ',';
            sdl::append(item, std::size_t(plan.tint_of[corner]));
            if (one) break;  // a third of the shading
        }
    });
}

void append_mesh(std::string& out, const Plan& plan, std::size_t index, const Look& look) {
    const Mesh& mesh = plan.scene->meshes[index];
    const MeshPlan& mesh_plan = plan.meshes[index];
    out += '\n';
    if (!mesh_plan.tints.empty()) declare_tints(out, plan, mesh_plan, look);
    out += "#declare " + mesh_identifier(plan, mesh_plan, look) + " = mesh2 {";
    if (mesh.name != mesh_plan.name && !mesh.name.empty()) out += "  // " + sdl::comment(mesh.name);
    out += '\n';
    append_vectors(out, "vertex_vectors", mesh.positions);
    if (mesh_plan.normals) append_normals(out, mesh.normals);
    if (mesh_plan.texcoords) append_texcoords(out, mesh.texcoords);
    if (!mesh_plan.tints.empty()) append_texture_list(out, plan, mesh_plan, look);
    const bool sides_differ =
        plan.scene->materials[mesh.material].sides == Sides::front || frosted(plan, look);
    append_faces(out, mesh, mesh_plan, sides_differ);
    out += "  inside_vector <0.1, 1, 0.05>\n}\n";
}

std::size_t expected_size(const Plan& plan) {
    std::size_t size = 1000;
    for (std::size_t i = 0; i < plan.meshes.size(); ++i) {
        const Mesh& mesh = plan.scene->meshes[i];
        if (plan.meshes[i].name.empty()) continue;
        size += 1000 + 35 * mesh.positions.size() + 25 * mesh.triangles.size();
        if (plan.meshes[i].normals) size += 40 * mesh.positions.size();
        if (plan.meshes[i].texcoords) size += 30 * mesh.positions.size();
    }
    return size;
}

}  // namespace

std::string mesh_identifier(const Plan& plan, const MeshPlan& mesh, const Look& look) {
    const bool own = look.mirrored && !mesh.tints.empty();
    return identifier(plan, "Mesh", mesh.name + (own ? "__mirrored" : ""));
}

std::string geometry_text(const Plan& plan) {
    const MemoryClaim claim(2 * expected_size(plan), plan.stem + "_geometry.inc");
    std::string out;
    out.reserve(expected_size(plan));
    for (std::size_t i = 0; i < plan.meshes.size(); ++i) {
        if (plan.meshes[i].name.empty()) continue;
        if (out.empty()) {
            if (!in_other_scenes(plan))
                out = "// Meshes of " + plan.stem + ".pov, which includes this file.\n";
            out +=
                "// inside_vector makes POV-Ray find every facet along a ray; without it a facet\n"
                "// that is too close to count can hide one behind it.\n";
        }
        const Look& look = plan.looks[plan.meshes[i].look];
        append_mesh(out, plan, i, look);
        // Where its vertices have textures a mesh cannot wear others.
        if (look.twin != no_index && !plan.meshes[i].tints.empty())
            append_mesh(out, plan, i, plan.looks[look.twin]);
    }
    return out;
}

}  // namespace penumbra::pov
