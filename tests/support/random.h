// Random numbers, the same ones in every run.
#pragma once

#include "penumbra/math.h"

#include <random>

namespace test {

struct Random {
    std::mt19937 engine{20260};
    double operator()(double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(engine);
    }
    penumbra::Vec3 vector(double size) {
        return {(*this)(-size, size), (*this)(-size, size), (*this)(-size, size)};
    }
};

}  // namespace test
