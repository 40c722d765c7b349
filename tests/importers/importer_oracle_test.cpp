// Our importers against an independent one (assimp): what both make of a file must have the same
// size, area, normals and texture coordinates in the world.
#include "support/manifest.h"
#include "support/support.h"

#include "penumbra/importers.h"

#include <assimp/Importer.hpp>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <array>
#include <cmath>
#include <map>
#include <optional>

using namespace penumbra;

namespace {

// Figures that depend on neither the order nor the splitting of facets. The sums over facets are
// weighted by area, which leaves out those without.
struct Shape {
    Bounds box = {};
    std::size_t facets = 0;
    double area = 0;
    Vec3 moment = {0, 0, 0};   // of the facets' centres
    Vec3 normals = {0, 0, 0};  // of the vertex normals, where there are any
    Vec2 texcoords = {0, 0};   // of the first set, where there is one

    void add(const std::array<Vec3, 3>& corner, const Vec3& normal, const Vec2& texcoord) {
        for (const Vec3& p : corner) box.extend(p);
        const double a = (corner[1] - corner[0]).cross(corner[2] - corner[0]).length() / 2;
        ++facets;
        area += a;
        moment += (corner[0] + corner[1] + corner[2]) * (a / 3);
        normals += normal * a;
        texcoords += texcoord * a;
    }
};

// A normal in the world, whatever the scale.
Vec3 world_normal(const Matrix& inverse, const Vec3& normal) {
    Vec3 world;
    inverse.transposed().multDirMatrix(normal, world);
    return world.normalized();
}

Shape shape_of(const Scene& scene) {
    Shape shape;
    for (const Instance& instance : scene.instances) {
        const Mesh& mesh = scene.meshes[instance.mesh];
        const Matrix inverse = instance.transform.inverse();
        for (const auto& triangle : mesh.triangles) {
            std::array<Vec3, 3> corner;
            Vec3 normal(0);
            Vec2 texcoord(0);
            for (std::size_t i = 0; i < 3; ++i) {
                const Index v = triangle[i];
                corner[i] = Vec3(mesh.positions[v]) * instance.transform;
                if (!mesh.normals.empty())
                    normal += world_normal(inverse, Vec3(mesh.normals[v])) / 3;
                if (!mesh.texcoords.empty()) texcoord += Vec2(mesh.texcoords[v]) / 3;
            }
            shape.add(corner, normal, texcoord);
        }
    }
    return shape;
}

// assimp's matrices are for column vectors.
Matrix matrix_of(const aiMatrix4x4& m) {
    Matrix matrix;
    for (unsigned row = 0; row < 4; ++row)
        for (unsigned column = 0; column < 4; ++column)
            matrix[int(column)][int(row)] = double(m[row][column]);
    return matrix;
}

// Where the scene's nodes stand in the world.
void place_nodes(const aiNode& node, const Matrix& parent, std::map<std::string, Matrix>& world) {
    const Matrix placed = matrix_of(node.mTransformation) * parent;
    world[node.mName.C_Str()] = placed;
    for (unsigned i = 0; i < node.mNumChildren; ++i) place_nodes(*node.mChildren[i], placed, world);
}

Vec3 vector_of(const aiVector3D& a) { return {double(a.x), double(a.y), double(a.z)}; }

// A mesh's vertices and normals in the world: morphed as its file says, and where its bones are.
struct Placed {
    std::vector<Vec3> positions = {}, normals = {};

    Placed(const aiMesh& mesh, const Matrix& node, const std::map<std::string, Matrix>& nodes) {
        for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
            positions.push_back(vector_of(mesh.mVertices[v]));
            normals.push_back(mesh.HasNormals() ? vector_of(mesh.mNormals[v]) : Vec3(0));
        }
        for (unsigned t = 0; t < mesh.mNumAnimMeshes; ++t) morph(mesh, *mesh.mAnimMeshes[t]);
        std::vector<Matrix> matrices(mesh.mNumVertices, mesh.HasBones() ? Matrix(0.0) : node);
        for (unsigned b = 0; b < mesh.mNumBones; ++b) {
            const aiBone& bone = *mesh.mBones[b];
            const Matrix moved = matrix_of(bone.mOffsetMatrix) * nodes.at(bone.mName.C_Str());
            for (unsigned w = 0; w < bone.mNumWeights; ++w)
                matrices[bone.mWeights[w].mVertexId] += moved * double(bone.mWeights[w].mWeight);
        }
        for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
            positions[v] = positions[v] * (matrices[v] * (1 / matrices[v][3][3]));
            if (mesh.HasNormals()) normals[v] = world_normal(matrices[v].inverse(), normals[v]);
        }
    }
    // The targets are absolute.
    void morph(const aiMesh& mesh, const aiAnimMesh& target) {
        for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
            const double weight = double(target.mWeight);
            if (target.HasPositions())
                positions[v] +=
                    (vector_of(target.mVertices[v]) - vector_of(mesh.mVertices[v])) * weight;
            if (target.HasNormals() && mesh.HasNormals())
                normals[v] +=
                    (vector_of(target.mNormals[v]) - vector_of(mesh.mNormals[v])) * weight;
        }
    }
};

void add_mesh(const aiMesh& mesh, const Placed& placed, Shape& shape) {
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
        if (mesh.mFaces[f].mNumIndices != 3) continue;
        std::array<Vec3, 3> corner;
        Vec3 normal(0);
        Vec2 texcoord(0);
        for (unsigned i = 0; i < 3; ++i) {
            const unsigned v = mesh.mFaces[f].mIndices[i];
            corner[i] = placed.positions[v];
            normal += placed.normals[v] / 3;
            if (mesh.HasTextureCoords(0)) {
                const Vec3 t = vector_of(mesh.mTextureCoords[0][v]);
                texcoord += Vec2(t.x, t.y) / 3;
            }
        }
        shape.add(corner, normal, texcoord);
    }
}

// Nodes may have equal names, so that only bones are found by theirs.
void add_node(const aiScene& scene, const aiNode& node, const Matrix& parent,
              const std::map<std::string, Matrix>& nodes, Shape& shape) {
    const Matrix placed = matrix_of(node.mTransformation) * parent;
    for (unsigned m = 0; m < node.mNumMeshes; ++m) {
        const aiMesh& mesh = *scene.mMeshes[node.mMeshes[m]];
        add_mesh(mesh, Placed(mesh, placed, nodes), shape);
    }
    for (unsigned i = 0; i < node.mNumChildren; ++i)
        add_node(scene, *node.mChildren[i], placed, nodes, shape);
}

// Nothing where assimp cannot read the file.
std::optional<Shape> try_assimp(const test::fs::path& file) {
    Assimp::Importer importer;
    const aiScene* scene = importer.ReadFile(file.string(), aiProcess_Triangulate);
    if (scene == nullptr) return std::nullopt;
    Shape shape;
    std::map<std::string, Matrix> nodes;
    place_nodes(*scene->mRootNode, Matrix(), nodes);
    add_node(*scene, *scene->mRootNode, Matrix(), nodes, shape);
    return shape;
}

Shape assimp_shape(const test::fs::path& file) {
    const std::optional<Shape> shape = try_assimp(file);
    INFO("assimp cannot read it");
    REQUIRE(shape);
    return *shape;
}

void check_same(const Shape& ours, const Shape& theirs) {
    REQUIRE(ours.facets > 0);
    CHECK(ours.facets == theirs.facets);
    const double size = theirs.box.radius(), near = 1e-5;
    CHECK((ours.box.min - theirs.box.min).length() <= near * size);
    CHECK((ours.box.max - theirs.box.max).length() <= near * size);
    CHECK(ours.area == Approx(theirs.area).epsilon(near));
    const double far = std::max(size, theirs.box.center().length());
    CHECK((ours.moment - theirs.moment).length() <= near * far * theirs.area);
    CHECK((ours.normals - theirs.normals).length() <= 1e-4 * theirs.area);
    CHECK((ours.texcoords - theirs.texcoords).length() <= 1e-4 * theirs.area);
}

}  // namespace

// Not RecursiveSkeletons: assimp gives a mesh one skin, that file shows one with 84.
TEST_CASE("Importers, read glTF as assimp does") {
    if (!test::fs::exists(test::assets())) PENUMBRA_SKIP("the assets are not here");
    for (const char* name : {"Avocado/Avocado.gltf",
                             "BoxInterleaved/BoxInterleaved.glb",
                             "BoxVertexColors/BoxVertexColors.gltf",
                             "Cube/Cube.gltf",
                             "LowPoly/low-poly.gltf",
                             "MultipleScenes/MultipleScenes.gltf",
                             "NegativeScaleTest/NegativeScaleTest.glb",
                             "NormalTangentTest/NormalTangentTest.glb",
                             "balloon/scene.gltf",
                             "SimpleDolly/simple-dolly.gltf",
                             "SimpleMeshes/SimpleMeshes.gltf",
                             "SimpleSparseAccessor/SimpleSparseAccessor.gltf",
                             "Suzanne/Suzanne.gltf",
                             "TextureCoordinateTest/TextureCoordinateTest.gltf",
                             "camp/camp.gltf",
                             "Fox/Fox.glb",
                             "RiggedSimple/RiggedSimple.gltf",
                             "SimpleSkin/SimpleSkin.gltf",
                             "SimpleMorph/SimpleMorph.gltf",
                             "AnimatedMorphCube/AnimatedMorphCube.gltf",
                             "MorphPrimitivesTest/MorphPrimitivesTest.gltf",
                             "InterpolationTest/InterpolationTest.glb",
                             "unassigned-skeleton/unassigned-skeleton.gltf",
                             "box-morph/box-morph.gltf",
                             "Box-Draco/Box.gltf",
                             "BoxMetaDraco/BoxMetaDraco.gltf",
                             "garage/garage.gltf",
                             "robot/robot.glb",
                             "sunflower/sunflower.gltf"}) {
        INFO(name);
        const test::fs::path file = test::assets() / "gltf" / name;
        check_same(shape_of(read_gltf(file).scene), assimp_shape(file));
    }
}

// Why the bounds of a model are not compared with those of assimp 5.2 (docs/fidelity.md, "Bounds").
const std::map<std::string, std::string> exceptions = {
    {"gltf/AnimatedMorphCube-Quantized/AnimatedMorphCube.gltf", "no KHR_mesh_quantization"},
    {"gltf/RecursiveSkeletons/RecursiveSkeletons.glb", "one skin for a mesh"},
    {"gltf/SimpleInstancing/SimpleInstancing.glb", "no EXT_mesh_gpu_instancing"},
    {"gltf/asset-generator/Animation_Skin/Animation_Skin_03.gltf", "crashes"},
    {"gltf/asset-generator/Animation_Skin/Animation_Skin_11.gltf", "one skin for a mesh"},
    {"gltf/asset-generator/Animation_SkinType/Animation_SkinType_02.gltf", "16-bit weights"},
    {"obj/assimp/box_UTF16BE.obj", "reads no facets"},
    {"gltf/meshopt-fallback/meshopt-fallback.gltf", "no EXT_meshopt_compression"},
};

TEST_CASE("Importers, give every model the bounds that assimp gives it") {
    if (!test::fs::exists(test::assets())) PENUMBRA_SKIP("the assets are not here");
    std::size_t compared = 0;
    for (const std::string& name : test::models_that_load()) {
        if (exceptions.contains(name)) continue;
        INFO(name);
        const test::fs::path file = test::assets() / name;
        const bool obj = file.extension() == ".obj";
        Scene scene;
        try {
            scene = (obj ? read_obj(file) : read_gltf(file)).scene;
        } catch (const Error&) {
            continue;  // files without facets, see docs/fidelity-models.md
        }
        const Shape ours = shape_of(scene);
        if (ours.facets == 0) continue;
        const std::optional<Shape> theirs = try_assimp(file);
        INFO("assimp cannot read it");
        CHECK(theirs);
        if (!theirs) continue;
        const double near = 1e-5 * theirs->box.radius();
        INFO(ours.box.min << ours.box.max << " against " << theirs->box.min << theirs->box.max);
        CHECK((ours.box.min - theirs->box.min).length() <= near);
        CHECK((ours.box.max - theirs->box.max).length() <= near);
        ++compared;
    }
    CHECK(compared > 200);
}
