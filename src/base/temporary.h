// Names for what is not finished yet, and what killed processes have left of it.
#pragma once

#include <filesystem>
#include <string>

namespace penumbra {

/// The machine, its start and this process, "desk-0123abcd.4567": different for all that may write
/// into one folder at once, containers and machines that share it among them.
std::string process_mark();

/// Removes the files and folders PREFIX<mark>.tmp and PREFIX<mark>-<number>.tmp in `folder` that
/// processes of this machine have left there that are gone. Others' may still be at work.
void remove_stale(const std::filesystem::path& folder, const std::string& prefix);

}  // namespace penumbra
