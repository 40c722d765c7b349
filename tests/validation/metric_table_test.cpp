// The table of metrics, and what is judged by it.
#include "support/pictures.h"
#include "support/support.h"
#include "validation/compare/metric_table.h"

#include "penumbra/compare.h"

#include <cmath>
#include <cstdlib>
#include <map>
#include <sstream>
#include <string>
#include <vector>

using namespace penumbra;
using test::disc;
using test::has;
using test::joined;

TEST_CASE("Every metric of a comparison has its entry in the table, in its order") {
    // Bright enough for HDR-FLIP, and with edges: everything is measured.
    const Comparison result = compare(disc(64, 48, Color(3)), disc(64, 48, Color(2)));
    const std::string document = test::read(test::fs::path(PENUMBRA_SOURCE_DIR) / "docs/json.md");
    REQUIRE(result.metrics.size() == metrics::metric_kinds().size());
    for (std::size_t i = 0; i < result.metrics.size(); ++i) {
        const Metric& metric = result.metrics[i];
        const metrics::MetricKind& kind = metrics::metric_kinds()[i];
        INFO(metric.name);
        CHECK(metric.name == kind.name);
        CHECK(std::isfinite(metric.value));
        CHECK(metric.at_least == kind.at_least);
        CHECK(metrics::metric_kind(metric.name) == &kind);
        CHECK(kind.description.empty() == metric.name.ends_with("_covered"));
        CHECK(has(document, "`" + metric.name + "`"));
    }
    CHECK(metrics::metric_kind("psnr") == nullptr);
}

TEST_CASE("Figures come in a fixed order with their limits") {
    const Comparison result = compare(disc(32, 32), disc(32, 32));
    std::vector<std::string> names;
    for (const Metric& metric : result.metrics) names.push_back(metric.name);
    CHECK(joined(names) == "parity\nexactness\nmax_error\nrmse\npsnr_db\nssim\nssim_tile\nflip\n"
                           "flip_p99\nflip_tile\nbias\ncoverage\noutliers\nparity_covered\n"
                           "rmse_covered\npsnr_db_covered\nssim_covered\nflip_covered\n"
                           "bias_covered\nedges\nparity_edges\nflip_edges\nparity_inside\n"
                           "hdr_flip\n");
    CHECK(result.metrics[0].limit == 0.995);
    CHECK(result.metrics[0].at_least);
    CHECK_FALSE(result.metrics[1].limit);
    CHECK(result.metrics[7].limit == 0.01);
    CHECK_FALSE(result.metrics[7].at_least);
}

TEST_CASE("A limit for an unknown metric is refused") {
    CompareOptions options;
    options.limits.limits = {{"psnr", 40}};
    CHECK(test::message_of([&] { compare(disc(8, 8), disc(8, 8), options); }) ==
          "unknown metric 'psnr' (known: parity, exactness, max_error, rmse, psnr_db, ssim, "
          "ssim_tile, flip, flip_p99, flip_tile, bias, coverage, outliers, parity_covered, "
          "rmse_covered, psnr_db_covered, ssim_covered, flip_covered, bias_covered, edges, "
          "parity_edges, flip_edges, parity_inside, hdr_flip)");
}

TEST_CASE("The part of a limit that a metric uses is 1 at the limit and no number without one") {
    using metrics::limit_use;
    CHECK(limit_use({"parity", 0.9, 0.8, true}) == Approx(0.5));
    CHECK(limit_use({"flip", 0.03, 0.01, false}) == Approx(3));
    CHECK(limit_use({"bias", -0.01, 0.01, false}) == Approx(1));
    CHECK(limit_use({"psnr_db", 46, 40, true}) == Approx(0.5).margin(0.002));  // half the RMSE
    CHECK(limit_use({"psnr_db_covered", 40, 40, true}) == Approx(1));
    CHECK(limit_use({"a later version's", 0.9, 0.8, true}) == Approx(0.5));
    CHECK(std::isnan(limit_use({"coverage", 0.9, 0.01, true})));
    CHECK(std::isnan(limit_use({"parity", 0.9, {}, true})));
}

TEST_CASE("Profiles go from strict to similar") {
    CHECK(profile_limits("equivalent").limits.at("flip_tile") == 0.045);
    CHECK(profile_limits("strict").limits.at("psnr_db") == 48);
    CHECK(profile_limits("similar").limits.at("bias") == 0.01);
    for (const auto& [name, limit] : profile_limits("similar").limits) {
        const bool at_least = name == "psnr_db" || name == "ssim" || name == "ssim_tile";
        const double middle = profile_limits("equivalent").limits.at(name);
        const double tight = profile_limits("strict").limits.at(name);
        CHECK((at_least ? limit < middle && middle < tight : limit > middle && middle > tight));
    }
    CHECK(profile_limits("strict").limits.at("parity") >
          profile_limits("equivalent").limits.at("parity"));
    CHECK(test::message_of([] { profile_limits("lax"); }) ==
          "unknown profile 'lax' (strict, equivalent or similar)");
}

TEST_CASE("The limits in docs/json.md are those of the program") {
    // Rows read "| `flip` | 0.01 | 0.006 | 0.01 | 0.045 |"; an empty cell is no limit.
    std::map<std::string, double> columns[4];
    std::istringstream lines(test::read(test::fs::path(PENUMBRA_SOURCE_DIR) / "docs/json.md"));
    bool inside = false;
    for (std::string line; std::getline(lines, line);) {
        if (line.starts_with("| figure | default |"))
            inside = true;
        else if (line.empty())
            inside = false;
        else if (inside && line.starts_with("| `")) {
            std::istringstream cells(line.substr(line.find('|', 1) + 1));
            const std::string name = line.substr(3, line.find('`', 3) - 3);
            for (auto& column : columns) {
                std::string cell;
                std::getline(cells, cell, '|');
                if (cell.find_first_not_of(' ') != std::string::npos)
                    column[name] = std::strtod(cell.c_str(), nullptr);
            }
        }
    }
    CHECK(columns[0] == Limits().limits);
    for (const auto& [name, limit] : columns[0]) CHECK(columns[2].at(name) == limit);
    CHECK(columns[1] == profile_limits("strict").limits);
    CHECK(columns[2] == profile_limits("equivalent").limits);
    CHECK(columns[3] == profile_limits("similar").limits);
}
