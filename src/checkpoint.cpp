#include "checkpoint.h"

#include "file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <utility>
#include <vector>

namespace penumbra {

namespace {

constexpr std::string_view magic = "penumbra checkpoint 2 ";

// Four lanes of FNV-1a by words: as fast as memory, where a CRC would cost more than the rest.
std::uint64_t sum_of(const RowRange& rows, std::span<const std::byte> bytes) {
    std::array<std::uint64_t, 4> lanes = {1, 2, std::uint64_t(rows.first),
                                          std::uint64_t(rows.last)},
                                 words = {};
    const auto mix = [&] {
        for (std::size_t i = 0; i < lanes.size(); ++i)
            lanes[i] = (lanes[i] ^ words[i]) * 0x100000001b3U;
    };
    for (; bytes.size() >= sizeof words; bytes = bytes.subspan(sizeof words)) {
        std::memcpy(words.data(), bytes.data(), sizeof words);
        mix();
    }
    words = {};
    if (!bytes.empty()) std::memcpy(words.data(), bytes.data(), bytes.size());
    mix();
    std::uint64_t sum = 0;
    for (const std::uint64_t lane : lanes) sum = (sum ^ lane ^ (lane >> 29U)) * 0x100000001b3U;
    return sum;
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
    : file(std::move(name)), head(std::string(magic) + identity + "\n"), row_size(row),
      height(rows) {}

Checkpoint::~Checkpoint() { close(); }

void Checkpoint::close() {
    if (descriptor >= 0) ::close(descriptor);
    descriptor = -1;
}

// Two that render the same picture at once must not write into one file. The lock ends with the
// process.
bool Checkpoint::open_locked() {
    if (descriptor >= 0) return true;
    descriptor = ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0666);
    struct stat status {};
    if (descriptor >= 0 && (::fstat(descriptor, &status) != 0 || !S_ISREG(status.st_mode) ||
                            ::flock(descriptor, LOCK_EX | LOCK_NB) != 0))
        close();
    return descriptor >= 0;
}

bool Checkpoint::read(std::span<std::byte> to) const {
    while (!to.empty()) {
        const ssize_t n = ::read(descriptor, to.data(), to.size());
        if (n < 0 && errno == EINTR) continue;
        if (n <= 0) return false;
        to = to.subspan(std::size_t(n));
    }
    return true;
}

std::optional<Checkpoint::Piece> Checkpoint::read_piece(std::vector<std::byte>& samples) const {
    struct stat status {};
    Piece piece;
    if (::fstat(descriptor, &status) != 0 || !read(std::as_writable_bytes(std::span(&piece, 1))))
        return std::nullopt;
    const RowRange& rows = piece.rows;
    if (rows.first < 0 || rows.first % render_band != 0 || rows.last <= rows.first ||
        rows.last > height)
        return std::nullopt;
    const std::size_t size = std::size_t(rows.last - rows.first) * row_size;
    if (size > std::size_t(status.st_size)) return std::nullopt;  // before there is room for it
    samples.resize(size);
    if (!read(samples) || sum_of(rows, samples) != piece.sum) return std::nullopt;
    return piece;
}

std::optional<int> Checkpoint::open() {
    std::error_code ignored;
    if (!std::filesystem::exists(file, ignored)) return 0;
    if (!open_locked()) return std::nullopt;
    std::vector<std::byte> bytes(head.size());
    if (!read(bytes) || std::memcmp(bytes.data(), head.data(), head.size()) != 0) {
        close();
        return std::nullopt;
    }
    if (const auto first = read_piece(bytes)) next = first->rows.first;
    return next;
}

void Checkpoint::restore(const std::function<void(std::span<const std::byte>)>& take) {
    auto good = off_t(head.size());
    if (descriptor < 0 || ::lseek(descriptor, good, SEEK_SET) != good) return;
    std::vector<std::byte> samples;
    while (const auto piece = read_piece(samples)) {
        if (piece->rows.first != next) break;
        take(samples);
        next = piece->rows.last;
        good += off_t(sizeof(Piece) + samples.size());
    }
    if (::ftruncate(descriptor, good) != 0 || ::lseek(descriptor, good, SEEK_SET) != good) remove();
}

bool Checkpoint::is_ours() const {
    struct stat status {};
    if (::fstat(descriptor, &status) != 0 || ::lseek(descriptor, 0, SEEK_SET) != 0) return false;
    std::string begin(magic.size(), ' ');
    return status.st_size == 0 ||
           (read(std::as_writable_bytes(std::span(begin))) && begin == magic);
}

bool Checkpoint::begin() {
    return open_locked() && is_ours() && ::ftruncate(descriptor, 0) == 0 &&
           ::lseek(descriptor, 0, SEEK_SET) == 0 &&
           write_all(descriptor, std::as_bytes(std::span(head))) == 0;
}

bool Checkpoint::append(const RowRange& rows, std::span<const std::byte> samples) {
    if (failed) return false;
    const Piece piece = {.rows = rows, .sum = sum_of(rows, samples)};
    const bool open = (descriptor >= 0 && rows.first == next) || begin();
    next = rows.last;
    if (open && write_all(descriptor, std::as_bytes(std::span(&piece, 1))) == 0 &&
        write_all(descriptor, samples) == 0)
        return true;
    failed = true;
    if (open) remove();
    close();
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
    if (descriptor >= 0) std::filesystem::remove(file, ignored);
    close();
}

}  // namespace penumbra
