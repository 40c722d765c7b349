#include "model_folders.h"

#include "file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <optional>
#include <system_error>
#include <utility>

namespace penumbra {

namespace {

namespace fs = std::filesystem;

// Closes on every way out.
class Opened {
  public:
    explicit Opened(int descriptor) : number(descriptor) {}
    Opened(Opened&& other) noexcept : number(std::exchange(other.number, -1)) {}
    Opened& operator=(Opened&& other) noexcept {
        std::swap(number, other.number);
        return *this;
    }
    ~Opened() {
        if (number >= 0) ::close(number);
    }
    int get() const { return number; }

  private:
    int number;
};

// A file without links on the way to it.
struct Located {
    fs::path folder = {};  // an allowed one
    fs::path way = {};     // from there
};

// Where `file` is or would be, without links; none where a link leads to nothing or in a circle.
std::optional<fs::path> destination(const fs::path& file) {
    std::error_code error;
    const fs::path full = fs::weakly_canonical(fs::absolute(file), error);
    if (error == std::errc::too_many_symbolic_link_levels) return std::nullopt;
    // Too long, or in a folder that is closed: opening it will fail, and tell why.
    if (error) return fs::absolute(file).lexically_normal();
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
    std::vector<fs::path> tops = {folders.own.empty() ? fs::path(".") : folders.own};
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
Opened open_located(const Located& located, const fs::path& file) {
    Opened at(::open(located.folder.c_str(), O_PATH | O_DIRECTORY | O_CLOEXEC));
    if (at.get() < 0) fail(file, errno);
    for (auto step = located.way.begin(); step != located.way.end(); ++step) {
        if (std::next(step) != located.way.end()) {
            at = Opened(
                ::openat(at.get(), step->c_str(), O_PATH | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC));
            if (at.get() < 0) fail(file, errno);
            continue;
        }
        struct stat status {};
        if (::fstatat(at.get(), step->c_str(), &status, AT_SYMLINK_NOFOLLOW) != 0)
            fail(file, errno);
        if (!S_ISREG(status.st_mode) && !S_ISDIR(status.st_mode))
            throw Error(Failure::input, file.string(), "is not a regular file");
        at = Opened(::openat(at.get(), step->c_str(),
                             O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_NOCTTY | O_CLOEXEC));
        if (at.get() < 0) fail(file, errno);
    }
    return at;
}

}  // namespace

bool may_read(const ModelFolders& folders, const fs::path& file) {
    return locate(folders, file).has_value();
}

std::vector<std::byte> read_allowed(const ModelFolders& folders, const fs::path& file,
                                    std::uintmax_t max) {
    const std::optional<Located> located = locate(folders, file);
    if (!located)
        throw Error(Failure::input, file.string(),
                    fmt::format("lies outside the model's folder {}", how_to_allow));
    return read_open(open_located(*located, file).get(), file, max);
}

}  // namespace penumbra
