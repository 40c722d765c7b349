// Cases <-> the documented JSON document.
#include "base/loss_tally.h"
#include "base/text/text.h"
#include "validation/report/markup.h"
#include "validation/report/report.h"

#include "penumbra/error.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string_view>
#include <utility>

namespace penumbra {
namespace {

using Json = nlohmann::ordered_json;
using markup::clean;

Json json_color(const Color& color) {
    Json result = Json::array();
    for (int i = 0; i < 3; ++i) result.push_back(color[i]);
    return result;
}

Json json_metrics(const Comparison& comparison) {
    Json result = Json::object();
    for (const Metric& metric : comparison.metrics) {
        Json& entry = result[clean(metric.name)];
        entry["value"] = metric.value;  // null when not finite
        entry["limit"] = metric.limit ? Json(*metric.limit) : Json(nullptr);
        entry["at_least"] = metric.at_least;
        entry["ok"] = metric.ok();
    }
    return result;
}

// Null when the pictures could not be measured.
Json json_pixel(const Comparison& comparison) {
    if (std::isnan(comparison.value("max_error"))) return nullptr;
    const PixelPair& worst = comparison.worst;
    Json result = {{"x", worst.x},
                   {"y", worst.y},
                   {"test", json_color(worst.test)},
                   {"reference", json_color(worst.reference)}};
    if (comparison.alpha == Alpha::counted) {
        result["test_alpha"] = worst.test_alpha;
        result["reference_alpha"] = worst.reference_alpha;
    }
    return result;
}

Json json_tiles(const Comparison& comparison) {
    Json result = Json::array();
    for (const Tile& tile : comparison.worst_tiles)
        result.push_back({{"x", tile.x}, {"y", tile.y}, {"side", tile.side}, {"flip", tile.flip}});
    return result;
}

Json json_losses(const Losses& losses) {
    Json result = Json::array();
    for (const Loss& loss : merged(losses))
        result.push_back({{"place", clean(loss.place)},
                          {"what", clean(loss.what)},
                          {"kind", to_string(loss.kind)},
                          {"count", loss.count}});
    return result;
}

Json json_strings(const std::vector<std::string>& strings) {
    Json result = Json::array();
    for (const std::string& string : strings) result.push_back(clean(string));
    return result;
}

Json json_sampling(const Sampling& sampling) {
    if (!sampling.antialiasing) return {{"samples", sampling.samples}};
    return {{"antialias", sampling.antialiasing->threshold},
            {"antialias_depth", sampling.antialiasing->depth}};
}

constexpr std::array alpha_words = {std::pair{Alpha::none, "none"},
                                    std::pair{Alpha::counted, "counted"},
                                    std::pair{Alpha::ignored, "ignored"}};

std::string to_string(Alpha alpha) {
    return std::ranges::find(alpha_words, alpha, [](const auto& entry) { return entry.first; })
        ->second;
}

Alpha alpha_of(std::string_view word) {
    const auto* const found =
        std::ranges::find(alpha_words, word, [](const auto& entry) { return entry.second; });
    return found == alpha_words.end() ? Alpha::none : found->first;
}

Json json_case(const Case& one) {
    Json result;
    const Comparison& comparison = one.comparison;
    result["name"] = clean(one.name);
    result["folder"] = clean(one.folder);
    result["test"] = clean(one.test_name);
    result["reference"] = clean(one.reference_name);
    if (one.sampling) result["sampling"] = json_sampling(*one.sampling);
    result["verdict"] = to_string(comparison.verdict);
    result["severity"] = severity(one);
    result["warn_band"] = comparison.warn_band;
    result["metrics"] = json_metrics(comparison);
    result["pixels"] = {{"compared", comparison.pixels}, {"differing", comparison.differing}};
    result["alpha"] = to_string(comparison.alpha);
    result["worst_pixel"] = json_pixel(comparison);
    result["worst_tiles"] = json_tiles(comparison);
    result["cause"] = clean(comparison.cause);
    result["diagnosis"] = json_strings(comparison.diagnosis);
    result["losses"] = json_losses(one.losses);
    result["seconds"] = Json::object();
    for (const auto& [step, seconds] : one.seconds) result["seconds"][clean(step)] = seconds;
    result["commands"] = json_strings(one.commands);
    result["files"] = Json::object();
    for (const auto& [role, file] : one.files) result["files"][clean(role)] = clean(file);
    result["cached"] = one.cached;
    if (!one.message.empty()) result["message"] = clean(one.message);
    return result;
}

// ---- and back -----------------------------------------------------------------------------------

Color color_of(const Json& json) { return {json.at(0), json.at(1), json.at(2)}; }

Verdict verdict_of(const std::string& word) {
    for (const Verdict verdict :
         {Verdict::pass, Verdict::warn, Verdict::fail, Verdict::not_comparable})
        if (to_string(verdict) == word) return verdict;
    return Verdict::error;
}

Loss::Kind kind_of(const std::string& word) {
    return word == to_string(Loss::approximated) ? Loss::approximated : Loss::dropped;
}

double number_of(const Json& json) {
    return json.is_null() ? std::numeric_limits<double>::quiet_NaN() : json.get<double>();
}

Sampling sampling_of(const Json& json) {
    if (json.contains("samples")) return {.samples = json.at("samples")};
    return {.antialiasing = Antialiasing{json.at("antialias"), json.at("antialias_depth")}};
}

Comparison comparison_of(const Json& json) {
    Comparison result;
    result.verdict = verdict_of(json.at("verdict"));
    result.warn_band = json.at("warn_band");
    for (const auto& [name, entry] : json.at("metrics").items()) {
        Metric metric = {.name = name,
                         .value = number_of(entry.at("value")),
                         .limit = {},
                         .at_least = entry.at("at_least")};
        if (!entry.at("limit").is_null()) metric.limit = entry.at("limit").get<double>();
        result.metrics.push_back(std::move(metric));
    }
    if (const Json& worst = json.at("worst_pixel"); !worst.is_null())
        result.worst = {worst.at("x"),
                        worst.at("y"),
                        color_of(worst.at("test")),
                        color_of(worst.at("reference")),
                        worst.value("test_alpha", 1.F),
                        worst.value("reference_alpha", 1.F)};
    result.alpha = alpha_of(json.value("alpha", "none"));
    if (json.contains("pixels")) {
        result.pixels = json.at("pixels").at("compared");
        result.differing = json.at("pixels").at("differing");
    }
    for (const Json& tile : json.at("worst_tiles"))
        result.worst_tiles.push_back(
            {tile.at("x"), tile.at("y"), tile.at("side"), tile.at("flip")});
    result.cause = json.at("cause");
    result.diagnosis = json.at("diagnosis").get<std::vector<std::string>>();
    return result;
}

}  // namespace

std::string report_json(const std::vector<Case>& cases) {
    Json document;
    document["version"] = 1;
    document["tool"] = {{"name", "penumbra"}, {"version", PENUMBRA_VERSION}};
    document["cases"] = Json::array();
    for (const Case& one : cases) document["cases"].push_back(json_case(one));
    return plain_json(document.dump(2)) + "\n";
}

std::vector<Case> cases_of_json(const std::string& text) {
    std::vector<Case> cases;
    try {
        const Json document = Json::parse(text);
        if (document.at("version") != 1) throw Error(Failure::input, "", "is not of version 1");
        for (const Json& json : document.at("cases")) {
            Case one;
            one.name = json.at("name");
            one.folder = json.at("folder");
            one.test_name = json.at("test");
            one.reference_name = json.at("reference");
            one.comparison = comparison_of(json);
            if (json.contains("sampling")) one.sampling = sampling_of(json.at("sampling"));
            for (const Json& loss : json.at("losses"))
                one.losses.push_back({kind_of(loss.at("kind")), loss.at("place"), loss.at("what"),
                                      loss.at("count")});
            one.seconds = json.at("seconds").get<std::map<std::string, double>>();
            one.commands = json.at("commands").get<std::vector<std::string>>();
            one.files = json.at("files").get<std::map<std::string, std::string>>();
            one.cached = json.at("cached");
            one.message = json.value("message", "");
            cases.push_back(std::move(one));
        }
    } catch (const nlohmann::json::exception& error) {
        throw Error(Failure::input, "", std::string("is no report of penumbra: ") + error.what());
    }
    return cases;
}

}  // namespace penumbra
