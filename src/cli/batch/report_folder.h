// The folder of a report, which appears under its name only when it is complete.
#pragma once

#include "penumbra/report.h"

#include <cstdint>
#include <filesystem>
#include <mutex>
#include <set>
#include <span>
#include <string>
#include <utility>

namespace penumbra::cli {

/// Throws Error (output) when no report can be written there, or, unless `replace` is set, when the
/// pages of somebody else are there.
void check_report(const std::filesystem::path& folder, bool replace);

/// A folder beside the final one; removed with all that is in it unless finish() is called.
class ReportFolder {
  public:
    /// Unless `replace` is set, files that are not of an earlier report stay: where they lie in the
    /// way, the functions below throw Error (output). Throws Error (output).
    explicit ReportFolder(const std::filesystem::path& final_name, bool replace = false);
    ~ReportFolder();
    ReportFolder(const ReportFolder&) = delete;
    ReportFolder& operator=(const ReportFolder&) = delete;

    const std::filesystem::path& path() const { return staging_; }
    /// The final folder; what is in it is of an earlier run.
    const std::filesystem::path& final_path() const { return target_; }

    /// A message with the names that the files of this folder will have.
    std::string with_final_names(std::string message) const;

    /// These files are never replaced or removed: where they lie in the way of the report, the
    /// functions below throw Error (output). May be called while other cases are at work.
    void protect(std::span<const std::filesystem::path> inputs);

    /// Moves one folder of it to the final folder at once, in the place of an earlier one.
    void publish(const std::string& part);

    /// Moves everything to the final folder, over what an earlier report left there.
    void finish();

  private:
    std::filesystem::path target_, staging_;
    bool replace_ = false;
    std::mutex mutex_ = {};
    std::set<std::pair<std::uintmax_t, std::uintmax_t>> inputs_ = {};  ///< device and number

    void check_free(const std::filesystem::path& to);
};

/// Writes the difference and FLIP maps of comparable pictures into the case's folder of a report
/// and notes them in result.files.
void save_maps(const std::filesystem::path& report, Case& result);

/// The path of a case's file in the report.
std::string in_report(const Case& result, const std::string& file);

}  // namespace penumbra::cli
