// Comparisons -> a report to look into.
#pragma once

#include "penumbra/compare.h"
#include "penumbra/render_options.h"

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace penumbra {

/// One compared pair, with all that a report says of it.
struct Case {
    std::string name = {};
    std::string folder = {};  ///< of its files, relative to the report; empty: the report's own
    Comparison comparison = {};
    std::string test_name = "penumbra", reference_name = "POV-Ray";
    Image test = {}, reference = {};
    std::optional<Sampling> sampling = {};  ///< of a rendered scene
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

/// The cases of such a document, without their pictures. Throws Error (input) for any other text.
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
