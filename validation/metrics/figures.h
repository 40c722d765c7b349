// What the figures of two pictures are made of: maps of their similarity and difference, and what
// pools a map into one figure. Matrices are those of picture.h.
#pragma once

#include "penumbra/compare.h"
#include "penumbra/image.h"

#include <opencv2/core.hpp>

#include <vector>

namespace penumbra::metrics {

/// SSIM of each pixel, mean of the three channels: CV_32F. It looks at pixels up to ssim_radius
/// away.
cv::Mat ssim_map(const cv::Mat& test_encoded, const cv::Mat& reference_encoded);
inline constexpr int ssim_radius = 5;

/// LDR-FLIP of each pixel: CV_32F in [0, 1]. It looks at pixels up to flip_radius away.
cv::Mat flip_map(const cv::Mat& test_linear, const cv::Mat& reference_linear);
inline constexpr int flip_radius = 10;

/// Exposures in even steps, EV.
struct Exposures {
    double first = 0, last = 0;
    int count = 2;
    double at(int i) const { return first + (last - first) * i / (count - 1); }
};

/// Those of HDR-FLIP that follow from the luminances of the reference's pixels with some light,
/// which are left in another order.
Exposures exposures_for(std::vector<double>& luminances);

/// The luminance of a linear colour as exposures_for() takes it.
double luminance(const cv::Vec3f& linear);

/// HDR-FLIP of each pixel.
cv::Mat hdr_flip_map(const cv::Mat& test_linear, const cv::Mat& reference_linear,
                     const Exposures& exposures);

/// Is a channel beyond the square root of 2, that is half an exposure value above white?
bool markedly_bright(const cv::Vec3f& linear);

enum class Worst { smallest, largest };

/// The worst mean of `map` over square tiles of `side` pixels. The last tile of a row or column
/// is moved inwards, so that all have the same area; a smaller picture is one tile. Only pixels of
/// `region` count, and tiles that have a quarter of them; without one, the mean of the region.
double worst_tile(const cv::Mat& map, const cv::Mat& region, int side, Worst worst);

/// At most `count` such tiles of the largest means above 0, the worst first, none over another.
std::vector<Tile> worst_tiles(const cv::Mat& map, const cv::Mat& region, int side, int count);

/// The value that the fraction `q` of the region's pixels does not exceed (nearest rank).
double quantile(const cv::Mat& map, const cv::Mat& region, double q);

}  // namespace penumbra::metrics
