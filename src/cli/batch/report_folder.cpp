#include "cli/batch/report_folder.h"

#include "base/file.h"
#include "base/temporary.h"
#include "cli/interruption.h"
#include "cli/steps.h"

#include "penumbra/error.h"
#include "penumbra/image.h"

#include <sys/stat.h>

#include <optional>
#include <system_error>

namespace penumbra::cli {
namespace {

namespace fs = std::filesystem;

constexpr float difference_gain = 100;  // shows what the eye cannot see

// "report/" and "report/." name the same folder as "report".
fs::path plain(const fs::path& folder) {
    const fs::path normal = (folder / "").lexically_normal();
    return normal.has_parent_path() ? normal.parent_path() : normal;
}

// What tells a file from all others, whatever it is called; none where it is missing.
std::optional<std::pair<std::uintmax_t, std::uintmax_t>> identity_of(const fs::path& file) {
    struct stat status{};
    if (::stat(file.c_str(), &status) != 0) return std::nullopt;
    return std::pair(std::uintmax_t(status.st_dev), std::uintmax_t(status.st_ino));
}

[[noreturn]] void fail(const fs::path& folder, const std::error_code& error) {
    throw Error(Failure::output, folder.string(), "cannot write the report: " + error.message());
}

// Is there a report in the folder, or what a run of several scenes has finished of one?
bool is_report(const fs::path& folder) {
    std::error_code ignored;
    if (fs::exists(folder / "cache.json", ignored)) return true;
    try {
        return !cases_of_json(read_text(folder / "report.json")).empty();
    } catch (const Error&) {
        return false;
    }
}

[[noreturn]] void refuse(const fs::path& file) {
    throw Error(Failure::output, file.string(),
                "is there already, and not from a report; give the report another folder",
                Remedy::replace);
}

}  // namespace

void check_report(const fs::path& folder, bool replace) {
    std::error_code ignored;
    const fs::path target = plain(folder);
    if (fs::exists(target, ignored) && !fs::is_directory(target, ignored))
        throw Error(Failure::output, folder.string(), "is not a folder");
    if (const fs::path page = target / "index.html";
        !replace && fs::exists(page, ignored) && !is_report(target))
        refuse(page);
    if (fs::is_directory(target, ignored))
        check_writable(target / "index.html");
    else
        check_writable(target);
}

ReportFolder::ReportFolder(const fs::path& final_name, bool replace)
    : target_(plain(final_name)), replace_(replace) {
    const std::string prefix = "." + target_.filename().string() + ".";
    remove_stale(target_, prefix);
    remove_stale(target_.parent_path(), prefix);
    const std::string name = prefix + process_mark();
    // In an existing folder, so that "--report ." works wherever "." is.
    std::error_code error;
    staging_ = fs::is_directory(target_, error) ? target_ / (name + ".tmp")
                                                : target_.parent_path() / (name + ".tmp");
    set_leftover(fs::absolute(staging_, error));
    fs::create_directory(staging_, error);
    if (error) fail(final_name, error);
}

ReportFolder::~ReportFolder() { remove_leftover(); }

std::string ReportFolder::with_final_names(std::string message) const {
    const std::string here = (staging_ / "").string();
    for (auto at = message.find(here); at != message.npos; at = message.find(here, at))
        message.replace(at, here.size(), (target_ / "").string());
    return message;
}

void ReportFolder::protect(std::span<const fs::path> inputs) {
    const std::lock_guard lock(mutex_);
    for (const fs::path& input : inputs)
        if (const auto id = identity_of(input)) inputs_.insert(*id);
}

// `to` and all below it may go.
void ReportFolder::check_free(const fs::path& to) {
    const std::lock_guard lock(mutex_);
    const auto check = [&](const fs::path& file) {
        const auto id = identity_of(file);
        if (id && inputs_.contains(*id)) throw input_in_the_way(file);
    };
    check(to);
    std::error_code error;
    const bool directory = fs::is_directory(to, error);
    fs::recursive_directory_iterator at = directory ? fs::recursive_directory_iterator(to, error)
                                                    : fs::recursive_directory_iterator();
    for (; !error && at != fs::recursive_directory_iterator(); at.increment(error))
        check(at->path());
    const bool theirs = fs::exists(to, error) && !(directory && fs::is_empty(to, error));
    if (theirs && !replace_ && !is_report(target_) && !(directory && is_report(to))) refuse(to);
}

void ReportFolder::publish(const std::string& part) {
    std::error_code error;
    fs::create_directories(target_, error);
    const fs::path to = target_ / part;
    check_free(to);
    // The old one is moved aside first: a folder can only take the name of an empty one.
    const fs::path old = staging_ / (part + ".old");
    if (fs::exists(to, error)) fs::rename(to, old, error);
    if (!error) fs::rename(staging_ / part, to, error);
    if (error) fail(to, error);
    fs::remove_all(old, error);
}

void ReportFolder::finish() {
    std::error_code error;
    if (!fs::exists(target_, error)) {
        fs::rename(staging_, target_, error);
        if (error) fail(target_, error);
        return;
    }
    for (const fs::directory_entry& entry : fs::directory_iterator(staging_))
        check_free(target_ / entry.path().filename());
    for (const fs::directory_entry& entry : fs::directory_iterator(staging_)) {
        const fs::path to = target_ / entry.path().filename();
        if (entry.is_directory()) fs::remove_all(to, error);
        fs::rename(entry.path(), to, error);
        if (error) fail(target_, error);
    }
}

std::string in_report(const Case& result, const std::string& file) {
    return result.folder.empty() ? file : result.folder + "/" + file;
}

void save_maps(const fs::path& report, Case& result) {
    if (result.comparison.flip_map.pixels.empty()) return;
    std::error_code error;
    fs::create_directories(report / result.folder, error);
    if (error) fail(report / result.folder, error);
    result.files["difference"] = in_report(result, "difference.png");
    result.files["flip"] = in_report(result, "flip.png");
    save_image(report / result.files["difference"],
               difference(result.test, result.reference, difference_gain));
    save_image(report / result.files["flip"], heat_map(result.comparison.flip_map));
}

}  // namespace penumbra::cli
