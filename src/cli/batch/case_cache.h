// What an earlier run has found, so that an unchanged scene is not rendered again.
#pragma once

#include "base/hash.h"

#include "penumbra/report.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace penumbra::cli {

/// Adds a file's content, but for comments of POV-Ray files.
void add_file(Hash& hash, const std::filesystem::path& file);
/// Adds name and content of every file in a folder and below.
void add_folder(Hash& hash, const std::filesystem::path& folder);

/// What decides how a case looks and how it is judged.
struct CaseKey {
    std::string pictures = {};  ///< of what the pictures depend on
    std::string verdict = {};   ///< of what else the verdict depends on
    bool operator==(const CaseKey&) const = default;
};

struct CachedCases {
    CaseKey key = {};
    std::vector<Case> cases =
        {};  ///< a scene's own and those of further renderers, without pictures
};

/// What store_cases() has left in `folder`; none when there is nothing that can be used.
std::optional<CachedCases> cached_cases(const std::filesystem::path& folder);

/// Throws Error (output).
void store_cases(const std::filesystem::path& folder, const CachedCases& cached);

/// Identifies this very program.
const std::string& program_key();

}  // namespace penumbra::cli
