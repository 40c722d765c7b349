// One scene: rendered by both, compared, and left in the report.
#pragma once

#include "cli/batch/case_cache.h"
#include "cli/batch/report_folder.h"
#include "cli/context.h"

namespace penumbra::cli {

/// A scene to validate and where its files go.
struct SceneJob {
    std::vector<std::filesystem::path> inputs = {};
    std::string name = {};
    std::string folder = {};  ///< below the report's; empty: the report's own
    LoadOptions load = {};
    Judging judging = {};
    std::vector<std::string> words = {};  ///< the command that validates it alone
    std::string povray = {};              ///< its version
    int threads = 0;                      ///< 0: all
    std::size_t memory = 0;               ///< bytes that each other renderer may take
    bool quiet = false;                   ///< no progress bars
};

/// Where the cases of a scene go: the first is there.
struct SceneCases {
    std::vector<Case>& cases;
    bool reuse =
        true;  ///< what an earlier run has left in the final report, if nothing has changed
};

/// Renders, exports, runs POV-Ray and further renderers and compares: one case for POV-Ray and one
/// for each of the others. Throws Error.
void validate_scene(const Context& context, const SceneJob& job, ReportFolder& report,
                    const SceneCases& into);

/// Leaves the page of a case that failed, which says why, in the final report.
void keep_failure(const Error& error, ReportFolder& report, Case& failed);

}  // namespace penumbra::cli
