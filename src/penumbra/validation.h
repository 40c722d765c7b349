// Two images -> how far apart they are, and a report that shows it.
//
// `test` is ours, `reference` the other renderer's. Both are linear RGB.
#pragma once

#include "penumbra/error.h"
#include "penumbra/image.h"
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
    bool at_least = true;   ///< the limit is a minimum (else a maximum)
    /// A maximum limits the magnitude: `bias` has a sign.
    bool ok() const { return !limit || (at_least ? value >= *limit : std::abs(value) <= *limit); }
};

/// Limits of the verdict; a metric without a limit is only reported.
struct Limits {
    std::map<std::string, double> limits = {  ///< by metric name
        {"parity", 0.995}, {"ssim", 0.99}, {"flip", 0.01}, {"flip_tile", 0.045}};
};

/// The limits of a named profile: "strict", "equivalent" or "similar". Throws Error (usage).
Limits profile_limits(const std::string& name);

struct PixelPair {
    int x = 0, y = 0;
    Color test = Color(0), reference = Color(0);  ///< linear
};

struct Comparison {
    Verdict verdict = Verdict::error;
    std::vector<Metric> metrics = {};        ///< in a fixed order
    PixelPair worst = {};                    ///< where the largest linear channel difference is
    std::vector<std::string> diagnosis = {}; ///< sentences: why it differs or cannot be compared
    Image flip_map = {};                     ///< FLIP error per pixel, in all three channels

    /// The metric of that name; NaN when there is none.
    double value(const std::string& name) const;
};

struct CompareOptions {
    Limits limits = {};
    std::optional<Color> background = {};  ///< for coverage; the most frequent border colour if absent
};

/// Computes every figure of the parity rule. Unequal sizes, NaN and nearly empty pictures give
/// Verdict::not_comparable.
Comparison compare(const Image& test, const Image& reference, const CompareOptions& options = {});

/// |test - reference| x gain, linear. Precondition: equal sizes.
Image difference(const Image& test, const Image& reference, float gain);

/// FLIP values in [0, 1] as colours of the magma map.
Image heat_map(const Image& flip_map);

struct PovrayOptions {
    std::string binary = {};  ///< empty: PENUMBRA_POVRAY, else "povray" found in PATH
    int threads = 0;          ///< 0: as many as the machine has
    std::chrono::seconds timeout{600};
    bool keep_exr = true;     ///< keep the file that POV-Ray itself writes
};

struct PovrayRun {
    Image image = {};                         ///< its raw float32 pixels
    std::string log = {};                     ///< what it printed
    std::vector<std::string> command = {};    ///< the argument vector
    std::filesystem::path folder = {};        ///< where it ran
    double seconds = 0;                       ///< wall time
    double cpu_seconds = 0;                   ///< user + system
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
    Comparison comparison = {};
    std::string test_name = "penumbra", reference_name = "POV-Ray";
    Image test = {}, reference = {};
    Losses losses = {};
    std::map<std::string, double> seconds = {};      ///< import, render, export, povray, compare
    std::vector<std::string> commands = {};          ///< that repeat it
    std::map<std::string, std::string> files = {};   ///< role -> path relative to the report
    std::string povray_log = {};
    std::string message = {};                        ///< of a case that ended in an error
};

/// The documented JSON document: {"version": 1, "cases": [...]}.
std::string report_json(const std::vector<Case>& cases);

/// JUnit XML with one test case per Case.
std::string report_junit(const std::vector<Case>& cases);

/// Writes index.html, report.json and junit.xml into `folder`. Throws Error (output).
void write_report(const std::filesystem::path& folder, const std::vector<Case>& cases);

}  // namespace penumbra
