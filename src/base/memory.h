// Memory is asked for before it is taken: see penumbra/limits.h.
#pragma once

#include "penumbra/error.h"

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace penumbra {

/// There is not enough memory left. Where a part of a file is at fault it is not made a Loss, as
/// other errors are: what a picture shows must not depend on the machine.
struct MemoryError : Error {
    MemoryError(Failure kind, const std::string& place, const std::string& problem)
        : Error(kind, place, problem, Remedy::memory) {}
};

/// So many bytes may be taken while this lives. Once they are written to, they are found by looking
/// at the process, so that the claim may go.
class MemoryClaim {
  public:
    MemoryClaim() = default;
    /// Throws MemoryError (input) where the bytes are not left, without a limit where there can be
    /// no such number of them; "PLACE: needs 3.0 GB of memory, ...".
    MemoryClaim(std::size_t bytes, const std::string& place);
    ~MemoryClaim() { release(); }
    MemoryClaim(MemoryClaim&& other) noexcept : bytes_(other.bytes_) { other.bytes_ = 0; }
    MemoryClaim& operator=(MemoryClaim&& other) noexcept;

  private:
    std::size_t bytes_ = 0;
    void release() noexcept;
};

/// What the constructor of MemoryClaim asks, without a promise.
bool memory_is_left(std::size_t bytes) noexcept;

/// The product; the largest number where that is too large for one.
constexpr std::size_t times(std::size_t a, std::size_t b) {
    return b != 0 && a > std::size_t(-1) / b ? std::size_t(-1) : a * b;
}

/// "1.5 GB", in units of 1024.
std::string memory_text(std::size_t bytes);

/// Makes `values` have `count` elements, which are to be written to at once.
template <class T>
void resize_claimed(std::vector<T>& values, std::size_t count, const std::string& place) {
    const MemoryClaim claim(times(count, sizeof(T)), place);
    values.resize(count);
}

/// Makes room for another element of `values`, which grows beyond what was foreseen.
template <class T>
void make_room(std::vector<T>& values, const std::string& place) {
    if (values.size() < values.capacity()) return;
    const std::size_t count = values.size() < 8 ? 16 : 2 * values.size();
    const MemoryClaim claim(times(count, sizeof(T)), place);
    values.reserve(count);
}

/// `name`, cut to max_name bytes between two characters of UTF-8.
std::string kept_name(std::string_view name);

}  // namespace penumbra
