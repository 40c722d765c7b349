// Text that others wrote, made safe for JSON, XML and HTML.
#pragma once

#include "penumbra/compare.h"

#include <cstddef>
#include <span>
#include <string>

namespace penumbra::markup {

/// `text` as valid UTF-8 without the control characters that XML forbids; each broken byte or
/// forbidden character becomes U+FFFD.
std::string clean(const std::string& text);

/// `text`, cleaned, for XML and HTML content and quoted attributes.
std::string escaped(const std::string& text);

/// A relative path as the value of an href: percent-encoded, never with a scheme.
std::string link(const std::string& path);

/// Bytes as a data: URI of a PNG.
std::string png_uri(std::span<const std::byte> png);

/// `value` in at most `digits` significant digits; an en dash for NaN.
std::string number(double value, int digits = 6);

/// A metric's value in as many digits as it takes to tell it from its limit and from 1.
std::string number(const Metric& metric);

}  // namespace penumbra::markup
