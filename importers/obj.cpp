#include "obj.h"

#include "file.h"

#include <algorithm>
#include <iterator>

namespace penumbra {

Imported read_obj(const std::filesystem::path& file, const ModelOptions& options) {
    const std::string name = file.string();
    Imported result;
    obj::Tally tally(name);
    std::vector<obj::Piece> pieces = obj::clean_obj(read_text(file), name, tally);
    obj::Model model = obj::parse(pieces, name, tally);
    std::vector<obj::Named> libraries;
    for (const obj::Piece& piece : pieces)
        std::ranges::copy(piece.libraries, std::back_inserter(libraries));
    pieces.clear();
    if (model.faces.empty()) throw Error(Failure::input, name, "no facets in it");

    obj::resolve_normals(model, tally);
    const ModelFolders folders = {.own = file.parent_path(), .allowed = options.allowed_paths};
    const auto entries = obj::read_libraries(libraries, name, folders, result.losses);
    obj::build_materials(model, entries, folders, result);
    obj::build_meshes(std::move(model), result.scene, tally);
    tally.append_to(result.losses);
    result.models.push_back({.file = name, .format = "OBJ"});
    return result;
}

}  // namespace penumbra
