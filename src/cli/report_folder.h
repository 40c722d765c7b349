// The folder of a report, which appears under its name only when it is complete.
#pragma once

#include "penumbra/validation.h"

#include <filesystem>
#include <string>

namespace penumbra::cli {

/// Throws Error (output) when no report can be written there.
void check_report(const std::filesystem::path& folder);

/// A folder beside the final one; removed with all that is in it unless finish() is called.
class ReportFolder {
  public:
    /// Throws Error (output).
    explicit ReportFolder(const std::filesystem::path& final_name);
    ~ReportFolder();
    ReportFolder(const ReportFolder&) = delete;
    ReportFolder& operator=(const ReportFolder&) = delete;

    const std::filesystem::path& path() const { return staging; }

    /// Moves everything to the final folder, over what an earlier report left there.
    void finish();

  private:
    std::filesystem::path target, staging;
};

/// Writes the difference and FLIP maps of comparable pictures into `folder` / `sub` and notes them
/// in result.files.
void save_maps(const std::filesystem::path& folder, const std::string& sub, Case& result);

}  // namespace penumbra::cli
