#include "cli/batch/batch.h"

#include "cli/advice.h"
#include "cli/batch/figures.h"
#include "cli/memory_bound.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <thread>

namespace penumbra::cli {
namespace {

// The status of a failure, and the failure in the case that it belongs to.
int note_failure(Case& result, int status, const std::string& message) {
    result.message = message;
    result.comparison.verdict = Verdict::error;
    return status;
}

std::vector<Outcome> outcomes_of(const Job& job, bool alone, bool again) {
    std::vector<Case> cases(1);
    cases[0].name = job.name;
    int status = exit_success;
    std::exception_ptr failure;
    try {
        job.run(cases, again);
    } catch (const Error& error) {
        failure = std::current_exception();
        // With several scenes a setting that does not suit one of them is that scene's fault.
        status =
            note_failure(cases[0],
                         error.failure == Failure::usage && !alone ? int(exit_input)
                                                                   : exit_status(error.failure),
                         with_advice(error));
    } catch (const std::bad_alloc&) {
        failure = std::current_exception();
        status = note_failure(cases[0], exit_input, out_of_memory());
    } catch (const std::exception& error) {
        failure = std::current_exception();
        status =
            note_failure(cases[0], exit_internal, fmt::format("internal error: {}", error.what()));
    }
    std::vector<Outcome> outcomes;
    for (Case& one : cases) {
        if (!alone) one.test = one.reference = one.comparison.flip_map = {};
        const int own = one.comparison.verdict == Verdict::error && !failure
                            ? int(exit_povray)
                            : verdict_status(one.comparison.verdict);
        outcomes.push_back({std::move(one), failure ? status : own, failure});
    }
    return outcomes;
}

void say(const Context& context, const Outcome& outcome, std::size_t done, std::size_t all) {
    if (!outcome.result.message.empty() && !context.stop.stop_requested())
        context.console.error(outcome.result.message);
    if (all > 1)
        context.console.detail(fmt::format("{} of {}: {} {}{}", done, all, outcome.result.name,
                                           to_string(outcome.result.comparison.verdict),
                                           outcome.result.cached ? " (unchanged)" : ""));
}

// The worst first; equal ones in the order of the command line.
std::vector<Case> by_severity(std::vector<Case> cases) {
    std::ranges::stable_sort(cases, std::greater(), severity);
    return cases;
}

// A fault of penumbra's that no catch can mend.
std::vector<Outcome> crashed(const Job& job) {
    const Error error(Failure::input, job.name,
                      "penumbra crashed on it; please report this with the scene");
    Outcome outcome = {.status = exit_internal};
    outcome.result.name = job.name;
    note_failure(outcome.result, exit_internal, error.what());
    if (job.give_up) job.give_up(outcome.result, error);
    return {std::move(outcome)};
}

// Runs a job and notes in `progress` how far it is.
std::vector<Outcome> supervised(const Job& job, std::atomic<int>& state, bool only_one) {
    if (state == Progress::crashed) return crashed(job);
    const bool again =
        state.exchange(only_one ? Progress::running_alone : Progress::running) == Progress::done;
    auto outcomes = outcomes_of(job, false, again);
    state = Progress::done;
    return outcomes;
}

}  // namespace

std::vector<Outcome> run_jobs(const Context& context, const std::vector<Job>& jobs, int at_once,
                              bool alone) {
    std::vector<std::vector<Outcome>> outcomes(jobs.size());
    std::atomic<std::size_t> next = 0, done = 0;
    const auto run = [&](std::size_t i, bool only_one) {
        if (context.stop.stop_requested()) return;
        outcomes[i] = context.progress ? supervised(jobs[i], (*context.progress)[i], only_one)
                                       : outcomes_of(jobs[i], alone, false);
        ++done;
        for (const Outcome& outcome : outcomes[i])
            if (!alone) say(context, outcome, done, jobs.size());
    };
    // After a crash those that may have caused it run one by one, which tells them apart.
    for (std::size_t i = 0; context.progress && i < jobs.size(); ++i)
        if ((*context.progress)[i] == Progress::suspect) run(i, true);
    const auto worker = [&] {
        for (std::size_t i = next++; i < jobs.size(); i = next++)
            if (outcomes[i].empty()) run(i, at_once == 1);
    };
    {
        std::vector<std::jthread> helpers;
        for (int i = 1; i < at_once; ++i) helpers.emplace_back(worker);
        worker();
    }
    if (context.stop.stop_requested()) throw Error(Failure::interrupted, "", "interrupted");
    std::vector<Outcome> all;
    for (std::vector<Outcome>& some : outcomes) std::ranges::move(some, std::back_inserter(all));
    return all;
}

int worst_status(const std::vector<Outcome>& outcomes) {
    constexpr std::array order = {exit_internal,       exit_povray,    exit_output, exit_input,
                                  exit_not_comparable, exit_different, exit_success};
    for (const int status : order)
        for (const Outcome& outcome : outcomes)
            if (outcome.status == status) return status;
    return exit_internal;
}

std::vector<Case> cases_of(std::vector<Outcome> outcomes) {
    std::vector<Case> cases;
    for (Outcome& outcome : outcomes) cases.push_back(std::move(outcome.result));
    return cases;
}

void print_cases(const Context& context, const std::vector<Case>& cases,
                 const std::optional<std::filesystem::path>& report) {
    if (context.arguments.json) return context.console.result(report_json(cases));
    if (context.arguments.markdown) return context.console.result(report_markdown(cases));
    std::string text = cases.size() == 1 && cases[0].folder.empty() ? figures(cases.front())
                                                                    : overview(by_severity(cases));
    if (report) text += fmt::format("report: {}\n", (*report / "index.html").string());
    context.console.result(text);
}

std::string Names::unused(const std::string& wanted) {
    std::string first = wanted.empty() ? "scene" : wanted;
    if (first.starts_with('.'))
        first = fmt::format("_{}", first);  // "...glb" would give another folder
    std::string name = first;
    for (int i = 2; !used_.insert(name).second; ++i) name = fmt::format("{}-{}", first, i);
    return name;
}

}  // namespace penumbra::cli
