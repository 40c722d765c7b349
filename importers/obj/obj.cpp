// OBJ and MTL files -> Scene, in steps: bytes -> clean text -> Model -> meshes and materials.
//
// tinyobjloader parses, but it reads what is wrong as zeros, knows neither line continuation nor
// comments behind a statement, and opens any path. So its input is cleaned and checked before
// (clean.h, mtl/text.h) and all indices after (parse.h), and files are read here.
#include "base/file.h"
#include "base/memory.h"
#include "importers/obj/clean.h"
#include "importers/obj/mesh.h"
#include "importers/obj/mtl/material.h"
#include "importers/obj/parse.h"

#include "penumbra/importers.h"

#include <algorithm>
#include <iterator>
#include <span>
#include <utility>

namespace penumbra {

namespace {

Imported read(std::string text, const std::string& name, const ModelFolders& folders,
              Illumination illumination) {
    Imported result;
    obj::Tally tally = {.file = name};
    std::vector<obj::Piece> pieces = obj::clean_obj(std::move(text), name, tally);
    obj::Model model = obj::parse(pieces, name, tally);
    std::vector<obj::Named> libraries;
    for (const obj::Piece& piece : pieces)
        std::ranges::copy(piece.libraries, std::back_inserter(libraries));
    pieces.clear();
    if (model.faces.empty()) throw Error(Failure::input, name, "no facets in it");

    obj::resolve_normals(model, tally);
    const auto entries = obj::read_libraries(libraries, name, folders, result);
    obj::build_materials(model.materials, name, entries, folders, illumination, result);
    obj::build_meshes(std::move(model), result.scene, tally);
    std::ranges::copy(tally.losses.losses(), std::back_inserter(result.losses));
    result.models.push_back({.file = name, .format = "OBJ"});
    result.illumination = illumination;
    return result;
}

std::string text_of(std::span<const std::byte> bytes, const std::string& name) {
    check_file_size(bytes.size(), name);
    const MemoryClaim claim(bytes.size(), name);
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

// The format knows no lights.
Illumination settled(const ModelOptions& options) {
    return options.illumination == Illumination::by_model ? Illumination::environment
                                                          : options.illumination;
}

}  // namespace

Imported read_obj(const std::filesystem::path& file, const ModelOptions& options) {
    Imported imported =
        read(read_text(file), file.string(), folders_of(file, options), settled(options));
    imported.files.push_back(file);
    return imported;
}

Imported read_obj(std::span<const std::byte> bytes, const std::string& name,
                  const ModelOptions& options) {
    return read(text_of(bytes, name), name, folders_in_memory(name, options), settled(options));
}

}  // namespace penumbra
