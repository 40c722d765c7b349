// What if the light were another: background, sources, shadows, penumbrae.
#include "validation/diagnosis/experiment.h"
#include "validation/diagnosis/finding.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace penumbra::metrics {
namespace {

constexpr std::size_t most_lights = 6;
constexpr double nothing = 0.04;  // a factor below it is none

std::string looks_as_if(const std::string& what) { return "the reference looks as if " + what; }

// ---- sources ----------------------------------------------------------------------------------

// The light of each source, or of all together when they are many.
std::vector<cv::Mat> light_of_sources(Experiment& experiment) {
    const std::size_t count = experiment.scene().lights.size();
    const bool one_by_one = count <= most_lights;
    std::vector<cv::Mat> result;
    for (std::size_t i = 0; i < (one_by_one ? count : std::min<std::size_t>(count, 1)); ++i) {
        const Trial without = experiment.with([&](Variant& v) {
            if (one_by_one)
                v.scene.lights.erase(v.scene.lights.begin() + std::ptrdiff_t(i));
            else
                v.scene.lights.clear();
        });
        result.push_back(experiment.test() - without.linear);
    }
    return result;
}

std::string intensity(const std::string& what, double factor) {
    if (factor < nothing) return what + " missing";
    return what + " " + more_or_less(factor, "brighter", "dimmer");
}

void suppose_factor(Experiment& experiment, const cv::Mat& basis, const std::string& what,
                    const char* cause, const char* missing_cause) {
    const double factor = 1 + experiment.fit({basis}).front();
    const double left = experiment.left(experiment.test() + (factor - 1) * basis);
    experiment.suppose(
        {left, factor < nothing ? missing_cause : cause, looks_as_if(intensity(what, factor))});
}

void suppose_color(Experiment& experiment, const cv::Mat& basis, const std::string& what) {
    const std::array<double, 3> k = experiment.fit_channels(basis);
    std::vector<cv::Mat> planes;
    cv::split(basis, planes);
    for (std::size_t c = 0; c < 3; ++c) planes[c] *= k[c];
    cv::Mat change;
    cv::merge(planes, change);
    experiment.suppose(
        {experiment.left(experiment.test() + change), "light",
         looks_as_if(fmt::format("{} of another colour: {:.3g}, {:.3g} and {:.3g} times the red, "
                                 "green and blue",
                                 what, 1 + k[0], 1 + k[1], 1 + k[2]))});
}

void suppose_intensities(Experiment& experiment) {
    const std::vector<cv::Mat> lights = light_of_sources(experiment);
    if (lights.empty()) return;
    cv::Mat all = lights.front().clone();
    for (std::size_t i = 1; i < lights.size(); ++i) all += lights[i];
    suppose_factor(experiment, all, "all light sources were", "light", "light_missing");
    if (lights.size() > 1) {
        for (std::size_t i = 0; i < lights.size(); ++i)
            suppose_factor(experiment, lights[i],
                           "the light source " + named(experiment.scene().lights[i].name, i) +
                               " were",
                           "light", "light_missing");
    }
    suppose_color(experiment, all, "all light sources were");
    if (lights.size() < 2) return;
    const std::vector<double> k = experiment.fit(lights);
    cv::Mat picture = experiment.test().clone();
    std::string factors;
    for (std::size_t i = 0; i < lights.size(); ++i) {
        picture += k[i] * lights[i];
        factors += fmt::format("{}{:.3g}",
                               i == 0                  ? ""
                               : i + 1 < lights.size() ? ", "
                                                       : " and ",
                               1 + k[i]);
    }
    experiment.suppose({experiment.left(picture), "light",
                        looks_as_if("the light sources were " + factors + " times as bright")});
}

void suppose_no_fading(Experiment& experiment) {
    const auto& lights = experiment.scene().lights;
    if (std::ranges::none_of(lights, [](const Light& l) { return l.attenuation.has_value(); }))
        return;
    const Trial trial = experiment.with([](Variant& v) {
        for (Light& light : v.scene.lights) light.attenuation.reset();
    });
    experiment.suppose(
        {trial.left, "attenuation", looks_as_if("light did not fade with the distance")});
}

// Light that does not come from sources.
void suppose_own_light(Experiment& experiment) {
    const auto gives = [&](const Color Material::* term) {
        return std::ranges::any_of(experiment.scene().materials,
                                   [&](const Material& m) { return m.*term != Color(0); });
    };
    if (gives(&Material::ambient) && experiment.scene().ambient != Color(0)) {
        const Trial dark = experiment.with([](Variant& v) { v.scene.ambient = Color(0); });
        suppose_factor(experiment, experiment.test() - dark.linear, "the ambient light were",
                       "ambient", "ambient");
    }
    if (gives(&Material::emission)) {
        const Trial dark = experiment.with([](Variant& v) {
            for (Material& m : v.scene.materials) m.emission = Color(0);
        });
        suppose_factor(experiment, experiment.test() - dark.linear, "what glows were", "emission",
                       "emission");
    }
}

// ---- penumbrae --------------------------------------------------------------------------------

bool has_penumbra(const Light& light) { return light.penumbra.delta > 0; }

void suppose_other_penumbrae(Experiment& experiment) {
    const Trial sharp = experiment.with([](Variant& v) {
        for (Light& light : v.scene.lights) light.penumbra.delta = 0;
    });
    // A wider penumbra reaches far out of the one that the scene has.
    if (experiment.support(sharp.linear) < 0.1) return;
    experiment.suppose(
        {sharp.left, "penumbra", looks_as_if("the light sources were points, without penumbra")});
    const Found found = experiment.seek({.start = 1,
                                         .step = 1,
                                         .low = 0,
                                         .high = 8,
                                         .blur = 1,
                                         .change = [](double factor) -> Change {
                                             return [=](Variant& v) {
                                                 for (Light& light : v.scene.lights)
                                                     light.penumbra.delta *= factor;
                                             };
                                         }});
    experiment.suppose({found.left, "penumbra",
                        looks_as_if(fmt::format("delta of the penumbrae were {:.2g} times as large",
                                                found.value))});
}

void suppose_some_penumbra(Experiment& experiment, double factor) {
    const Found found = experiment.seek({.start = 0,
                                         .step = 0.2,
                                         .low = 0,
                                         .high = 4,
                                         .blur = 1,
                                         .change = [](double delta) -> Change {
                                             return [=](Variant& v) {
                                                 for (Light& light : v.scene.lights)
                                                     light.penumbra.delta = delta;
                                             };
                                         }});
    if (found.value > 0)
        experiment.suppose(
            {found.left, "penumbra",
             looks_as_if(fmt::format("the light sources had a penumbra of delta = {:.2g}",
                                     found.value / factor))});
}

}  // namespace

void suppose_background(Experiment& experiment) {
    const cv::Mat behind = experiment.objects() == -1;
    if (cv::countNonZero(behind) == 0 || experiment.share(behind) < 0.02) return;
    const cv::Scalar mean = cv::mean(experiment.reference(), behind);
    const Color seen{float(mean[0]), float(mean[1]), float(mean[2])};
    const Trial trial = experiment.with([&](Variant& v) {
        v.scene.background = seen;
        v.scene.sky.reset();
    });
    const Color own = experiment.scene().background;
    const std::string instead = experiment.scene().sky
                                    ? "an image of the sky"
                                    : fmt::format("({:.3g}, {:.3g}, {:.3g})", own.x, own.y, own.z);
    experiment.suppose({trial.left, "background",
                        fmt::format("the reference has the background ({:.3g}, {:.3g}, {:.3g}) "
                                    "instead of {} (linear)",
                                    seen.x, seen.y, seen.z, instead)});
}

void suppose_lights(Experiment& experiment) {
    suppose_intensities(experiment);
    suppose_no_fading(experiment);
    suppose_own_light(experiment);
}

void suppose_shadows(Experiment& experiment) {
    const auto& lights = experiment.scene().lights;
    if (lights.empty()) return;
    const Trial open = experiment.with([](Variant& v) { v.overrides.shadows = false; });
    experiment.suppose({open.left, "shadows", looks_as_if("nothing threw a shadow")});
    if (std::ranges::any_of(lights, has_penumbra)) return suppose_other_penumbrae(experiment);
    if (experiment.support(open.linear) > 0.3)
        suppose_some_penumbra(experiment, experiment.units());
}

}  // namespace penumbra::metrics
