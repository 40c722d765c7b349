// What an export may write to: nothing that was read, nothing of others.
#pragma once

#include "penumbra/exporters.h"

#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace penumbra {

/// Stands near the beginning of the files that exporters write.
inline constexpr std::string_view own_mark = "written by penumbra";

/// Whether `file` is one that an export has written.
bool is_own_file(const std::filesystem::path& file);

/// Throws Error (output) where one of `targets` is an input, or there already and, unless
/// ExportOptions::replace is set, not from an export. Devices and pipes are anyone's.
void check_targets(std::span<const std::filesystem::path> targets, const ExportOptions& options);

/// Removes the files in `folder` that are `chosen`, were written by an export and are neither in
/// `kept` nor inputs. Returns them.
std::vector<std::filesystem::path>
remove_old_files(const std::filesystem::path& folder,
                 const std::function<bool(const std::filesystem::path&)>& chosen,
                 std::span<const std::filesystem::path> kept, const ExportOptions& options);

}  // namespace penumbra
