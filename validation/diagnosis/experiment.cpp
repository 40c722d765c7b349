#include "validation/diagnosis/experiment.h"

#include "scene/objects.h"
#include "scene/scene_bulk.h"

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>

namespace penumbra::metrics {
namespace {

constexpr std::size_t enough_pixels = 80000;
constexpr double settled_at = 0.002;     // left of the error
constexpr double moved_at = 0.05;        // the same of what moves: edges jump by whole pixels
constexpr double least_likeness = 0.25;  // squared cosine of the first step and the error
constexpr int most_steps = 4;

// How many pixels of `full` are looked at when it is every `every`-th: as many as leave the same
// number on both sides.
int reduced_side(int full, int every) {
    int side = std::max(1, full / every);
    if ((full - side) % 2 != 0) --side;
    return std::max(side, 1);
}

int reduction_for(const RenderOptions& options) {
    int every = 1;
    const auto pixels = std::size_t(options.width) * std::size_t(options.height);
    while (pixels / std::size_t(every * every) > enough_pixels) every += 2;
    return every;
}

// Makes the camera see the part of the picture that `small` pixels of size `every` cover.
void narrow(Camera& camera, const RenderOptions& full, const RenderOptions& small, int every) {
    const bool horizontal = camera.side == Camera::Side::horizontal;
    const double share = horizontal ? double(small.width) * every / full.width
                                    : double(small.height) * every / full.height;
    camera.fov = 2 * std::atan(std::tan(camera.fov / 2) * share);
    camera.extent *= share;
}

double dot(const cv::Mat& a, const cv::Mat& b) { return a.dot(b); }

cv::Mat softened(const cv::Mat& image, double blur) {
    if (blur <= 0) return image;
    cv::Mat result;
    cv::GaussianBlur(image, result, {0, 0}, blur, blur, cv::BORDER_REPLICATE);
    return result;
}

cv::Mat encoded_mat(const cv::Mat& linear) {
    return mapped(linear, [](float c) { return linear_to_srgb(std::clamp(c, 0.F, 1.F)); });
}

// How much an error of linear light counts: about as much as it shows. Nothing where a display
// clips either picture.
float weight(float test, float reference) {
    if (reference >= 0.9999F) return 0;
    const float level = 0.02F + std::max({0.F, test, reference});
    return 1 / level;
}

}  // namespace

Experiment::Experiment(const NormalisedScene& scene, const RenderOptions& options,
                       const Image& test, const Image& reference, const Watch& watch)
    : working_(scene), tracer_(working_, options.threads, true), options_(options),
      origin_(scene.offset * -scene.factor), watch_({.stop = watch.stop}),
      every_(reduction_for(options)) {
    options_.width = reduced_side(options.width, every_);
    options_.height = reduced_side(options.height, every_);
    narrow(working_.scene.cameras[working_.scene.camera], options, options_, every_);
    tracer_.update(working_);
    kept_ = without_bulk(working_.scene);
    test_ = reduced(test);
    reference_ = reduced(reference);
    test_encoded_ = encoded_mat(test_);
    reference_encoded_ = encoded_mat(reference_);

    const cv::Mat difference = test_encoded_ - reference_encoded_;
    cv::transform(difference.mul(difference), error_, cv::Matx13f::all(1));
    total_error_ = cv::sum(error_)[0];
    const std::vector<Index> objects = tracer_.objects_seen(options_);
    objects_.create(options_.height, options_.width, CV_32S);
    std::ranges::transform(objects, objects_.ptr<int>(),
                           [](Index object) { return object == no_index ? -1 : int(object); });
    // Means of pixels are not what the tracer makes of a small picture.
    if (every_ > 1 && several_samples()) base_ = with([](Variant&) {}).linear;
}

cv::Mat Experiment::reduced(const Image& image) const {
    cv::Mat result(options_.height, options_.width, CV_32FC3);
    const int left = (image.width - every_ * options_.width) / 2;
    const int top = (image.height - every_ * options_.height) / 2;
    const cv::Mat whole = view(image);
    each_row(result.rows, [&](int y) {
        for (int x = 0; x < result.cols; ++x) {
            const cv::Rect block(left + x * every_, top + y * every_, every_, every_);
            if (several_samples()) {
                const cv::Scalar mean = cv::mean(whole(block));
                result.at<cv::Vec3f>(y, x) =
                    cv::Vec3f(float(mean[0]), float(mean[1]), float(mean[2]));
            } else {
                result.at<cv::Vec3f>(y, x) =
                    whole.at<cv::Vec3f>(block.y + every_ / 2, block.x + every_ / 2);
            }
        }
    });
    return result;
}

Trial Experiment::with(const Change& change) {
    RenderOptions options = options_;
    Overrides overrides;
    Variant variant = {working_.scene, options, overrides};
    change(variant);
    overrides.dx /= every_;
    overrides.dy /= every_;
    tracer_.update(working_);
    const Image image = tracer_.render(options, overrides, watch_);
    restore_all_but_bulk(working_.scene, kept_);
    Trial result = {.linear = view(image).clone()};
    if (!base_.empty()) result.linear = test_ + (result.linear - base_);
    result.left = left(result.linear);
    return result;
}

double Experiment::left(const cv::Mat& linear) const {
    const double distance = cv::norm(encoded_mat(linear), reference_encoded_, cv::NORM_L2);
    return total_error_ > 0 ? distance * distance / total_error_ : 1;
}

double Experiment::support(const cv::Mat& linear) const {
    const cv::Mat changed = encoded_mat(linear);
    double inside = 0;
    for (int y = 0; y < error_.rows; ++y)
        for (int x = 0; x < error_.cols; ++x)
            if (!alike(changed.at<cv::Vec3f>(y, x), test_encoded_.at<cv::Vec3f>(y, x), 0.5 / 255))
                inside += double(error_.at<float>(y, x));
    return total_error_ > 0 ? inside / total_error_ : 0;
}

double Experiment::share(const cv::Mat& region) const {
    if (!(total_error_ > 0)) return 0;
    cv::Mat inside;
    error_.copyTo(inside, region);
    return cv::sum(inside)[0] / total_error_;
}

Found Experiment::seek(const Unknown& unknown) {
    const auto prepared = [&](const cv::Mat& encoded) { return softened(encoded, unknown.blur); };
    const cv::Mat target = prepared(reference_encoded_);
    const auto clamped = [&](double value) { return std::clamp(value, unknown.low, unknown.high); };
    Found best = {.value = unknown.start};
    double last = unknown.start, value = clamped(unknown.start + unknown.step);
    cv::Mat before = prepared(test_encoded_);
    const double scale = dot(target - before, target - before);
    for (int i = 0; i < most_steps && scale > 0; ++i) {
        const Trial trial = with(unknown.change(value));
        const cv::Mat now = prepared(encoded_mat(trial.linear));
        const cv::Mat slope = now - before, error = target - now;
        if (trial.left < best.left) best = {.value = value, .left = trial.left};
        const double slope_squared = dot(slope, slope);
        if (!(slope_squared > 0)) break;
        if (i == 0) {
            const double along = dot(target - before, slope);
            if (along * along < least_likeness * scale * slope_squared) break;
        }
        if (best.left < settled_at / 10) break;
        const double next = clamped(value + (value - last) * dot(error, slope) / slope_squared);
        if (std::abs(next - value) < 1e-4 * std::abs(unknown.step)) break;
        before = now;
        last = value;
        value = next;
    }
    return best;
}

std::vector<double> Experiment::fit(const std::vector<cv::Mat>& bases) const {
    const int count = int(bases.size());
    cv::Mat normal = cv::Mat::zeros(count, count, CV_64F);
    cv::Mat right = cv::Mat::zeros(count, 1, CV_64F), result;
    std::vector<double> values(bases.size());
    for (int y = 0; y < test_.rows; ++y) {
        const auto *const t = test_.ptr<float>(y), *const r = reference_.ptr<float>(y);
        for (int x = 0; x < 3 * test_.cols; ++x) {
            const double w = double(weight(t[x], r[x]));
            for (std::size_t i = 0; i < bases.size(); ++i)
                values[i] = double(bases[i].ptr<float>(y)[x]);
            for (int i = 0; i < count; ++i) {
                const double v = w * values[std::size_t(i)];
                right.at<double>(i) += v * (double(r[x]) - double(t[x]));
                for (int j = 0; j < count; ++j)
                    normal.at<double>(i, j) += v * values[std::size_t(j)];
            }
        }
    }
    cv::solve(normal, right, result, cv::DECOMP_SVD);
    return std::vector<double>(result.begin<double>(), result.end<double>());
}

std::array<double, 3> Experiment::fit_channels(const cv::Mat& basis) const {
    std::array<double, 3> above = {}, below = {}, result = {};
    for (int y = 0; y < test_.rows; ++y) {
        for (int x = 0; x < test_.cols; ++x) {
            const auto &t = test_.at<cv::Vec3f>(y, x), &r = reference_.at<cv::Vec3f>(y, x);
            const auto& b = basis.at<cv::Vec3f>(y, x);
            for (int c = 0; c < 3; ++c) {
                const double w = double(weight(t[c], r[c]));
                above[std::size_t(c)] += w * double(b[c]) * (double(r[c]) - double(t[c]));
                below[std::size_t(c)] += w * double(b[c]) * double(b[c]);
            }
        }
    }
    for (std::size_t c = 0; c < 3; ++c) result[c] = below[c] > 0 ? above[c] / below[c] : 0;
    return result;
}

bool Experiment::settled() const {
    return std::ranges::any_of(findings_, [](const Finding& f) {
        const bool moves = f.cause == "shift" || f.cause == "fov" || f.cause == "rotation";
        return f.left < (moves ? moved_at : settled_at);
    });
}

std::string named(const std::string& name, std::size_t index) {
    return name.empty() ? fmt::format("number {}", index + 1) : fmt::format("'{}'", name);
}

std::string more_or_less(double factor, const char* more, const char* less) {
    return fmt::format("{:.2g} % {}", 100 * std::abs(factor - 1), factor > 1 ? more : less);
}

cv::Mat pixels_of_object(const Experiment& experiment, Index object) {
    return experiment.objects() == int(object);
}

cv::Mat pixels_of_material(const Experiment& experiment, Index material) {
    const cv::Mat& objects = experiment.objects();
    cv::Mat result = cv::Mat::zeros(objects.size(), CV_8U);
    for (int y = 0; y < objects.rows; ++y)
        for (int x = 0; x < objects.cols; ++x)
            if (const int object = objects.at<int>(y, x);
                object >= 0 && material_index(experiment.scene(), Index(object)) == material)
                result.at<uchar>(y, x) = 255;
    return result;
}

}  // namespace penumbra::metrics
