// Structural similarity, and what pools a map of errors into one figure.
#include "validation/metrics/figures.h"

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>
#include <functional>

namespace penumbra::metrics {

// Wang, Bovik, Sheikh, Simoncelli 2004, "Image Quality Assessment: From Error Visibility to
// Structural Similarity", equation 13: K1 = 0.01, K2 = 0.03, L = 255. The window and the treatment
// of borders (mirrored without the border pixel) are those of OpenCV's quality module.
cv::Mat ssim_map(const cv::Mat& test_encoded, const cv::Mat& reference_encoded) {
    constexpr double c1 = 6.5025, c2 = 58.5225;
    const auto blur = [](const cv::Mat& image) {
        cv::Mat result;
        cv::GaussianBlur(image, result, {11, 11}, 1.5);
        return result;
    };
    const cv::Mat a = test_encoded * 255, b = reference_encoded * 255;
    const cv::Mat mean_a = blur(a), mean_b = blur(b);
    const cv::Mat mean_aa = mean_a.mul(mean_a), mean_bb = mean_b.mul(mean_b);
    const cv::Mat mean_ab = mean_a.mul(mean_b);
    const cv::Mat variance_a = blur(a.mul(a)) - mean_aa, variance_b = blur(b.mul(b)) - mean_bb;
    const cv::Mat covariance = blur(a.mul(b)) - mean_ab;
    const cv::Scalar k1 = cv::Scalar::all(c1), k2 = cv::Scalar::all(c2);
    const cv::Mat above = cv::Mat(mean_ab * 2 + k1).mul(cv::Mat(covariance * 2 + k2));
    const cv::Mat below =
        cv::Mat(mean_aa + mean_bb + k1).mul(cv::Mat(variance_a + variance_b + k2));
    cv::Mat channels, result;
    cv::divide(above, below, channels);
    cv::transform(channels, result, cv::Matx13f::all(1.F / 3));
    return result;
}

namespace {

struct TileMean {
    cv::Rect area;
    double mean = 0;
};

std::vector<TileMean> tile_means(const cv::Mat& map, const cv::Mat& region, int side) {
    const int width = std::min(side, map.cols), height = std::min(side, map.rows);
    std::vector<TileMean> result;
    for (int top = 0; top < map.rows; top += side) {
        for (int left = 0; left < map.cols; left += side) {
            const cv::Rect tile(std::min(left, map.cols - width), std::min(top, map.rows - height),
                                width, height);
            const cv::Mat part = region(tile);
            if (4 * cv::countNonZero(part) >= tile.area())
                result.push_back({tile, cv::mean(map(tile), part)[0]});
        }
    }
    return result;
}

}  // namespace

double worst_tile(const cv::Mat& map, const cv::Mat& region, int side, Worst worst) {
    const std::vector<TileMean> tiles = tile_means(map, region, side);
    if (tiles.empty()) return cv::mean(map, region)[0];
    const auto [least, most] = std::ranges::minmax_element(tiles, {}, &TileMean::mean);
    return worst == Worst::smallest ? least->mean : most->mean;
}

std::vector<Tile> worst_tiles(const cv::Mat& map, const cv::Mat& region, int side, int count) {
    std::vector<TileMean> tiles = tile_means(map, region, side);
    std::ranges::stable_sort(tiles, std::greater<>(), &TileMean::mean);
    std::vector<Tile> result;
    std::vector<cv::Rect> taken;
    for (const TileMean& tile : tiles) {
        if (std::ssize(result) == count || !(tile.mean > 0)) break;
        const auto meets = [&](const cv::Rect& other) { return !(other & tile.area).empty(); };
        if (std::ranges::any_of(taken, meets)) continue;
        taken.push_back(tile.area);
        result.push_back({tile.area.x, tile.area.y, tile.area.width, tile.mean});
    }
    return result;
}

double quantile(const cv::Mat& map, const cv::Mat& region, double q) {
    std::vector<float> values;
    for (int y = 0; y < map.rows; ++y)
        for (int x = 0; x < map.cols; ++x)
            if (region.at<uchar>(y, x) != 0) values.push_back(map.at<float>(y, x));
    const auto rank = std::ptrdiff_t(std::ceil(q * double(values.size()))) - 1;
    const auto at = values.begin() + std::clamp(rank, std::ptrdiff_t(0), std::ssize(values) - 1);
    std::nth_element(values.begin(), at, values.end());
    return *at;
}

}  // namespace penumbra::metrics
