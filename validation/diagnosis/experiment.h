// Renders a scene with one thing changed at a time and sees how near that comes to a reference.
#pragma once

#include "validation/diagnosis/finding.h"
#include "validation/metrics/picture.h"

#include "penumbra/tracer.h"

#include <functional>
#include <string>
#include <vector>

namespace penumbra::metrics {

/// What a supposition may change: not meshes, and of the textures that are there only the filter.
struct Variant {
    Scene& scene;
    RenderOptions& options;
    Overrides& overrides;  ///< its pixels are those of the picture given
};

using Change = std::function<void(Variant&)>;

/// A picture of the changed scene, and what it leaves of the mean square error.
struct Trial {
    cv::Mat linear;
    double left = 1;
};

/// A number of the scene that is sought.
struct Unknown {
    double start = 0;  ///< what the scene has
    double step = 1;   ///< the first guess is start + step
    double low = 0, high = 0;
    double blur = 0;  ///< pixels; things that move are compared through a blur
    std::function<Change(double)> change = {};
};

/// The number that comes nearest.
struct Found {
    double value = 0;
    double left = 1;
};

/// The pictures of an experiment are smaller than those given: of large ones every third, fifth,
/// ... pixel is looked at, or, with several samples a pixel, the mean of so many.
class Experiment {
  public:
    Experiment(const NormalisedScene& scene, const RenderOptions& options, const Image& test,
               const Image& reference, const Watch& watch);

    const Scene& scene() const { return working_.scene; }
    const RenderOptions& options() const { return options_; }
    const Vec3& origin() const { return origin_; }           ///< the user's, in the scene's units
    double units() const { return working_.factor; }         ///< of the scene in one of the user's
    const cv::Mat& test() const { return test_; }            ///< linear
    const cv::Mat& reference() const { return reference_; }  ///< linear
    const cv::Mat& error() const { return error_; }  ///< squared, of each pixel, encoded: CV_32F
    double total_error() const { return total_error_; }
    /// The object that each pixel shows, or -1: CV_32S.
    const cv::Mat& objects() const { return objects_; }

    const cv::Mat& test_encoded() const { return test_encoded_; }
    const cv::Mat& reference_encoded() const { return reference_encoded_; }
    int every() const { return every_; }  ///< pixels of the picture given in one of the experiment

    /// What the test picture would be.
    Trial with(const Change& change);
    /// What a linear picture leaves of the mean square error.
    double left(const cv::Mat& linear) const;
    /// Share of the error that lies where a change shows, by more than half a step of 8 bits.
    double support(const cv::Mat& linear) const;
    /// Share of the error in a region.
    double share(const cv::Mat& region) const;

    /// Gauss-Newton, with the slope of the last two pictures. Gives up at once when the first step
    /// does not look like the error.
    Found seek(const Unknown& unknown);

    /// The factors k of least squares of reference - test = sum of k basis, in linear light.
    std::vector<double> fit(const std::vector<cv::Mat>& bases) const;
    /// The same for one basis, channel by channel.
    std::array<double, 3> fit_channels(const cv::Mat& basis) const;

    void suppose(Finding finding) { findings_.push_back(std::move(finding)); }
    const std::vector<Finding>& findings() const { return findings_; }
    /// Something leaves so little that no other supposition is needed.
    bool settled() const;

  private:
    cv::Mat reduced(const Image& image) const;
    bool several_samples() const { return options_.samples > 1 || options_.antialiasing; }

    NormalisedScene working_;
    Tracer tracer_;  ///< of working_
    Scene kept_;     ///< all but meshes and the samples of textures
    RenderOptions options_;
    Vec3 origin_;
    Watch watch_;
    int every_ = 1;  ///< pixels
    cv::Mat test_, reference_, base_;
    cv::Mat test_encoded_, reference_encoded_;
    cv::Mat error_, objects_;
    double total_error_ = 0;
    std::vector<Finding> findings_ = {};
};

// ---- suppositions, simplest first -------------------------------------------------------------

void suppose_shift(Experiment& experiment);
void suppose_background(Experiment& experiment);
void suppose_objects(Experiment& experiment);
void suppose_lights(Experiment& experiment);
void suppose_shadows(Experiment& experiment);
void suppose_highlights(Experiment& experiment);
void suppose_recursion(Experiment& experiment);
void suppose_surfaces(Experiment& experiment);
void suppose_pigments(Experiment& experiment);
void suppose_textures(Experiment& experiment);
void suppose_view(Experiment& experiment);
void suppose_rotations(Experiment& experiment);

/// The names of things as sentences have them: "'lamp'", or "number 2" of those without a name.
std::string named(const std::string& name, std::size_t index);

/// "x % more" or "x % less" for a factor.
std::string more_or_less(double factor, const char* more, const char* less);

/// The pixels that show an object, or any object of a material.
cv::Mat pixels_of_object(const Experiment& experiment, Index object);
cv::Mat pixels_of_material(const Experiment& experiment, Index material);

}  // namespace penumbra::metrics
