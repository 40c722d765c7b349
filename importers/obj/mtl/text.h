// MTL files -> statements.
#pragma once

#include "importers/obj/text/words.h"
#include "importers/shared/model_folders.h"

#include "penumbra/importers.h"

#include <filesystem>
#include <string>
#include <vector>

namespace penumbra::obj {

struct Statement {
    std::string key = {};   ///< lower case
    std::string word = {};  ///< as the file has it
    std::string operands = {};
    Index line = 0;
};

/// One newmtl with its statements.
struct MtlEntry {
    std::string name = {};
    std::string file = {};            ///< for messages
    std::filesystem::path from = {};  ///< its folder, relative to the model's
    Index line = 0;
    std::vector<Statement> statements = {};
};

/// Reads the materials of all libraries that a model names, and adds to the files and losses of
/// `result`. What is missing is lost, not wrong.
std::vector<MtlEntry> read_libraries(const std::vector<Named>& libraries, const std::string& model,
                                     const ModelFolders& folders, Imported& result);

}  // namespace penumbra::obj
