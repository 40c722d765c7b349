// Cases -> report.json, junit.xml and index.html.
#include "report.h"

#include "file.h"
#include "markup.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <system_error>
#include <utility>

namespace penumbra {
namespace {

using Json = nlohmann::ordered_json;
using markup::clean;
using markup::escaped;

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
    result["verdict"] = to_string(comparison.verdict);
    result["metrics"] = json_metrics(comparison);
    result["worst_pixel"] = json_pixel(comparison);
    result["diagnosis"] = json_strings(comparison.diagnosis);
    result["losses"] = json_losses(one.losses);
    result["seconds"] = Json::object();
    for (const auto& [step, seconds] : one.seconds) result["seconds"][clean(step)] = seconds;
    result["commands"] = json_strings(one.commands);
    result["files"] = Json::object();
    for (const auto& [role, file] : one.files) result["files"][clean(role)] = clean(file);
    if (!one.message.empty()) result["message"] = clean(one.message);
    return result;
}

double total_seconds(const Case& one) {
    double total = 0;
    for (const auto& [step, seconds] : one.seconds) total += seconds;
    return total;
}

std::string sentences(const Case& one) {
    std::string result;
    for (const std::string& sentence : one.comparison.diagnosis) result += sentence + "\n";
    return result;
}

// What JUnit calls the outcome of a test; "" for one that passed.
std::string junit_outcome(const Case& one) {
    std::string element = "failure", message = broken_limits(one.comparison);
    switch (one.comparison.verdict) {
    case Verdict::pass:
    case Verdict::warn: return "";
    case Verdict::fail: break;
    case Verdict::not_comparable:
        message = one.comparison.diagnosis.empty() ? "" : one.comparison.diagnosis.front();
        break;
    case Verdict::error:
        element = "error";
        message = one.message;
        break;
    }
    return fmt::format("      <{0} type=\"{1}\" message=\"{2}\">{3}</{0}>\n", element,
                       to_string(one.comparison.verdict), escaped(message),
                       escaped(sentences(one)));
}

std::string junit_case(const Case& one) {
    std::string figures = to_string(one.comparison.verdict) + "\n";
    for (const Metric& metric : one.comparison.metrics)
        figures += fmt::format("{} {}{}\n", metric.name, markup::number(metric.value),
                               !metric.limit
                                   ? ""
                                   : fmt::format(" (limit {}{})", metric.at_least ? ">= " : "<= ",
                                                 markup::number(*metric.limit)));
    return fmt::format("    <testcase classname=\"penumbra\" name=\"{}\" time=\"{:.3f}\">\n{}"
                       "      <system-out>{}</system-out>\n    </testcase>\n",
                       escaped(one.name), total_seconds(one), junit_outcome(one), escaped(figures));
}

}  // namespace

std::vector<CountedLoss> counted(const Losses& losses) {
    std::vector<CountedLoss> result;
    std::map<std::pair<std::string, std::string>, std::size_t> known;
    for (const Loss& loss : losses) {
        const auto [entry, is_new] = known.try_emplace({loss.place, loss.what}, result.size());
        if (is_new)
            result.push_back({loss, 1});
        else
            ++result[entry->second].count;
    }
    return result;
}

std::string broken_limits(const Comparison& comparison) {
    std::string result;
    for (const Metric& metric : comparison.metrics) {
        if (metric.ok()) continue;
        if (!result.empty()) result += "; ";
        result += fmt::format("{} {}, limit {} {}", metric.name, markup::number(metric.value),
                              metric.at_least ? ">=" : "<=", markup::number(*metric.limit));
    }
    return result;
}

std::string report_json(const std::vector<Case>& cases) {
    Json document;
    document["version"] = 1;
    document["tool"] = {{"name", "penumbra"}, {"version", PENUMBRA_VERSION}};
    document["cases"] = Json::array();
    for (const Case& one : cases) document["cases"].push_back(json_case(one));
    return document.dump(2) + "\n";
}

std::string report_junit(const std::vector<Case>& cases) {
    const auto count = [&](auto... verdicts) {
        return std::ranges::count_if(
            cases, [&](const Case& one) { return ((one.comparison.verdict == verdicts) || ...); });
    };
    double seconds = 0;
    std::string body;
    for (const Case& one : cases) {
        seconds += total_seconds(one);
        body += junit_case(one);
    }
    const std::string totals =
        fmt::format("tests=\"{}\" failures=\"{}\" errors=\"{}\" time=\"{:.3f}\"", cases.size(),
                    count(Verdict::fail, Verdict::not_comparable), count(Verdict::error), seconds);
    return fmt::format("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites {0}>\n"
                       "  <testsuite name=\"penumbra\" {0}>\n{1}  </testsuite>\n</testsuites>\n",
                       totals, body);
}

void write_report(const std::filesystem::path& folder, const std::vector<Case>& cases) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error)
        throw Error(Failure::output, folder.string(), "cannot make the folder: " + error.message());
    write_file(folder / "report.json", report_json(cases));
    write_file(folder / "junit.xml", report_junit(cases));
    write_file(folder / "index.html", report_html(cases));
}

}  // namespace penumbra
