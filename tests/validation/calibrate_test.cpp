#include "support/pictures.h"
#include "support/support.h"

#include "penumbra/compare.h"

#include <cmath>

using namespace penumbra;
using test::disc;
using test::shifted;

namespace {

// A comparison with these figures.
Comparison with(const std::vector<Metric>& metrics, Verdict verdict = Verdict::pass) {
    Comparison result;
    result.verdict = verdict;
    result.metrics = metrics;
    return result;
}

Metric least(const std::string& name, double value) { return {name, value, {}, true}; }
Metric most(const std::string& name, double value) { return {name, value, {}, false}; }

}  // namespace

TEST_CASE("Calibrated limits leave the worst pair its error and half of it more") {
    const Limits limits = calibrated_limits(
        {with({least("parity", 0.999), most("flip", 0.002), most("bias", -0.0004)}),
         with({least("parity", 0.998), most("flip", 0.001), most("bias", 0.0001)}, Verdict::fail)});
    CHECK(limits.limits.size() == 3);
    CHECK(limits.limits.at("parity") == Approx(0.997));
    CHECK(limits.limits.at("flip") == Approx(0.003));
    CHECK(limits.limits.at("bias") == Approx(0.0006));
    // Rounded away from the pairs, never towards them.
    CHECK(calibrated_limits({with({most("flip", 0.00123)})}, 1).limits.at("flip") ==
          Approx(0.0013));
    // No less than no pixel can be the same.
    CHECK(calibrated_limits({with({least("parity", 0.1)})}).limits.at("parity") == 0);
}

TEST_CASE("Calibrated limits know that decibels are a logarithm") {
    const auto ratio = [](double value, double margin) {
        return calibrated_limits({with({least("psnr_db", value)})}, margin).limits.at("psnr_db");
    };
    CHECK(ratio(50, 1) == Approx(50));
    CHECK(ratio(50, 2) == Approx(43.9));  // 50 - 6.02
    CHECK(ratio(999, 1) == Approx(100));  // equal pictures
}

TEST_CASE("Calibration leaves out pairs that cannot be compared") {
    const Limits limits = calibrated_limits({with({most("flip", 0.5)}, Verdict::not_comparable),
                                             with({most("flip", 0.5)}, Verdict::error)});
    CHECK(limits.limits.empty());
    CHECK(calibrated_limits({}).limits.empty());
}

TEST_CASE("Every pair that limits were calibrated with meets them") {
    const Image reference = disc(90, 70);
    Image brighter = reference, dotted = reference;
    for (Color& c : brighter.pixels) c *= 1.01F;
    for (int i = 0; i < 6; ++i) dotted.at(30 + i, 25).y += 0.1F;
    const std::vector<Image> tests = {reference, brighter, dotted};
    std::vector<Comparison> pairs;
    for (const Image& test : tests) pairs.push_back(compare(test, reference));
    CompareOptions options;
    options.limits = calibrated_limits(pairs, 1);
    CHECK(options.limits.limits.size() == 9);
    options.limits.warn_band = 0;
    for (const Image& test : tests)
        CHECK(compare(test, reference, options).verdict == Verdict::pass);
    CHECK(compare(shifted(reference, 1, 0), reference, options).verdict == Verdict::fail);
}
