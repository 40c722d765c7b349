// Accessors -> numbers.
#pragma once

#include "penumbra/math.h"

#include <cstddef>
#include <span>

namespace tinygltf {
struct Accessor;
}

namespace penumbra::gltf {

struct Document;

/// Some elements of an accessor: [first, first + count), or those that are chosen.
struct Elements {
    std::size_t first = 0, count = 0;
    std::span<const Index> chosen = {};  ///< `count` of them, ascending; empty: all of the range

    /// The number of the i-th of them in the accessor.
    std::size_t operator[](std::size_t i) const {
        return chosen.empty() ? first + i : std::size_t(chosen[i]);
    }
    /// `length` of them from the `start`-th on.
    Elements part(std::size_t start, std::size_t length) const {
        return {.first = first + start,
                .count = length,
                .chosen = chosen.empty() ? chosen : chosen.subspan(start, length)};
    }
};

/// Writes the first `width` components of each element as floats, one element after the other.
/// Integers are normalised if the accessor says so. Throws Error (input) where a float is not
/// finite or a buffer has no content. Precondition: range and width fit the accessor.
void read_floats(const Document& document, int accessor, const Elements& range, int width,
                 float* out);

/// The same in double, so that nothing is lost of accessors of doubles.
void read_doubles(const Document& document, int accessor, const Elements& range, int width,
                  double* out);

/// As read_floats(), for what can do without some numbers: those that are not finite stay.
void read_any_floats(const Document& document, int accessor, const Elements& range, int width,
                     float* out);

/// Writes all elements of a SCALAR accessor of unsigned integers. Throws Error (input).
void read_indices(const Document& document, int accessor, Index* out);

/// Number of components of the accessor's type.
int components(const tinygltf::Accessor& accessor);

}  // namespace penumbra::gltf
