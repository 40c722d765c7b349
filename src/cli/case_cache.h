// What an earlier run has found, so that an unchanged scene is not rendered again.
#pragma once

#include "penumbra/validation.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace penumbra::cli {

/// A running hash: FNV-1a with 64 bits (Fowler, Noll and Vo, RFC 9923).
class Hash {
  public:
    void add(std::string_view text);
    /// Name and content of every file in a folder and below, but for comments of POV-Ray files.
    void add_folder(const std::filesystem::path& folder);
    void add_file(const std::filesystem::path& file);
    std::string text() const;

  private:
    std::uint64_t state = 0xcbf29ce484222325U;
};

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
