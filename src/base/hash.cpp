#include "base/hash.h"

#include <fmt/format.h>
#include <xxhash.h>

#include <new>

namespace penumbra {

namespace {

XXH3_state_t* state_in(void* bytes) { return std::launder(static_cast<XXH3_state_t*>(bytes)); }
const XXH3_state_t* state_in(const void* bytes) {
    return std::launder(static_cast<const XXH3_state_t*>(bytes));
}

}  // namespace

std::string text_of(const Digest& digest) {
    return fmt::format("{:016x}{:016x}", digest.high, digest.low);
}

std::uint64_t hash_of(std::span<const std::byte> bytes) {
    return XXH3_64bits(bytes.data(), bytes.size());
}

Hash::Hash() {
    static_assert(sizeof(XXH3_state_t) == sizeof state_ && alignof(XXH3_state_t) <= 64);
    static_assert(std::is_trivially_copyable_v<XXH3_state_t>);
    XXH3_128bits_reset(new (state_.data()) XXH3_state_t);
}

void Hash::add(std::span<const std::byte> bytes) {
    if (!bytes.empty()) XXH3_128bits_update(state_in(state_.data()), bytes.data(), bytes.size());
}

void Hash::add(std::string_view text) {
    add(text.size());
    add(std::as_bytes(std::span(text)));
}

Digest Hash::digest() const {
    const XXH128_hash_t hash = XXH3_128bits_digest(state_in(state_.data()));
    return {hash.high64, hash.low64};
}

}  // namespace penumbra
