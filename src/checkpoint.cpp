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

// Before every piece. A piece is only as good as its sum: a process may be killed, and a disk fill
// up, while it is being written.
struct Piece {
    std::uint64_t size = 0;
    std::uint64_t sum = 0;
};

constexpr std::string_view magic = "penumbra checkpoint 1 ";

// Four lanes of FNV-1a by words: as fast as memory, where a CRC would cost more than the rest.
std::uint64_t sum_of(std::span<const std::byte> bytes) {
    std::array<std::uint64_t, 4> lanes = {1, 2, 3, 4}, words = {};
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

Checkpoint::Checkpoint(std::filesystem::path name, const std::string& identity)
    : file(std::move(name)), head(std::string(magic) + identity + "\n") {}

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

bool Checkpoint::restore(const std::function<void(std::span<const std::byte>)>& take) {
    std::error_code ignored;
    if (!std::filesystem::exists(file, ignored)) return true;
    if (!open_locked()) return false;
    std::vector<std::byte> bytes(head.size());
    if (!read(bytes) || std::memcmp(bytes.data(), head.data(), head.size()) != 0) {
        close();
        return false;
    }
    struct stat status {};
    ::fstat(descriptor, &status);
    off_t good = off_t(head.size());
    Piece piece;
    while (read(std::as_writable_bytes(std::span(&piece, 1)))) {
        const auto end = std::uint64_t(good) + sizeof piece + piece.size;
        if (piece.size > std::uint64_t(status.st_size) || end > std::uint64_t(status.st_size))
            break;
        bytes.resize(piece.size);
        if (!read(bytes) || sum_of(bytes) != piece.sum) break;
        take(bytes);
        good = off_t(end);
    }
    if (::ftruncate(descriptor, good) != 0 || ::lseek(descriptor, good, SEEK_SET) != good) remove();
    return true;
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

bool Checkpoint::append(std::span<const std::byte> samples) {
    if (failed) return false;
    const Piece piece = {.size = samples.size(), .sum = sum_of(samples)};
    const bool open = descriptor >= 0 || begin();
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
    Checkpoint old(file, "");
    if (!old.open_locked()) return;
    if (old.is_ours()) old.remove();
}

void Checkpoint::remove() {
    std::error_code ignored;
    if (descriptor >= 0) std::filesystem::remove(file, ignored);
    close();
}

}  // namespace penumbra
