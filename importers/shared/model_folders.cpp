#include "importers/shared/model_folders.h"

#include "base/descriptor.h"
#include "base/file.h"

#include <fcntl.h>
#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <optional>
#include <system_error>

namespace penumbra {

namespace {

namespace fs = std::filesystem;

// A file without links on the way to it.
struct Located {
    fs::path folder = {};  // an allowed one
    fs::path way = {};     // from there
};

// Where `file` is or would be, without links; none where a link leads to nothing or in a circle.
std::optional<fs::path> destination(const fs::path& file) {
    std::error_code error;
    const fs::path absolute = fs::absolute(file, error);
    if (error) return std::nullopt;  // the current folder is gone
    fs::path full = fs::weakly_canonical(absolute, error);
    if (error == std::errc::too_many_symbolic_link_levels) return std::nullopt;
    // Too long, or in a folder that is closed: opening it will fail, and tell why.
    if (error) return absolute.lexically_normal();
    fs::path at;
    for (const fs::path& step : full) {
        at /= step;
        if (fs::is_symlink(fs::symlink_status(at, error))) return std::nullopt;
    }
    return full;
}

std::optional<Located> locate(const ModelFolders& folders, const fs::path& file) {
    const std::optional<fs::path> target = destination(file);
    if (!target) return std::nullopt;
    std::vector<fs::path> tops;
    if (folders.own_allowed) tops.push_back(folders.own.empty() ? fs::path(".") : folders.own);
    tops.insert(tops.end(), folders.allowed.begin(), folders.allowed.end());
    for (const fs::path& top : tops) {
        std::error_code error;
        const fs::path folder = fs::canonical(top, error);
        if (error) continue;
        const auto [end, rest] =
            std::mismatch(folder.begin(), folder.end(), target->begin(), target->end());
        if (end == folder.end()) return Located{folder, target->lexically_relative(folder)};
    }
    return std::nullopt;
}

[[noreturn]] void fail(const fs::path& file, int error) {
    if (error == ENOENT) throw Error(Failure::input, file.string(), "no such file");
    throw Error(Failure::input, file.string(), "cannot be opened: " + system_reason(error));
}

// Step by step and through no link. Devices are not opened, for that alone may do something.
Descriptor open_located(const Located& located, const fs::path& file) {
    Descriptor at(::open(located.folder.c_str(), O_PATH | O_DIRECTORY | O_CLOEXEC));
    if (!at) fail(file, errno);
    for (auto step = located.way.begin(); step != located.way.end(); ++step) {
        if (std::next(step) != located.way.end()) {
            at = Descriptor(
                ::openat(at.get(), step->c_str(), O_PATH | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC));
            if (!at) fail(file, errno);
            continue;
        }
        struct stat status{};
        if (::fstatat(at.get(), step->c_str(), &status, AT_SYMLINK_NOFOLLOW) != 0)
            fail(file, errno);
        if (!S_ISREG(status.st_mode) && !S_ISDIR(status.st_mode))
            throw Error(Failure::input, file.string(), "is not a regular file");
        at = Descriptor(::openat(at.get(), step->c_str(),
                                 O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_NOCTTY | O_CLOEXEC));
        if (!at) fail(file, errno);
    }
    return at;
}

}  // namespace

std::string ModelFolders::description() const {
    if (!own_allowed)
        return "the folders of ModelOptions::allowed_paths, which are all that a model in memory "
               "may read";
    return "the model's folder" + (how_to_allow.empty() ? "" : " (" + how_to_allow + ")");
}

ModelFolders folders_of(const fs::path& file, const ModelOptions& options) {
    return {.own = file.parent_path(),
            .allowed = options.allowed_paths,
            .how_to_allow = options.how_to_allow};
}

ModelFolders folders_in_memory(const fs::path& name, const ModelOptions& options) {
    ModelFolders folders = folders_of(name, options);
    folders.own_allowed = false;
    return folders;
}

bool may_read(const ModelFolders& folders, const fs::path& file) {
    return locate(folders, file).has_value();
}

std::vector<std::byte> read_allowed(const ModelFolders& folders, const fs::path& file,
                                    std::uintmax_t max) {
    const std::optional<Located> located = locate(folders, file);
    if (!located)
        throw Error(Failure::input, file.string(), "lies outside " + folders.description());
    return read_open(open_located(*located, file).get(), file, max);
}

}  // namespace penumbra
