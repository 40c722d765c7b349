#include "report_folder.h"

#include "file.h"
#include "interruption.h"
#include "steps.h"

#include "penumbra/error.h"
#include "penumbra/image.h"

#include <unistd.h>

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

[[noreturn]] void fail(const fs::path& folder, const std::error_code& error) {
    throw Error(Failure::output, folder.string(), "cannot write the report: " + error.message());
}

}  // namespace

void check_report(const fs::path& folder) {
    std::error_code ignored;
    const fs::path target = plain(folder);
    if (fs::exists(target, ignored) && !fs::is_directory(target, ignored))
        throw Error(Failure::output, folder.string(), "is not a folder");
    if (fs::is_directory(target, ignored))
        check_writable(target / "index.html");
    else
        check_writable(target);
}

ReportFolder::ReportFolder(const fs::path& final_name) : target(plain(final_name)) {
    const std::string prefix = "." + target.filename().string() + ".";
    remove_stale(target, prefix);
    remove_stale(target.parent_path(), prefix);
    const std::string name = prefix + std::to_string(::getpid());
    // In an existing folder, so that "--report ." works wherever "." is.
    std::error_code error;
    staging = fs::is_directory(target, error) ? target / (name + ".tmp")
                                              : target.parent_path() / (name + ".tmp");
    set_leftover(fs::absolute(staging, error));
    fs::create_directory(staging, error);
    if (error) fail(final_name, error);
}

ReportFolder::~ReportFolder() { remove_leftover(); }

std::string ReportFolder::with_final_names(std::string message) const {
    const std::string here = (staging / "").string();
    for (auto at = message.find(here); at != message.npos; at = message.find(here, at))
        message.replace(at, here.size(), (target / "").string());
    return message;
}

void ReportFolder::publish(const std::string& part) {
    std::error_code error;
    fs::create_directories(target, error);
    const fs::path to = target / part;
    // The old one is moved aside first: a folder can only take the name of an empty one.
    const fs::path old = staging / (part + ".old");
    if (fs::exists(to, error)) fs::rename(to, old, error);
    if (!error) fs::rename(staging / part, to, error);
    if (error) fail(to, error);
    fs::remove_all(old, error);
}

void ReportFolder::finish() {
    std::error_code error;
    if (!fs::exists(target, error)) {
        fs::rename(staging, target, error);
        if (error) fail(target, error);
        return;
    }
    for (const fs::directory_entry& entry : fs::directory_iterator(staging)) {
        const fs::path to = target / entry.path().filename();
        if (entry.is_directory()) fs::remove_all(to, error);
        fs::rename(entry.path(), to, error);
        if (error) fail(target, error);
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
