// Cases <-> the documented JSON document.
#include "markup.h"
#include "plain_text.h"
#include "report.h"

#include "penumbra/error.h"

#include <nlohmann/json.hpp>

#include <array>
#include <cmath>
#include <limits>

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
    return {{"x", worst.x},
            {"y", worst.y},
            {"test", json_color(worst.test)},
            {"reference", json_color(worst.reference)}};
}

Json json_tiles(const Comparison& comparison) {
    Json result = Json::array();
    for (const Tile& tile : comparison.worst_tiles)
        result.push_back({{"x", tile.x}, {"y", tile.y}, {"side", tile.side}, {"flip", tile.flip}});
    return result;
}

Json json_losses(const Losses& losses) {
    Json result = Json::array();
    for (const CountedLoss& loss : counted(losses))
        result.push_back({{"place", clean(loss.loss.place)},
                          {"what", clean(loss.loss.what)},
                          {"count", loss.count}});
    return result;
}

Json json_strings(const std::vector<std::string>& strings) {
    Json result = Json::array();
    for (const std::string& string : strings) result.push_back(clean(string));
    return result;
}

Json json_case(const Case& one) {
    Json result;
    const Comparison& comparison = one.comparison;
    result["name"] = clean(one.name);
    result["folder"] = clean(one.folder);
    result["test"] = clean(one.test_name);
    result["reference"] = clean(one.reference_name);
    result["verdict"] = to_string(comparison.verdict);
    result["severity"] = severity(one);
    result["warn_band"] = comparison.warn_band;
    result["metrics"] = json_metrics(comparison);
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

Color color_of(const Json& json) { return {json[0], json[1], json[2]}; }

Verdict verdict_of(const std::string& word) {
    for (const Verdict verdict :
         {Verdict::pass, Verdict::warn, Verdict::fail, Verdict::not_comparable})
        if (to_string(verdict) == word) return verdict;
    return Verdict::error;
}

double number_of(const Json& json) {
    return json.is_null() ? std::numeric_limits<double>::quiet_NaN() : json.get<double>();
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
        result.worst = {worst.at("x"), worst.at("y"), color_of(worst.at("test")),
                        color_of(worst.at("reference"))};
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
            for (const Json& loss : json.at("losses"))
                one.losses.insert(one.losses.end(), loss.at("count").get<std::size_t>(),
                                  {loss.at("place"), loss.at("what")});
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
