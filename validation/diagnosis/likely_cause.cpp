// Where two pictures differ, and what would explain it as far as the pictures alone tell.
#include "validation/diagnosis/finding.h"
#include "validation/diagnosis/registration.h"
#include "validation/metrics/picture.h"

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numeric>
#include <optional>

namespace penumbra::metrics {
namespace {

// A picture as a supposition changes it, row by row: large ones are never there as a whole.
using ChangedRow = std::function<cv::Mat(int y)>;

// Encoded pictures are kept in 16 bits: half the memory, and 1/500 of the least step that counts.
constexpr double full = 65535;

cv::Mat all_encoded(const LinearRows& picture) {
    cv::Mat result(picture.height, picture.width, CV_16UC3);
    each_row(result.rows, [&](int y) {
        cv::Mat row = result.row(y);
        encoded(picture.row(y)).convertTo(row, CV_16U, full);
    });
    return result;
}

cv::Mat as_float(const cv::Mat& kept) {
    cv::Mat result;
    kept.convertTo(result, CV_32F, 1 / full);
    return result;
}

double mean_square_of_rows(const ChangedRow& changed, const cv::Mat& kept) {
    std::vector<double> sums(std::size_t(kept.rows));
    each_row(kept.rows, [&](int y) {
        sums[std::size_t(y)] = cv::norm(changed(y), as_float(kept.row(y)), cv::NORM_L2SQR);
    });
    return std::accumulate(sums.begin(), sums.end(), 0.0) /
           (kept.channels() * double(kept.total()));
}

// What the suppositions look at: linear and encoded, and how far apart the encoded ones are.
struct Evidence {
    LinearRows test, reference;
    cv::Mat a, b;
    double before = 0;

    cv::Mat row(int y) const { return as_float(a.row(y)); }
    cv::Mat reference_row(int y) const { return as_float(b.row(y)); }
    double left(const ChangedRow& changed) const { return left(changed, b); }
    double left(const ChangedRow& changed, const cv::Mat& other) const {
        return mean_square_of_rows(changed, other) / before;
    }
};

// ---- geometry ---------------------------------------------------------------------------------

// Never -0, which would show.
double to_half(double pixels) { return std::round(2 * pixels) / 2 + 0.0; }

// Of a displacement by whole pixels; over the part that both pictures show.
double left_by_shift(const Evidence& e, int dx, int dy) {
    const cv::Size size(e.a.cols - std::abs(dx), e.a.rows - std::abs(dy));
    const cv::Rect to({std::max(dx, 0), std::max(dy, 0)}, size);
    const cv::Rect from({std::max(-dx, 0), std::max(-dy, 0)}, size);
    // The same part of the picture without the displacement is what it is held against.
    const double before = mean_square(e.a(to), e.b(to));
    return before > 0 ? mean_square(e.a(to), e.b(from)) / before : 1;
}

Finding shift_by(double dx, double dy, double left) {
    return {left, "shift",
            fmt::format("the test picture is shifted by ({:+.2g}, {:+.2g}) pixels", dx, dy)};
}

// By whole pixels, within two.
Finding whole_shift(const Evidence& e) {
    Finding best;
    if (e.a.cols < 8 || e.a.rows < 8) return best;
    for (int dy = -2; dy <= 2; ++dy) {
        for (int dx = -2; dx <= 2; ++dx) {
            const double left = left_by_shift(e, dx, dy);
            if (left < best.left) best = shift_by(dx, dy, left);
        }
    }
    return best;
}

Finding fractional_shift(const Registration& found) {
    const double dx = to_half(found.motion.dx), dy = to_half(found.motion.dy);
    const double off = std::hypot(found.motion.dx - dx, found.motion.dy - dy);
    if (dx == 0 && dy == 0 && off < 0.15) return {};
    return off < 0.15 ? shift_by(dx, dy, found.left)
                      : shift_by(found.motion.dx, found.motion.dy, found.left);
}

Finding zoomed(const Registration& found) {
    const double percent = 100 * (1 / (1 - found.motion.zoom) - 1);
    return {found.left, "fov",
            fmt::format("the test picture shows everything {:.2g} % {}, as with another field of "
                        "view",
                        std::abs(percent), percent > 0 ? "larger" : "smaller")};
}

Finding rolled(const Registration& found) {
    const double angle = degrees(found.motion.roll);
    return {found.left, "roll",
            fmt::format("the test picture is turned by {:.2g} degrees {}", std::abs(angle),
                        angle > 0 ? "clockwise" : "counter-clockwise")};
}

// Motions by fractions of a pixel, each kind alone.
std::vector<Finding> motions(const Evidence& e) {
    // All at once leave no more than any of them.
    if (register_pictures(e.a, e.b, Moves::all).left > 0.4) return {};
    return {fractional_shift(register_pictures(e.a, e.b, Moves::shift)),
            zoomed(register_pictures(e.a, e.b, Moves::zoom)),
            rolled(register_pictures(e.a, e.b, Moves::roll))};
}

std::vector<Finding> turned(const Evidence& e) {
    const auto reversed = [](const cv::Mat& row) {
        cv::Mat result;
        cv::flip(row, result, 1);
        return result;
    };
    const int last = e.a.rows - 1;
    std::vector<Finding> result = {
        {e.left([&](int y) { return reversed(e.row(y)); }), "mirror",
         "the test picture is mirrored left to right"},
        {e.left([&](int y) { return e.row(last - y); }), "flip", "the test picture is upside down"},
        {e.left([&](int y) { return reversed(e.row(last - y)); }), "turn",
         "the test picture is turned by 180 degrees"}};
    if (e.a.cols != e.a.rows) return result;
    const auto column = [&](int x) { return as_float(e.a.col(x)).reshape(3, 1); };
    for (const bool clockwise : {true, false}) {
        const double left =
            e.left([&](int y) { return clockwise ? column(last - y) : reversed(column(y)); });
        result.push_back({left, "turn",
                          fmt::format("the test picture is turned by 90 degrees {}",
                                      clockwise ? "clockwise" : "counter-clockwise")});
    }
    return result;
}

// ---- colours ----------------------------------------------------------------------------------

Finding exchanged(const Evidence& e) {
    constexpr const char* names[] = {"red", "green", "blue"};
    Finding best;
    std::array<int, 3> order = {0, 1, 2};
    while (std::ranges::next_permutation(order).found) {
        const std::array<int, 6> pairs = {order[0], 0, order[1], 1, order[2], 2};
        const double left = e.left([&](int y) {
            const cv::Mat row = e.row(y);
            cv::Mat result(row.size(), row.type());
            cv::mixChannels(&row, 1, &result, 1, pairs.data(), 3);
            return result;
        });
        if (left >= best.left) continue;
        best = {left, "channels",
                fmt::format("the test picture has the channels {}, {}, {} where the reference has "
                            "red, green, blue",
                            names[std::ranges::find(order, 0) - order.begin()],
                            names[std::ranges::find(order, 1) - order.begin()],
                            names[std::ranges::find(order, 2) - order.begin()])};
        for (std::size_t kept = 0; kept < 3; ++kept)
            if (order[kept] == int(kept))
                best.sentence = fmt::format("{} and {} are exchanged", names[kept == 0 ? 1 : 0],
                                            names[kept == 2 ? 1 : 2]);
    }
    return best;
}

// The factor of a channel's linear values, or of all, that brings the test picture to the
// reference; of values that a display shows in both.
double gain_of(const Evidence& e, std::optional<int> channel) {
    double both = 0, own = 0;
    for (int y = 0; y < e.test.height; ++y) {
        const cv::Mat test = e.test.row(y), reference = e.reference.row(y);
        for (int x = 0; x < e.test.width; ++x) {
            for (int c = channel.value_or(0); c <= channel.value_or(2); ++c) {
                const double t = double(test.at<cv::Vec3f>(x)[c]);
                const double r = double(reference.at<cv::Vec3f>(x)[c]);
                if (t >= 1 || r >= 1) continue;
                both += t * r;
                own += t * t;
            }
        }
    }
    return both / own;
}

double left_by_gain(const Evidence& e, const std::array<double, 3>& gain) {
    const cv::Vec3f factors = {float(gain[0]), float(gain[1]), float(gain[2])};
    return e.left([&](int y) {
        cv::Mat scaled = e.test.row(y).clone();
        for (int x = 0; x < scaled.cols; ++x) {
            auto& color = scaled.at<cv::Vec3f>(x);
            color = color.mul(factors);
        }
        return encoded(scaled);
    });
}

bool sane(double gain) { return gain > 0 && std::isfinite(gain); }

Finding brighter(const Evidence& e) {
    const double gain = gain_of(e, std::nullopt);
    if (!sane(gain)) return {};
    const double percent = 100 * (1 / gain - 1);
    return {left_by_gain(e, {gain, gain, gain}), "gain",
            fmt::format("the test picture is {:.2g} % {} ({:+.2f} EV)", std::abs(percent),
                        percent > 0 ? "brighter" : "darker", -std::log2(gain))};
}

Finding tinted(const Evidence& e) {
    const std::array gain = {gain_of(e, 0), gain_of(e, 1), gain_of(e, 2)};
    if (!std::ranges::all_of(gain, sane)) return {};
    return {left_by_gain(e, gain), "tint",
            fmt::format("the reference has {:.3g}, {:.3g} and {:.3g} times the red, green and blue "
                        "of the test picture",
                        gain[0], gain[1], gain[2])};
}

float power(float value, double exponent) {
    return float(std::pow(double(std::clamp(value, 0.F, 1.F)), exponent));
}

// The encoded values as powers of one another.
Finding other_gamma(const Evidence& e) {
    double both = 0, own = 0;
    for (int y = 0; y < e.a.rows; ++y) {
        const cv::Mat test = e.row(y), reference = e.reference_row(y);
        const auto *const a = test.ptr<float>(), *const b = reference.ptr<float>();
        for (int x = 0; x < 3 * e.a.cols; ++x) {
            if (a[x] < 0.02F || b[x] < 0.02F || a[x] > 0.98F || b[x] > 0.98F) continue;
            // Errors of the logarithm count as those of the value.
            const double s = std::log(double(a[x])), t = std::log(double(b[x]));
            both += double(b[x] * b[x]) * s * t;
            own += double(b[x] * b[x]) * s * s;
        }
    }
    const double gamma = both / own;
    if (!sane(gamma)) return {};
    const auto bent = [&](int y) {
        return mapped(e.row(y), [&](float c) { return power(c, gamma); });
    };
    return {e.left(bent), "gamma",
            fmt::format("the test picture's values to the power of {:.3g} are the reference's: "
                        "the gamma is another",
                        gamma)};
}

std::vector<Finding> encodings(const Evidence& e) {
    const auto by_power = [](const LinearRows& picture) {
        return [&picture](int y) {
            return mapped(picture.row(y), [](float c) { return power(c, 1 / 2.2); });
        };
    };
    return {{e.left([&](int y) { return mapped(e.row(y), linear_to_srgb); }), "no_srgb",
             "the test picture looks as if it lacked the sRGB encoding, or the reference as if it "
             "were encoded twice"},
            {e.left([&](int y) { return mapped(e.row(y), srgb_to_linear); }), "double_srgb",
             "the test picture looks as if it were sRGB-encoded twice, or the reference as if it "
             "lacked the encoding"},
            {e.left(by_power(e.test)), "gamma_22",
             "the reference looks as if it were encoded with a gamma of 2.2 instead of sRGB"},
            {e.left(by_power(e.reference), e.a), "gamma_22",
             "the test picture looks as if it were encoded with a gamma of 2.2 instead of sRGB"},
            other_gamma(e)};
}

// The colour that most pixels of the border have, to 8 bits.
cv::Vec3f border_color(const cv::Mat& kept) {
    Majority border;
    const auto count = [&](int y, int x) {
        border.count(cv::Vec3f(kept.at<cv::Vec3w>(y, x)) * float(1 / full));
    };
    for (int x = 0; x < kept.cols; ++x) {
        count(0, x);
        count(kept.rows - 1, x);
    }
    for (int y = 0; y < kept.rows; ++y) {
        count(y, 0);
        count(y, kept.cols - 1);
    }
    return border.most().color;
}

// Another colour wherever the test picture shows its own background.
Finding other_background(const Evidence& e) {
    const cv::Vec3f own = border_color(e.a), other = border_color(e.b);
    if (alike(own, other)) return {};
    const auto changed = [&](int y) {
        cv::Mat row = e.row(y);
        const cv::Mat reference = e.reference_row(y);
        for (int x = 0; x < row.cols; ++x)
            if (auto& color = row.at<cv::Vec3f>(x); alike(color, own))
                color = reference.at<cv::Vec3f>(x);
        return row;
    };
    const auto bytes = [](const cv::Vec3f& c) {
        return fmt::format("({}, {}, {})", cvRound(255 * c[0]), cvRound(255 * c[1]),
                           cvRound(255 * c[2]));
    };
    return {e.left(changed), "background",
            fmt::format("the background is {} in the test picture and {} in the reference (sRGB)",
                        bytes(own), bytes(other))};
}

// By more than a tie, in which the earlier and simpler one wins.
bool clearly_better(const Finding& later, const Finding& earlier) {
    return later.left < earlier.left / 2 && later.left < earlier.left - 0.001;
}

}  // namespace

std::vector<std::string> differing_area(const cv::Mat& matched, const cv::Mat& counted,
                                        const char* measure) {
    const cv::Mat differing = ~matched & counted;
    const int count = cv::countNonZero(differing);
    if (count == 0) return {};
    const cv::Rect area = cv::boundingRect(differing);
    return {fmt::format("{} of {} pixels {} by more than 1/255 in {}, within ({}, {}) to ({}, {})",
                        count, cv::countNonZero(counted), count == 1 ? "differs" : "differ",
                        measure, area.x, area.y, area.br().x - 1, area.br().y - 1)};
}

Finding best_of(const std::vector<Finding>& simplest_first) {
    Finding best;
    for (const Finding& finding : simplest_first)
        if (finding.convincing() && (best.cause.empty() || clearly_better(finding, best)))
            best = finding;
    return best;
}

std::string said(const Finding& finding) {
    return fmt::format("{}: that explains {:.0f} % of the mean square error", finding.sentence,
                       100 * (1 - finding.left));
}

Finding likely_cause(const Image& test, const Image& reference) {
    const auto rows = [](const Image& image) {
        const cv::Mat whole = view(image);
        return LinearRows{image.width, image.height, [whole](int y) { return whole.row(y); }};
    };
    return likely_cause(rows(test), rows(reference));
}

Finding likely_cause(const LinearRows& test, const LinearRows& reference) {
    Evidence evidence = {
        .test = test, .reference = reference, .a = all_encoded(test), .b = all_encoded(reference)};
    evidence.before = mean_square(evidence.a, evidence.b) / (full * full);
    if (!(evidence.before > 0)) return {};
    std::vector<Finding> findings = turned(evidence);
    findings.push_back(whole_shift(evidence));
    findings.push_back(exchanged(evidence));
    std::ranges::copy(encodings(evidence), std::back_inserter(findings));
    findings.push_back(brighter(evidence));
    findings.push_back(other_background(evidence));
    findings.push_back(tinted(evidence));
    std::ranges::copy(motions(evidence), std::back_inserter(findings));
    return best_of(findings);
}

Finding only_edges(const EdgeCounts& counts) {
    constexpr std::size_t least = 16;  // differing pixels: fewer may lie anywhere
    const bool edges_are_few = 2 * counts.beside < counts.pixels;
    const auto all = double(counts.differing), beside = double(counts.differing_beside);
    if (counts.differing < least || !edges_are_few || beside < 0.95 * all) return {};
    return {1, "edges",
            fmt::format("only edges differ: {:.0f} % of the differing pixels lie within a pixel of "
                        "one, as with another anti-aliasing or a shift by a fraction of a pixel",
                        100 * beside / all)};
}

}  // namespace penumbra::metrics
