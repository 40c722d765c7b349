// The attribute codec of KHR_meshopt_compression, version 1 (its appendix A, mode 0).
#include "importers/gltf/document/compression.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

namespace penumbra::gltf {
namespace {

constexpr std::size_t group = 16, most_elements = 256;

// Bytes that are read from front to back; past the end it says so and gives zeros.
struct Stream {
    Bytes rest;
    bool ended = false;

    std::uint8_t byte() {
        if (rest.empty()) {
            ended = true;
            return 0;
        }
        const auto value = std::uint8_t(rest.front());
        rest = rest.subspan(1);
        return value;
    }
};

// Sixteen deltas of `bits` bits. All ones stand for a delta that follows as a whole byte.
void read_packed(Stream& stream, int bits, std::uint8_t* deltas) {
    const int each = 8 / bits, ones = (1 << bits) - 1;
    for (std::size_t i = 0; i < group; i += std::size_t(each)) {
        const int packed = stream.byte();
        for (int j = 0; j < each; ++j) {
            const int shift = bits == 1 ? j : 8 - bits * (j + 1);
            deltas[i + std::size_t(j)] = std::uint8_t(packed >> shift & ones);
        }
    }
    for (std::size_t i = 0; i < group; ++i)
        if (deltas[i] == ones) deltas[i] = stream.byte();
}

// The deltas of one byte of `count` elements; control 0 and 1 choose the bits of each group.
void read_deltas(Stream& stream, int control, std::size_t count, std::uint8_t* deltas) {
    const std::size_t groups = (count + group - 1) / group;
    if (control == 2) return;  // all zero
    if (control == 3) {
        for (std::size_t i = 0; i < count; ++i) deltas[i] = stream.byte();
        return;
    }
    std::array<std::uint8_t, most_elements / group / 4> header{};
    for (std::size_t i = 0; i < (groups + 3) / 4; ++i) header[i] = stream.byte();
    for (std::size_t g = 0; g < groups; ++g) {
        constexpr std::array<std::array<int, 4>, 2> lengths = {{{0, 1, 2, 4}, {1, 2, 4, 8}}};
        const int bits = lengths[std::size_t(control)][header[g / 4] >> (2 * (g % 4)) & 3];
        std::uint8_t* const to = deltas + g * group;
        if (bits == 8)
            std::generate_n(to, group, [&] { return stream.byte(); });
        else if (bits != 0)
            read_packed(stream, bits, to);
    }
}

template <class T>
T unzigzag(T value) {
    return T((value & 1) != 0 ? ~(value >> 1) : value >> 1);
}

template <class T>
T added(T before, T delta) {
    return T(before + unzigzag(delta));
}

// Applies `change(before, delta)` to the numbers of type T in a channel of four bytes.
template <class T, class Change>
void each_number(const std::uint8_t* before, const std::uint8_t* delta, std::uint8_t* out,
                 Change&& change) {
    for (std::size_t at = 0; at < 4; at += sizeof(T)) {
        T a, b;
        std::memcpy(&a, before + at, sizeof a);
        std::memcpy(&b, delta + at, sizeof b);
        const T sum = change(a, b);
        std::memcpy(out + at, &sum, sizeof sum);
    }
}

// Four bytes of an element from those of the one before it.
void undo_delta(int mode, const std::uint8_t* before, const std::uint8_t* delta,
                std::uint8_t* out) {
    switch (mode & 15) {
    case 0: return each_number<std::uint8_t>(before, delta, out, added<std::uint8_t>);
    case 1: return each_number<std::uint16_t>(before, delta, out, added<std::uint16_t>);
    default:
        return each_number<std::uint32_t>(
            before, delta, out,
            [&](std::uint32_t a, std::uint32_t b) { return a ^ std::rotr(b, mode >> 4); });
    }
}

bool valid(std::uint8_t mode) { return (mode & 15) == 2 || mode == 0 || mode == 1; }

}  // namespace

std::vector<std::byte> decode_vertices_v1(Bytes data, std::size_t count, std::size_t stride) {
    const std::size_t channels = stride / 4, tail = stride + channels;
    const std::size_t padded = std::max<std::size_t>(tail, 24);
    if (data.size() < 1 + padded) return {};
    const auto* const end = reinterpret_cast<const std::uint8_t*>(data.data() + data.size());
    const std::uint8_t* before = end - tail;  // the element that the first one differs from
    const std::uint8_t* const modes = end - channels;
    if (!std::all_of(modes, end, valid)) return {};

    Stream stream = {data.subspan(1, data.size() - 1 - padded)};
    std::vector<std::byte> bytes(count * stride);
    auto* out = reinterpret_cast<std::uint8_t*>(bytes.data());
    const std::size_t block = std::min((8192 / stride) & ~std::size_t(15), most_elements);
    std::vector<std::uint8_t> deltas(stride * most_elements);  // one byte of all elements, then on
    std::vector<std::uint8_t> controls(channels);
    for (std::size_t start = 0; start < count; start += block) {
        const std::size_t elements = std::min(block, count - start);
        std::fill(deltas.begin(), deltas.end(), std::uint8_t(0));
        for (std::uint8_t& control : controls) control = stream.byte();
        for (std::size_t k = 0; k < stride; ++k)
            read_deltas(stream, controls[k / 4] >> (2 * (k % 4)) & 3, elements,
                        deltas.data() + k * most_elements);
        if (stream.ended) return {};
        for (std::size_t i = 0; i < elements; ++i, before = out, out += stride)
            for (std::size_t c = 0; c < channels; ++c) {
                std::array<std::uint8_t, 4> delta;
                for (std::size_t k = 0; k < 4; ++k)
                    delta[k] = deltas[(4 * c + k) * most_elements + i];
                undo_delta(modes[c], before + 4 * c, delta.data(), out + 4 * c);
            }
    }
    if (!stream.rest.empty()) return {};
    return bytes;
}

}  // namespace penumbra::gltf
