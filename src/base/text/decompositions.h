// The tables behind decomposed().
#pragma once

#include <span>

namespace penumbra {

/// A character, and the one or two (else 0) that it is canonically made of; by the first,
/// ascending.
std::span<const char16_t> decomposition_pairs();

/// The first and the last of characters of one combining class, and that; ascending.
std::span<const char16_t> combining_runs();

}  // namespace penumbra
