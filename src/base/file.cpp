#include "base/file.h"

#include "base/descriptor.h"
#include "base/memory.h"
#include "base/temporary.h"
#include "base/text/text.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <string>
#include <system_error>

namespace penumbra {
namespace {

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
    struct stat status{};
    if (::fstat(in, &status) != 0) fail_input(file, errno);
    if (S_ISDIR(status.st_mode)) throw Error(Failure::input, file.string(), "is a folder");
    if (!S_ISREG(status.st_mode))
        throw Error(Failure::input, file.string(), "is not a regular file");
    const auto size = std::uintmax_t(status.st_size);
    check_file_size(size, file, max);
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
    if (!in) fail_input(file, errno);
    return read_descriptor<Buffer>(in.get(), file, max);
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
    return target.string() + "." + process_mark() + "-" + std::to_string(++count) + ".tmp";
}

// A file that has no name yet, so that even a killed process leaves nothing; where the file system
// has no such files, one with a name of its own.
struct NewFile {
    std::string name;  // empty: none yet
    Descriptor out;

    explicit NewFile(const std::filesystem::path& target) {
        const std::filesystem::path folder = target.has_parent_path() ? target.parent_path() : ".";
        if (::access("/proc/self/fd", X_OK) == 0)  // which gives it its name later
            out = Descriptor(::open(folder.c_str(), O_RDWR | O_TMPFILE | O_CLOEXEC, 0666));
        if (out) return;
        do {
            name = name_beside(target);
            out = Descriptor(::open(name.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666));
        } while (!out && errno == EEXIST);
        if (!out) name.clear();
    }
    NewFile(const NewFile&) = delete;
    NewFile& operator=(const NewFile&) = delete;
    ~NewFile() {
        if (!name.empty()) ::unlink(name.c_str());
    }

    // Takes the place of `target`; returns the system's error.
    int rename_to(const std::filesystem::path& target) {
        const std::string self = "/proc/self/fd/" + std::to_string(out.get());
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
    if (text.size() > 1 && text[1] >= 'a' && text[1] <= 'z') text[0] = lower_case(text[0]);
    return text;
}

bool is_same_file(const std::filesystem::path& a, const std::filesystem::path& b) {
    std::error_code error;
    return std::filesystem::equivalent(a, b, error) && !error;
}

void check_not_input(const std::filesystem::path& file,
                     std::span<const std::filesystem::path> inputs) {
    for (const std::filesystem::path& input : inputs)
        if (is_same_file(file, input)) throw input_in_the_way(file);
}

Error input_in_the_way(const std::filesystem::path& file) {
    return {Failure::output, file.string(),
            "is one of the inputs, which are never overwritten; give what is written another name"};
}

void check_file_size(std::uintmax_t size, const std::filesystem::path& file, std::uintmax_t max) {
    if (size > max)
        throw Error(Failure::input, file.string(),
                    "has " + std::to_string(size) + " bytes, more than the " + std::to_string(max) +
                        " that are read");
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
    NewFile made;
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
    // NOLINTNEXTLINE(modernize-make-unique): an aggregate, which GCC 12 makes with braces alone
    parts_ = std::unique_ptr<Parts>(new Parts{file, target, NewFile(beside)});
    if (!parts_->made.out) fail_output(special ? beside : file, errno);
}

StagedFile::~StagedFile() = default;

int StagedFile::descriptor() const { return parts_->made.out.get(); }

void StagedFile::write(std::span<const std::byte> content) {
    if (const int error = write_all(descriptor(), content)) fail_output(parts_->file, error);
}

void StagedFile::commit() {
    int error = 0;
    if (parts_->target.empty()) {
        const Descriptor out(::open(parts_->file.c_str(), O_WRONLY | O_CLOEXEC));
        error = out ? copy_all(descriptor(), out.get()) : errno;
    } else {
        remove_stale(parts_->target.parent_path(), parts_->target.filename().string() + ".");
        error = flush(descriptor());
        if (error == 0) error = parts_->made.rename_to(parts_->target);
    }
    if (error != 0) fail_output(parts_->file, error);
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
