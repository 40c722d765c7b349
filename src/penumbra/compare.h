// Two images -> how far apart they are, and why.
//
// `test` is ours, `reference` the other renderer's. Both are linear RGB.
#pragma once

#include "penumbra/error.h"
#include "penumbra/image.h"
#include "penumbra/picture.h"
#include "penumbra/prepare.h"
#include "penumbra/watch.h"

#include <cmath>
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace penumbra {

enum class Verdict { pass, warn, fail, not_comparable, error };
std::string to_string(Verdict verdict);

/// One figure. Written so that NaN is never ok.
struct Metric {
    std::string name = {};  ///< "parity", "exactness", "ssim", ...
    double value = 0;
    std::optional<double> limit = {};
    bool at_least = true;  ///< the limit is a minimum (else a maximum)
    /// A maximum limits the magnitude: `bias` has a sign.
    bool ok() const { return !limit || (at_least ? value >= *limit : std::abs(value) <= *limit); }
};

/// The limits where none are asked for: of some metrics those of the profile "equivalent". The
/// values are in the table of docs/json.md.
std::map<std::string, double> default_limits();

/// Limits of the verdict; a metric without a limit is only reported. A metric that has used up more
/// than 1 - warn_band of the error that its limit allows makes a pass a warning.
struct Limits {
    double warn_band = 0.2;
    std::map<std::string, double> limits = default_limits();  ///< by metric name
};

/// The limits of a named profile: "strict", "equivalent" or "similar". Throws Error (usage) for
/// another name.
Limits profile_limits(const std::string& name);

struct PixelPair {
    int x = 0, y = 0;
    Color test = Color(0), reference = Color(0);  ///< linear
    float test_alpha = 1, reference_alpha = 1;
};

/// A square of a picture and its mean FLIP error.
struct Tile {
    int x = 0, y = 0, side = 0;  ///< pixels
    double flip = 0;
};

struct Comparison {
    Verdict verdict = Verdict::error;
    std::vector<Metric> metrics = {};         ///< in a fixed order
    PixelPair worst = {};                     ///< where the largest linear channel difference is
    std::vector<Tile> worst_tiles = {};       ///< at most 4 of 16 pixels, apart, the worst first
    std::vector<std::string> diagnosis = {};  ///< sentences: why it differs or cannot be compared
    std::string cause = {};     ///< "shift", "gain", ... (docs/validation.md); "": unknown
    Image flip_map = {};        ///< FLIP error per pixel, in all three channels
    double warn_band = 0.2;     ///< of the limits in force
    Alpha alpha = Alpha::none;  ///< what was done with it, where either picture has any
    std::size_t pixels = 0;     ///< that were compared: not ignored
    std::size_t differing = 0;  ///< of these, those that parity does not count

    /// The metric of that name; NaN when there is none.
    double value(const std::string& name) const;
};

/// What was done with alpha, in a clause: "alpha is compared, ..."; empty where there is none.
std::string alpha_sentence(const Comparison& comparison);

/// Pixels x0 <= x < x1, y0 <= y < y1.
struct PixelBox {
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
};

struct CompareOptions {
    Limits limits = {};
    std::optional<Color> background =
        {};  ///< for coverage; the most frequent border colour if absent
    /// For coverage, whether each pixel shows an object, row by row from the top: what
    /// Tracer::subject_seen() says of a rendered scene. Empty: pixels that are not `background`.
    std::vector<bool> covered = {};
    Image mask = {};  ///< black pixels are ignored; empty: none. Same size as the pictures
    std::vector<PixelBox> ignored = {};  ///< pixels that are ignored
    /// Pixels that have each other's colour so near by, in both directions, count as equal.
    int shift_tolerance = 0;
    double exposure = 0;  ///< EV: both pictures are brightened by 2^EV before they are encoded
};

/// Computes every figure of the parity rule. Unequal sizes, NaN and nearly empty pictures give
/// Verdict::not_comparable. Throws Error (usage) for a limit of a metric that there is not, and for
/// a mask or a `covered` of another size than the pictures; input, where the comparison needs more
/// memory than memory_limit() leaves.
///
/// Where a picture has alpha, its colours are multiplied by it and alpha is one more channel of
/// parity, exactness, max_error, rmse, outliers and coverage. FLIP and SSIM look at both pictures
/// over black and over white and take the worse at every pixel.
Comparison compare(const Picture& test, const Picture& reference,
                   const CompareOptions& options = {});
Comparison compare(const Image& test, const Image& reference, const CompareOptions& options = {});

/// `reference` with the pixels of `test` where `options` ignores them, for explain(). Throws Error
/// (usage) when the pictures or the mask have other sizes, or there is nothing in a picture.
Image masked_reference(const Image& test, Image reference, const CompareOptions& options);

/// What the scene that `test` was rendered from tells of a comparison that failed: it is rendered
/// with one thing changed at a time (no shadows, no highlights, another field of view, an object
/// missing, ...), and what brings it close to `reference` is the cause. Replaces comparison.cause
/// and adds a sentence when one explains more than the pictures alone do. `comparison` is what
/// compare() made of both pictures; preconditions of the scene and the options are those of
/// render(). Throws Error: interrupted; usage, when the comparison failed and the pictures have
/// other sizes; input, when the scene needs more memory than memory_limit() leaves.
void explain(const NormalisedScene& scene, const RenderOptions& options, const Image& test,
             const Image& reference, Comparison& comparison, const Watch& watch = {});

/// Limits that known-good pairs meet: of each metric the worst value of all pairs with `margin`
/// times its error. Pairs that cannot be compared are left out.
Limits calibrated_limits(const std::vector<Comparison>& good, double margin = 1.5);

/// |test - reference| x gain, linear. Throws Error (usage) when the pictures have other sizes or
/// there is nothing in them.
Image difference(const Image& test, const Image& reference, float gain);

/// FLIP values in [0, 1] as colours of the magma map.
Image heat_map(const Image& flip_map);

}  // namespace penumbra
