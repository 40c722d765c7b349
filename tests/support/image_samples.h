// Bytes and samples of pictures.
#pragma once

#include "support/support.h"

#include "penumbra/image.h"

#include <cstring>
#include <initializer_list>
#include <span>
#include <string>
#include <vector>

namespace test {

using namespace penumbra;

using Bytes = std::vector<std::byte>;
using Values = std::vector<int>;

inline Bytes bytes(std::initializer_list<int> values) {
    Bytes result;
    for (const int value : values) result.push_back(std::byte(value));
    return result;
}

inline Bytes bytes(const std::string& text) {
    const auto view = std::as_bytes(std::span(text));
    return {view.begin(), view.end()};
}

inline Values samples(const Raster& raster) {
    Values values;
    for (std::size_t i = 0; i < raster.data.size(); i += std::size_t(raster.depth)) {
        std::uint16_t value = 0;
        std::memcpy(&value, &raster.data[i], std::size_t(raster.depth));
        values.push_back(value);
    }
    return values;
}

// Every value that 8 bits can hold, and some beyond them.
inline Image gradient() {
    Image image(32, 17);
    for (int y = 0; y < 17; ++y)
        for (int x = 0; x < 32; ++x)
            image.at(x, y) = Color(srgb_to_linear(float(x * 8) / 255), float(y) / 12 - 0.2F, 0.5F);
    return image;
}

}  // namespace test
