// A line -> words.
#pragma once

#include "penumbra/math.h"

#include <string>
#include <string_view>

namespace penumbra::obj {

std::string_view trim(std::string_view text);

/// Takes the next word off the front of `text`; empty at the end.
std::string_view next_word(std::string_view& text);

/// The text before a '#', but for that of "1.#IND", which some programs write for NaN.
std::string_view without_comment(std::string_view text);

/// The same for names, which may hold a '#' ("Material #25"): a comment begins with " # ".
std::string_view name_without_comment(std::string_view text);

enum class Word { number, not_finite, other };

/// What `word` is, by the grammar that tinyobjloader reads rightly.
Word kind_of(std::string_view word);

/// A name and where it stands.
struct Named {
    std::string name = {};
    Index line = 0;
};

}  // namespace penumbra::obj
