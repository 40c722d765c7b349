// Bytes -> text in lines.
#pragma once

#include "base/text/text.h"

#include <string>
#include <string_view>
#include <vector>

namespace penumbra::obj {

/// `bytes` as UTF-8 with '\n' at line ends: byte order marks are dropped, UTF-16 is converted, and
/// what is not valid UTF-8 is taken as Latin-1. Lines that end in a backslash are joined, unless
/// that is the second byte of a Shift-JIS or GBK character; blank lines follow, so that line
/// numbers stay. Comment lines, which may end in a Windows path, are left alone.
std::string to_lines(std::string bytes);

/// `text`, or what it is as Latin-1 where it is not UTF-8.
std::string in_utf8(const std::string& text);

/// A name that was taken as Latin-1, in the encoding that it may have been in.
struct Decoded {
    const char* encoding = nullptr;
    std::string text = {};  ///< UTF-8
};

/// What `name`, in to_lines(), may be in other encodings: GBK, Shift-JIS, ... Empty where it is
/// ASCII or not Latin-1.
std::vector<Decoded> decodings(std::string_view name);

/// The bytes of a name in its encoding; empty where it has none of its characters.
std::string encoded(const Decoded& name);

/// The bytes that a name had which was taken as Latin-1; empty where it was not.
std::string as_bytes(std::string_view name);

/// `text` on one line: control characters become '?', what is beyond 60 bytes is cut.
inline std::string printable(std::string_view text) { return penumbra::printable(text, 60); }

}  // namespace penumbra::obj
