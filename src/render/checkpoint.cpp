#include "render/checkpoint.h"

#include "base/file.h"
#include "base/hash.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <utility>
#include <vector>

namespace penumbra {

namespace {

constexpr std::string_view any_magic = "penumbra checkpoint ";  // of any version
constexpr std::string_view magic = "penumbra checkpoint 4 ";

std::uint64_t sum_of(const RowRange& rows, std::span<const std::byte> bytes) {
    Hash sum;
    sum.add(rows.first);
    sum.add(rows.last);
    sum.add(bytes);
    return sum.digest().low;
}

}  // namespace

// Before the samples of some rows. They are only as good as their sum: a process may be killed, and
// a disk fill up, while they are being written.
struct Checkpoint::Piece {
    RowRange rows = {};
    std::uint64_t sum = 0;
};

Checkpoint::Checkpoint(std::filesystem::path name, const std::string& identity, std::size_t row,
                       int rows)
    : file_(std::move(name)), head_(std::string(magic) + identity + "\n"), row_size_(row),
      height_(rows) {}

// Two that render the same picture at once must not write into one file. The lock ends with the
// process.
bool Checkpoint::open_locked() {
    if (descriptor_) return true;
    descriptor_ =
        Descriptor(::open(file_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0666));
    struct stat status{};
    int problem = 0;
    if (descriptor_ && (::fstat(descriptor_.get(), &status) != 0 || !S_ISREG(status.st_mode)))
        problem = EINVAL;
    else if (descriptor_ && ::flock(descriptor_.get(), LOCK_EX | LOCK_NB) != 0)
        problem = errno;
    if (problem != 0) {
        descriptor_.close();
        errno = problem;
    }
    return bool(descriptor_);
}

bool Checkpoint::read(std::span<std::byte> to) const {
    while (!to.empty()) {
        const ssize_t n = ::read(descriptor_.get(), to.data(), to.size());
        if (n < 0 && errno == EINTR) continue;
        if (n <= 0) return false;
        to = to.subspan(std::size_t(n));
    }
    return true;
}

std::optional<Checkpoint::Piece> Checkpoint::read_piece(std::vector<std::byte>& samples) const {
    struct stat status{};
    Piece piece;
    if (::fstat(descriptor_.get(), &status) != 0 ||
        !read(std::as_writable_bytes(std::span(&piece, 1))))
        return std::nullopt;
    const RowRange& rows = piece.rows;
    if (rows.first < 0 || rows.first % render_band != 0 || rows.last <= rows.first ||
        rows.last > height_)
        return std::nullopt;
    const std::size_t size = std::size_t(rows.last - rows.first) * row_size_;
    if (size > std::size_t(status.st_size)) return std::nullopt;  // before there is room for it
    samples.resize(size);
    if (!read(samples) || sum_of(rows, samples) != piece.sum) return std::nullopt;
    return piece;
}

std::string Checkpoint::first_line() const {
    std::string text(std::size_t(1) << 12, '\0');
    const ssize_t n = ::pread(descriptor_.get(), text.data(), text.size(), 0);
    text.resize(std::size_t(std::max(n, ssize_t(0))));
    return text.substr(0, text.find('\n') + 1);
}

Checkpoint::Found Checkpoint::open() {
    std::error_code ignored;
    if (!std::filesystem::exists(file_, ignored)) return {};
    if (!open_locked())
        return {.kind = errno == EWOULDBLOCK ? Found::Kind::in_use : Found::Kind::foreign};
    const std::string line = first_line();
    if (line == head_ && ::lseek(descriptor_.get(), off_t(head_.size()), SEEK_SET) > 0) {
        std::vector<std::byte> samples;
        if (const auto first = read_piece(samples)) next_ = first->rows.first;
        return {.kind = Found::Kind::rows, .first = next_};
    }
    descriptor_.close();
    // Whoever was killed while writing its first line has left nothing to be lost.
    if (line.empty()) return {};
    if (!line.starts_with(any_magic)) return {.kind = Found::Kind::foreign};
    Found other = {.kind = Found::Kind::other};
    if (line.starts_with(magic))
        other.identity = line.substr(magic.size(), line.size() - magic.size() - 1);
    return other;
}

void Checkpoint::restore(const std::function<void(std::span<const std::byte>)>& take) {
    auto good = off_t(head_.size());
    if (!descriptor_ || ::lseek(descriptor_.get(), good, SEEK_SET) != good) return;
    std::vector<std::byte> samples;
    while (const auto piece = read_piece(samples)) {
        if (piece->rows.first != next_) break;
        take(samples);
        next_ = piece->rows.last;
        good += off_t(sizeof(Piece) + samples.size());
    }
    if (::ftruncate(descriptor_.get(), good) != 0 ||
        ::lseek(descriptor_.get(), good, SEEK_SET) != good)
        remove();
}

bool Checkpoint::is_ours() const {
    struct stat status{};
    if (::fstat(descriptor_.get(), &status) != 0 || ::lseek(descriptor_.get(), 0, SEEK_SET) != 0)
        return false;
    std::string begin(magic.size(), ' ');
    return status.st_size == 0 ||
           (read(std::as_writable_bytes(std::span(begin))) && begin == magic);
}

bool Checkpoint::begin() {
    return open_locked() && is_ours() && ::ftruncate(descriptor_.get(), 0) == 0 &&
           ::lseek(descriptor_.get(), 0, SEEK_SET) == 0 &&
           write_all(descriptor_.get(), std::as_bytes(std::span(head_))) == 0;
}

bool Checkpoint::append(const RowRange& rows, std::span<const std::byte> samples) {
    if (failed_) return false;
    const Piece piece = {.rows = rows, .sum = sum_of(rows, samples)};
    const bool open = (descriptor_ && rows.first == next_) || begin();
    next_ = rows.last;
    if (open && write_all(descriptor_.get(), std::as_bytes(std::span(&piece, 1))) == 0 &&
        write_all(descriptor_.get(), samples) == 0)
        return true;
    failed_ = true;
    if (open) remove();
    descriptor_.close();
    return false;
}

void Checkpoint::remove_stale(const std::filesystem::path& file) {
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(file, ignored)) return;
    Checkpoint old(file, "", 0, 0);
    if (!old.open_locked()) return;
    if (old.is_ours()) old.remove();
}

void Checkpoint::remove() {
    std::error_code ignored;
    if (descriptor_) std::filesystem::remove(file_, ignored);
    descriptor_.close();
}

}  // namespace penumbra
