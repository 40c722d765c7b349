// Two images -> how far apart they are, and a report that shows it.
//
// `test` is ours, `reference` the other renderer's. Both are linear RGB.
#pragma once

#include "penumbra/error.h"
#include "penumbra/image.h"
#include "penumbra/scene.h"
#include "penumbra/watch.h"

#include <chrono>
#include <cmath>
#include <filesystem>
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

/// Limits of the verdict; a metric without a limit is only reported. A metric that has used up more
/// than 1 - warn_band of the error that its limit allows makes a pass a warning.
struct Limits {
    double warn_band = 0.2;
    std::map<std::string, double> limits = {  ///< by metric name
        {"parity", 0.995},
        {"ssim", 0.99},
        {"flip", 0.01},
        {"flip_tile", 0.045}};
};

/// The limits of a named profile: "strict", "equivalent" or "similar". Throws Error (usage).
Limits profile_limits(const std::string& name);

struct PixelPair {
    int x = 0, y = 0;
    Color test = Color(0), reference = Color(0);  ///< linear
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
    std::string cause = {};  ///< "shift", "gain", ... (docs/validation.md); "": unknown
    Image flip_map = {};     ///< FLIP error per pixel, in all three channels
    double warn_band = 0.2;  ///< of the limits in force

    /// The metric of that name; NaN when there is none.
    double value(const std::string& name) const;
};

/// Pixels x0 <= x < x1, y0 <= y < y1.
struct PixelBox {
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
};

struct CompareOptions {
    Limits limits = {};
    std::optional<Color> background =
        {};           ///< for coverage; the most frequent border colour if absent
    Image mask = {};  ///< black pixels are ignored; empty: none. Same size as the pictures
    std::vector<PixelBox> ignored = {};  ///< pixels that are ignored
    /// Pixels that have each other's colour so near by, in both directions, count as equal.
    int shift_tolerance = 0;
    double exposure = 0;  ///< EV: both pictures are brightened by 2^EV before they are encoded
};

/// Computes every figure of the parity rule. Unequal sizes, NaN and nearly empty pictures give
/// Verdict::not_comparable.
Comparison compare(const Image& test, const Image& reference, const CompareOptions& options = {});

/// `reference` with the pixels of `test` where `options` ignores them, for explain(). Precondition:
/// the pictures and the mask have one size.
Image masked_reference(const Image& test, Image reference, const CompareOptions& options);

/// What the scene that `test` was rendered from tells of a comparison that failed: it is rendered
/// with one thing changed at a time (no shadows, no highlights, another field of view, an object
/// missing, ...), and what brings it close to `reference` is the cause. Replaces comparison.cause
/// and adds a sentence when one explains more than the pictures alone do. Throws Error
/// (interrupted).
void explain(const NormalisedScene& scene, const RenderOptions& options, const Image& test,
             const Image& reference, Comparison& comparison, const Watch& watch = {});

/// Limits that known-good pairs meet: of each metric the worst value of all pairs with `margin`
/// times its error. Pairs that cannot be compared are left out.
Limits calibrated_limits(const std::vector<Comparison>& good, double margin = 1.5);

/// |test - reference| x gain, linear. Precondition: equal sizes.
Image difference(const Image& test, const Image& reference, float gain);

/// FLIP values in [0, 1] as colours of the magma map.
Image heat_map(const Image& flip_map);

struct PovrayOptions {
    std::string binary = {};  ///< empty: PENUMBRA_POVRAY, else "povray" found in PATH
    int threads = 0;          ///< 0: as many as the machine has
    std::chrono::seconds timeout{600};
    std::size_t memory = 0;  ///< bytes that it may take; 0: memory_limit()
    bool keep_exr = true;    ///< keep the file that POV-Ray itself writes
};

struct PovrayRun {
    Image image = {};                       ///< its raw float32 pixels
    std::string log = {};                   ///< what it printed
    std::vector<std::string> command = {};  ///< the argument vector
    std::filesystem::path folder = {};      ///< where it ran
    double seconds = 0;                     ///< wall time
    double cpu_seconds = 0;                 ///< user + system
};

/// Runs POV-Ray on an .ini that write_pov() wrote, as a child process without a shell, in the
/// file's folder, and reads the pixels from its render-state file (EXR if there is none). The child
/// and its children are killed on time-out and on stop. Throws Error (povray, interrupted).
PovrayRun run_povray(const std::filesystem::path& ini, int width, int height,
                     const PovrayOptions& options = {}, const Watch& watch = {});

/// The first line of `povray --version`, such as "POV-Ray 3.7.0.10". Throws Error (povray).
std::string povray_version(const PovrayOptions& options = {});

/// One compared pair, with all that a report says of it.
struct Case {
    std::string name = {};
    std::string folder = {};  ///< of its files, relative to the report; empty: the report's own
    Comparison comparison = {};
    std::string test_name = "penumbra", reference_name = "POV-Ray";
    Image test = {}, reference = {};
    Losses losses = {};
    std::map<std::string, double> seconds = {};     ///< import, render, export, povray, compare
    std::vector<std::string> commands = {};         ///< that repeat it
    std::map<std::string, std::string> files = {};  ///< role -> path relative to the report
    std::string povray_log = {};
    std::string message = {};  ///< of a case that ended in an error
    bool cached = false;       ///< taken from an earlier run
};

/// The documented JSON document: {"version": 1, "cases": [...]} (docs/report.schema.json).
std::string report_json(const std::vector<Case>& cases);

/// The cases of such a document, without their pictures. Throws Error (input).
std::vector<Case> cases_of_json(const std::string& text);

/// JUnit XML with one test case per Case.
std::string report_junit(const std::vector<Case>& cases);

/// A table in GitHub's Markdown with the causes of what failed, worst first.
std::string report_markdown(const std::vector<Case>& cases);

/// How bad a case is, for ranking: errors, then what cannot be compared, then failures by how far
/// they are beyond their limits. Larger is worse.
double severity(const Case& one);

/// Writes the page of one case, index.html, into `folder`, and thumbnails.png: both pictures and
/// their difference side by side, when it has pictures. `index` is a link back to the list of all
/// cases; empty: there is none. Throws Error (output).
void write_case_page(const std::filesystem::path& folder, const Case& one,
                     const std::string& index = "");

/// Writes report.json, junit.xml and, for several cases, index.html with the list of all, each with
/// a link to its page in folder/Case::folder. The cases need no pictures any more. A single case
/// without a folder of its own gets its page instead of the list. Throws Error (output).
void write_report(const std::filesystem::path& folder, const std::vector<Case>& cases);

}  // namespace penumbra
