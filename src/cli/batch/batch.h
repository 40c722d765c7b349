// Many comparisons at once: how they end, and what is said of them.
#pragma once

#include "cli/batch/report_folder.h"
#include "cli/context.h"

#include <exception>
#include <functional>
#include <set>
#include <string>
#include <vector>

namespace penumbra::cli {

/// One piece of work that gives one case or several: the first, and further ones that belong to it.
struct Job {
    std::string name = {};
    /// Fills `cases`, which has one of that name, step by step, so that a failing step leaves what
    /// was found before it. `again` says that it was already done before another job crashed.
    /// Throws Error.
    std::function<void(std::vector<Case>& cases, bool again)> run = {};
    /// Leaves in the report that this very job has crashed; may be empty.
    std::function<void(Case& one, const Error& crash)> give_up = {};
};

struct Outcome {
    Case result = {};
    int status = exit_internal;
    std::exception_ptr failure = {};
};

/// Runs all jobs, `at_once` of them at a time. What one of them throws stays with it. One that is
/// `alone` keeps its pictures, and its wrong options are those of the command. Throws Error
/// (interrupted).
std::vector<Outcome> run_jobs(const Context& context, const std::vector<Job>& jobs, int at_once,
                              bool alone = false);

/// The exit status of all together: the worst one.
int worst_status(const std::vector<Outcome>& outcomes);

std::vector<Case> cases_of(std::vector<Outcome> outcomes);

/// Prints what --json and --summary ask for; else the figures of a single case or the list of all,
/// and where the report is.
void print_cases(const Context& context, const std::vector<Case>& cases,
                 const std::optional<std::filesystem::path>& report);

/// "chair", "chair-2", ... for pictures and scenes of the same name: names of cases and of folders
/// that are no others' names and not hidden.
class Names {
  public:
    std::string unused(const std::string& wanted);

  private:
    std::set<std::string> used_ = {"index.html", "report.json", "junit.xml"};
};

}  // namespace penumbra::cli
