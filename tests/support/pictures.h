// Small pictures that tests compare.
#pragma once

#include "penumbra/image.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace test {

using penumbra::Color;
using penumbra::Image;

inline Image constant(int w, int h, const Color& color) {
    Image image(w, h);
    std::ranges::fill(image.pixels, color);
    return image;
}

// A bright disc on black: something with an inside, an outside and an edge.
inline Image disc(int w, int h, const Color& color = {0.5F, 0.3F, 0.1F}) {
    Image image(w, h);
    for (int y = 0; y < h; ++y)
        for (int x = 0; x < w; ++x)
            if (std::hypot(x - w / 2.2, y - h / 2.5) < h / 3.0)
                image.at(x, y) = color * (0.6F + 0.4F * float(x) / float(w));
    return image;
}

inline Image shifted(const Image& from, int dx, int dy) {
    Image to = from;
    for (int y = 0; y < to.height; ++y)
        for (int x = 0; x < to.width; ++x)
            to.at(x, y) =
                from.at(std::clamp(x - dx, 0, to.width - 1), std::clamp(y - dy, 0, to.height - 1));
    return to;
}

inline std::string joined(const std::vector<std::string>& sentences) {
    std::string result;
    for (const std::string& sentence : sentences) result += sentence + "\n";
    return result;
}

inline bool has(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

}  // namespace test
