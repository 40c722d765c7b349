// The parts that compare() is made of. Pictures are OpenCV matrices here: CV_32FC3, RGB order;
// `encoded` ones are clamped to [0, 1] and sRGB-encoded. A region is CV_8U: 255 inside, 0 outside.
#pragma once

#include "penumbra/image.h"
#include "penumbra/math.h"
#include "penumbra/validation.h"

#include <opencv2/core.hpp>

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace penumbra::metrics {

/// Runs `row(y)` for every row, on all cores. Rows must not share what they write.
template <class Row>
void each_row(int height, const Row& row) {
    cv::parallel_for_(cv::Range(0, height), [&](const cv::Range& range) {
        for (int y = range.start; y < range.end; ++y) row(y);
    });
}

// ---- pictures ---------------------------------------------------------------------------------

/// `color` as a display shows it: clamped to [0, 1] and sRGB-encoded. NaN stays NaN.
Color encoded(const Color& color);
cv::Mat encoded(const Image& image);

/// `map` of each channel.
cv::Mat mapped(const cv::Mat& image, const std::function<float(float)>& map);

/// The pixels of `image` without a copy.
cv::Mat view(const Image& image);

/// `image` times 2^stops.
Image brightened(const Image& image, double stops);

/// Encoded colours that are no farther apart than this count as equal.
inline constexpr double display_step = 1.0 / 255 + 1e-6;
/// Encoded colours that are farther apart than this are outliers.
inline constexpr double outlier_step = 8.0 / 255 + 1e-6;

/// True when the encoded colours differ by no more than `step` in any channel; never with NaN.
bool alike(const cv::Vec3f& a, const cv::Vec3f& b, double step = display_step);

/// The colour that most pixels of the border have, to 8 bits.
cv::Vec3f border_color(const cv::Mat& encoded);

/// Mean over pixels and channels of the squared difference.
double mean_square(const cv::Mat& a, const cv::Mat& b);

// ---- figures ----------------------------------------------------------------------------------

/// SSIM of each pixel, mean of the three channels: CV_32F.
cv::Mat ssim_map(const cv::Mat& test_encoded, const cv::Mat& reference_encoded);

/// LDR-FLIP of each pixel: CV_32F in [0, 1].
cv::Mat flip_map(const Image& test, const Image& reference);

/// HDR-FLIP of each pixel.
cv::Mat hdr_flip_map(const Image& test, const Image& reference);

/// Does a thousandth of the picture have a channel beyond the square root of 2, that is half an
/// exposure value above white?
bool markedly_bright(const Image& image);

enum class Worst { smallest, largest };

/// The worst mean of `map` over square tiles of `side` pixels. The last tile of a row or column
/// is moved inwards, so that all have the same area; a smaller picture is one tile. Only pixels of
/// `region` count, and tiles that have a quarter of them; without one, the mean of the region.
double worst_tile(const cv::Mat& map, const cv::Mat& region, int side, Worst worst);

/// At most `count` such tiles of the largest means above 0, the worst first, none over another.
std::vector<Tile> worst_tiles(const cv::Mat& map, const cv::Mat& region, int side, int count);

/// The value that the fraction `q` of the region's pixels does not exceed (nearest rank).
double quantile(const cv::Mat& map, const cv::Mat& region, double q);

// ---- regions ----------------------------------------------------------------------------------

/// Pixels that count: not ignored by the options. Throws Error (usage) when the mask has another
/// size than the pictures.
cv::Mat counted_pixels(const CompareOptions& options, int width, int height);

/// Where either picture shows something else than the background.
cv::Mat covered_pixels(const cv::Mat& test_encoded, const cv::Mat& reference_encoded,
                       const std::optional<Color>& background);

/// Pixels beside an edge: whose 3 x 3 neighbourhood spans more than a tenth in some channel.
cv::Mat edge_band(const cv::Mat& encoded);

/// Where each picture shows a colour that the other one has no more than `radius` pixels away,
/// within `step`.
cv::Mat matched_pixels(const cv::Mat& test_encoded, const cv::Mat& reference_encoded, int radius,
                       double step);

// ---- diagnosis --------------------------------------------------------------------------------

/// Why the pictures cannot be laid over each other: one is empty, or their sizes differ.
std::vector<std::string> misfits(const Image& test, const Image& reference);

/// A sentence for each picture with pixels that are NaN or infinite.
std::vector<std::string> not_finite(const Image& test, const Image& reference);

/// One sentence about where pixels of `counted` are not `matched`; empty when they are.
std::vector<std::string> differing_area(const cv::Mat& matched, const cv::Mat& counted);

/// What explains the difference of two pictures.
struct Finding {
    double left = 1;            ///< fraction of the mean square error that it leaves
    std::string cause = {};     ///< identifier, as Comparison::cause; empty: nothing is known
    std::string sentence = {};  ///< a clause without a period

    /// A quarter of the mean square is half of the root mean square.
    bool convincing() const { return !cause.empty() && left < 0.25; }
};

/// True when `later` is better by more than a tie, in which the earlier and simpler one wins.
bool clearly_better(const Finding& later, const Finding& earlier);

/// The simplest of the convincing findings, among those that leave about the least.
Finding best_of(const std::vector<Finding>& simplest_first);

/// "<sentence>: that explains 97 % of the mean square error"
std::string said(const Finding& finding);

/// What explains most of the difference as far as pictures tell: a shift, a wrong brightness, ...
Finding likely_cause(const Image& test, const Image& reference);

/// Where else the difference lies when nothing explains it; no share is left out of it.
Finding only_edges(const cv::Mat& test_encoded, const cv::Mat& reference_encoded);

/// How one picture lies over another, about the middle: a point p of the test picture shows what
/// the reference shows at p - shift - zoom p - roll perpendicular(p).
struct Motion {
    double dx = 0, dy = 0;  ///< pixels
    double zoom = 0;        ///< 1 - 1 / the test picture's scale
    double roll = 0;        ///< radians, clockwise
};

/// One kind of motion, what it is, and what it leaves of the mean square error.
struct Registration {
    Motion motion = {};
    double left = 1;
};

enum class Moves { shift, zoom, roll, all };

/// The best motion of a kind. Pictures are compared through a blur of two and a half pixels, because
/// one sample a pixel makes edges jump by whole pixels. Small pictures have none.
Registration register_pictures(const cv::Mat& test_encoded, const cv::Mat& reference_encoded,
                               Moves moves);

/// 16 evenly spaced colours of the magma map, sRGB 0xRRGGBB.
extern const std::array<unsigned, 16> magma;

}  // namespace penumbra::metrics
