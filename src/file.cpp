#include "file.h"

#include "memory.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <string>
#include <system_error>

namespace penumbra {
namespace {

// Closes on every way out.
struct Descriptor {
    int number = -1;
    explicit Descriptor(int opened) : number(opened) {}
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    ~Descriptor() {
        if (number >= 0) ::close(number);
    }
};

[[noreturn]] void fail_input(const std::filesystem::path& file, int error) {
    throw Error(Failure::input, file.string(),
                error == ENOENT ? "no such file" : system_reason(error));
}

[[noreturn]] void fail_output(const std::filesystem::path& file, int error) {
    std::error_code ignored;
    const bool homeless = error == ENOENT && file.has_parent_path() &&
                          !std::filesystem::exists(file.parent_path(), ignored);
    throw Error(Failure::output, file.string(),
                homeless ? "its folder does not exist" : "cannot write: " + system_reason(error));
}

// Bytes of Buffer (string or vector) are read straight into place.
template <class Buffer>
Buffer read_descriptor(int in, const std::filesystem::path& file, std::uintmax_t max) {
    struct stat status {};
    if (::fstat(in, &status) != 0) fail_input(file, errno);
    if (S_ISDIR(status.st_mode)) throw Error(Failure::input, file.string(), "is a folder");
    if (!S_ISREG(status.st_mode))
        throw Error(Failure::input, file.string(), "is not a regular file");
    const auto size = std::uintmax_t(status.st_size);
    if (size > max)
        throw Error(Failure::input, file.string(),
                    "has " + std::to_string(size) + " bytes, more than the " + std::to_string(max) +
                        " that are read");

    const MemoryClaim claim(std::size_t(size), file.string());
    Buffer content(std::size_t(size), typename Buffer::value_type{});
    std::size_t done = 0;
    while (done < content.size()) {
        const ssize_t n = ::read(in, content.data() + done, content.size() - done);
        if (n < 0 && errno == EINTR) continue;
        if (n < 0) fail_input(file, errno);
        if (n == 0) break;  // it shrank meanwhile
        done += std::size_t(n);
    }
    content.resize(done);
    return content;
}

template <class Buffer>
Buffer read_whole(const std::filesystem::path& file, std::uintmax_t max) {
    // Without O_NONBLOCK opening a FIFO would wait for its writer.
    const Descriptor in(::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
    if (in.number < 0) fail_input(file, errno);
    return read_descriptor<Buffer>(in.number, file, max);
}

int flush(int out) { return ::fsync(out) == 0 || errno == EINVAL || errno == EROFS ? 0 : errno; }

// What `from` holds, from its beginning.
int copy_all(int from, int to) {
    if (::lseek(from, 0, SEEK_SET) != 0) return errno;
    std::vector<std::byte> buffer(std::size_t(1) << 16);
    for (;;) {
        const ssize_t n = ::read(from, buffer.data(), buffer.size());
        if (n < 0 && errno == EINTR) continue;
        if (n < 0) return errno;
        if (n == 0) return 0;
        if (const int error = write_all(to, std::span(buffer).first(std::size_t(n)))) return error;
    }
}

std::string name_beside(const std::filesystem::path& target) {
    static std::atomic<unsigned> count = 0;
    return target.string() + "." + std::to_string(::getpid()) + "-" + std::to_string(++count) +
           ".tmp";
}

// A file that has no name yet, so that even a killed process leaves nothing; where the file system
// has no such files, one with a name of its own.
struct NewFile {
    std::string name;  // empty: none yet
    int number = -1;

    explicit NewFile(const std::filesystem::path& target) {
        const std::filesystem::path folder = target.has_parent_path() ? target.parent_path() : ".";
        if (::access("/proc/self/fd", X_OK) == 0)  // which gives it its name later
            number = ::open(folder.c_str(), O_RDWR | O_TMPFILE | O_CLOEXEC, 0666);
        if (number >= 0) return;
        do {
            name = name_beside(target);
            number = ::open(name.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        } while (number < 0 && errno == EEXIST);
        if (number < 0) name.clear();
    }
    NewFile(const NewFile&) = delete;
    NewFile& operator=(const NewFile&) = delete;
    ~NewFile() {
        if (number >= 0) ::close(number);
        if (!name.empty()) ::unlink(name.c_str());
    }

    // Takes the place of `target`; returns the system's error.
    int rename_to(const std::filesystem::path& target) {
        const std::string self = "/proc/self/fd/" + std::to_string(number);
        while (name.empty()) {
            const std::string beside = name_beside(target);
            if (::linkat(AT_FDCWD, self.c_str(), AT_FDCWD, beside.c_str(), AT_SYMLINK_FOLLOW) == 0)
                name = beside;
            else if (errno != EEXIST)
                return errno;
        }
        if (::rename(name.c_str(), target.c_str()) != 0) return errno;
        name.clear();
        return 0;
    }
};

}  // namespace

std::string system_reason(int error) {
    std::string text = std::generic_category().message(error);
    if (text.size() > 1 && text[0] >= 'A' && text[0] <= 'Z' && text[1] >= 'a' && text[1] <= 'z')
        text[0] = char(text[0] - 'A' + 'a');
    return text;
}

void remove_stale(const std::filesystem::path& folder, const std::string& prefix) {
    namespace fs = std::filesystem;
    std::error_code error;
    std::vector<fs::path> stale;
    fs::directory_iterator at(folder.empty() ? "." : folder, error);
    for (; !error && at != fs::directory_iterator(); at.increment(error)) {
        const std::string name = at->path().filename().string();
        if (!name.starts_with(prefix) || !name.ends_with(".tmp")) continue;
        pid_t process = 0;
        const char* const end = name.data() + name.size() - 4;
        auto [stop, wrong] = std::from_chars(name.data() + prefix.size(), end, process);
        if (wrong != std::errc{} || process <= 0) continue;
        unsigned count = 0;
        if (stop != end && *stop == '-') stop = std::from_chars(stop + 1, end, count).ptr;
        if (stop == end && ::kill(process, 0) != 0 && errno == ESRCH) stale.push_back(at->path());
    }
    for (const fs::path& path : stale) fs::remove_all(path, error);
}

std::string read_text(const std::filesystem::path& file, std::uintmax_t max) {
    return read_whole<std::string>(file, max);
}

std::vector<std::byte> read_bytes(const std::filesystem::path& file, std::uintmax_t max) {
    return read_whole<std::vector<std::byte>>(file, max);
}

std::vector<std::byte> read_open(int descriptor, const std::filesystem::path& file,
                                 std::uintmax_t max) {
    return read_descriptor<std::vector<std::byte>>(descriptor, file, max);
}

int write_all(int out, std::span<const std::byte> content) {
    while (!content.empty()) {
        const ssize_t n = ::write(out, content.data(), content.size());
        if (n < 0 && errno == EINTR) continue;
        if (n < 0) return errno;
        content = content.subspan(std::size_t(n));
    }
    return 0;
}

struct StagedFile::Parts {
    std::filesystem::path file;    // as the caller wrote it
    std::filesystem::path target;  // empty: a device or pipe, which cannot be replaced
    NewFile out;
};

StagedFile::StagedFile(const std::filesystem::path& file) {
    std::error_code ignored;
    if (std::filesystem::is_directory(file, ignored))
        throw Error(Failure::output, file.string(), "cannot write: is a folder");
    const bool special =
        std::filesystem::exists(file, ignored) && !std::filesystem::is_regular_file(file, ignored);
    // Through a symbolic link the file it points to is replaced, not the link.
    std::filesystem::path target = std::filesystem::is_symlink(file, ignored)
                                       ? std::filesystem::weakly_canonical(file, ignored)
                                       : file;
    const auto beside =
        special ? std::filesystem::temp_directory_path(ignored) / "penumbra" : target;
    if (special) target.clear();
    parts = std::unique_ptr<Parts>(new Parts{file, target, NewFile(beside)});
    if (parts->out.number < 0) fail_output(special ? beside : file, errno);
}

StagedFile::~StagedFile() = default;

int StagedFile::descriptor() const { return parts->out.number; }

void StagedFile::write(std::span<const std::byte> content) {
    if (const int error = write_all(descriptor(), content)) fail_output(parts->file, error);
}

void StagedFile::commit() {
    int error = 0;
    if (parts->target.empty()) {
        const Descriptor out(::open(parts->file.c_str(), O_WRONLY | O_CLOEXEC));
        error = out.number < 0 ? errno : copy_all(descriptor(), out.number);
    } else {
        remove_stale(parts->target.parent_path(), parts->target.filename().string() + ".");
        error = flush(descriptor());
        if (error == 0) error = parts->out.rename_to(parts->target);
    }
    if (error != 0) fail_output(parts->file, error);
}

void write_file(const std::filesystem::path& file, std::span<const std::byte> content) {
    StagedFile out(file);
    out.write(content);
    out.commit();
}

void write_file(const std::filesystem::path& file, std::string_view content) {
    write_file(file, std::as_bytes(std::span(content.data(), content.size())));
}

}  // namespace penumbra
