// Why a comparison failed, from what the scene of the test picture can be made to look like.
#include "scene/check_options.h"
#include "validation/diagnosis/experiment.h"
#include "validation/diagnosis/finding.h"
#include "validation/metrics/picture.h"

#include "penumbra/compare.h"

#include <algorithm>
#include <array>

namespace penumbra {
namespace {

using namespace metrics;

// Pictures that are moved, or encoded in another way, look like nothing that a scene can do.
bool of_pictures_alone(const Finding& finding) {
    constexpr std::array causes = {"shift", "mirror",   "flip",    "turn",
                                   "roll",  "channels", "no_srgb", "double_srgb"};
    return std::ranges::find(causes, finding.cause) != causes.end();
}

using Supposition = void (*)(Experiment&);

// What can still be a better explanation than the one that the pictures give.
std::vector<Supposition> suppositions(const Finding& alone) {
    // What explains nearly everything can only be said in other words.
    if (alone.left < 0.001) {
        if (alone.cause == "gain" || alone.cause == "tint") return {suppose_lights};
        if (alone.cause == "background") return {suppose_background};
        if (alone.cause != "fov") return {};
    }
    return {suppose_shift,    suppose_view,     suppose_background, suppose_objects,
            suppose_lights,   suppose_shadows,  suppose_highlights, suppose_recursion,
            suppose_surfaces, suppose_pigments, suppose_textures,   suppose_rotations};
}

void look_for_cause(const NormalisedScene& scene, const RenderOptions& options, const Image& test,
                    const Image& reference, Comparison& comparison, const Watch& watch) {
    const Finding alone = likely_cause(test, reference);
    const std::vector<Supposition> suppose = suppositions(alone);
    if (suppose.empty()) return;

    Experiment experiment(scene, options, test, reference, watch);
    if (!(experiment.total_error() > 0)) return;
    for (const Supposition one : suppose)
        if (!experiment.settled()) one(experiment);
    std::vector<Finding> findings = experiment.findings();
    // What is known of the scene says more than a figure of the whole picture, but not the other
    // way round.
    findings.insert(of_pictures_alone(alone) ? findings.begin() : findings.end(), alone);
    const Finding best = best_of(findings);
    if (!best.convincing() || best.sentence == alone.sentence) return;
    comparison.cause = best.cause;
    comparison.diagnosis.push_back(said(best));
}

}  // namespace

void explain(const NormalisedScene& scene, const RenderOptions& options, const Image& test,
             const Image& reference, Comparison& comparison, const Watch& watch) {
    check(options);
    const bool same_size = test.width == options.width && test.height == options.height;
    if (comparison.verdict != Verdict::fail || !same_size) return;
    check_fit(test, reference);
    with_own_errors([&] { look_for_cause(scene, options, test, reference, comparison, watch); });
}

}  // namespace penumbra
