// JSON -> JSON that can be trusted.
#include "importers/gltf/document/checks.h"
#include "importers/gltf/document/document.h"
#include "importers/gltf/document/schema.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace penumbra::gltf {
namespace {

using nlohmann::json;

// A JSON pointer under construction, from the value back to the root; most are never written.
struct Step {
    const Step* up = nullptr;
    std::string key = {};
};

std::string pointer(const Step* step) {
    std::string path;
    for (; step != nullptr; step = step->up) {
        if (step->up == nullptr && step->key.empty()) break;
        path.insert(0, '/' + printable(step->key));
    }
    return path;
}

std::string out_of_range(const json& value, const Rule& rule) {
    const double number = value.get<double>();
    if (number < rule.low && rule.low > -largest_float)
        return fmt::format("is {}, less than {}", value.dump(), rule.low);
    return fmt::format("is {}, more than {:.6g}", value.dump(), rule.high);
}

struct Checker {
    json& root;
    const std::string& file;
    Losses& losses;

    [[noreturn]] void fail(const Step* at, const std::string& problem) const {
        throw Error(Failure::input, file + '#' + pointer(at), problem);
    }

    void follow(json& value, std::string_view path, const Rule& rule, const Step* at);
    void child(json& parent, std::string_view key, std::string_view rest, const Rule& rule,
               const Step* at);
    void apply(json& value, const Rule& rule, const Step* at);
    void whole_number(json& value, const Rule& rule, const Step* at) const;
    double checked_number(const json& value, const Rule& rule, const Step* at) const;
    void array_of_numbers(const json& value, const Rule& rule, const Step* at) const;
    void bring_into_range(json& value, const Rule& rule, const Step* at);
    void cameras() const;
    void channels() const;
};

void Checker::follow(json& value, std::string_view path, const Rule& rule, const Step* at) {
    if (path.empty()) return apply(value, rule, at);
    path.remove_prefix(1);  // the slash
    const std::size_t end = std::min(path.find('/'), path.size());
    const std::string_view key = path.substr(0, end), rest = path.substr(end);
    if (key == "*") {
        if (!value.is_array()) fail(at, "must be an array");
        for (std::size_t i = 0; i < value.size(); ++i) {
            const Step step = {at, std::to_string(i)};
            follow(value[i], rest, rule, &step);
        }
        return;
    }
    if (!value.is_object()) fail(at, "must be an object");
    if (key == "@") {
        for (auto& [name, member] : value.items()) {
            const Step step = {at, name};
            follow(member, rest, rule, &step);
        }
        return;
    }
    child(value, key, rest, rule, at);
}

void Checker::child(json& parent, std::string_view key, std::string_view rest, const Rule& rule,
                    const Step* at) {
    const bool required = key.back() == '!';
    if (required) key.remove_suffix(1);
    const auto found = parent.find(key);
    if (found == parent.end()) {
        if (required) fail(at, fmt::format("has no '{}'", key));
        return;
    }
    const Step step = {at, std::string(key)};
    follow(*found, rest, rule, &step);
}

void Checker::apply(json& value, const Rule& rule, const Step* at) {
    switch (rule.kind) {
    case Kind::reference:
    case Kind::whole: return whole_number(value, rule, at);
    case Kind::number: checked_number(value, rule, at); return;
    case Kind::numbers: return array_of_numbers(value, rule, at);
    case Kind::factor: return bring_into_range(value, rule, at);
    case Kind::text:
        if (!value.is_string()) fail(at, "must be a string");
        return;
    case Kind::flag:
        if (!value.is_boolean()) fail(at, "must be true or false");
        return;
    case Kind::object:
        if (!value.is_object()) fail(at, "must be an object");
        return;
    case Kind::choice:
        if (!value.is_string()) fail(at, "must be a string");
        const std::string word = value.get<std::string>();
        const std::string known = fmt::format(" {} ", rule.to);
        if (word.find(' ') != std::string::npos ||
            known.find(' ' + word + ' ') == std::string::npos)
            fail(at, fmt::format("is '{}', which is none of {}", printable(word), rule.to));
        return;
    }
}

// Writes 2.0 as 2: JSON does not tell them apart, tinygltf does.
void Checker::whole_number(json& value, const Rule& rule, const Step* at) const {
    if (value.is_number_float()) {
        const double number = value.get<double>();
        if (number == std::floor(number) && std::abs(number) <= largest_size)
            value = std::int64_t(number);
    }
    if (!value.is_number_integer()) fail(at, "must be a whole number");
    const bool negative = !value.is_number_unsigned() && value.get<std::int64_t>() < 0;
    const double number =
        negative ? double(value.get<std::int64_t>()) : double(value.get<std::uint64_t>());
    if (rule.kind == Kind::reference) {
        const auto target = json::json_pointer(std::string(rule.to));
        const std::size_t size =
            root.contains(target) && root[target].is_array() ? root[target].size() : 0;
        if (negative || number >= double(size)) {
            const std::string_view things = rule.to.substr(rule.to.rfind('/') + 1);
            fail(at, fmt::format("is {}, but the file has {} {}", value.dump(), size, things));
        }
    } else if (number < rule.low || number > rule.high) {
        fail(at, out_of_range(value, rule));
    }
}

double Checker::checked_number(const json& value, const Rule& rule, const Step* at) const {
    if (!value.is_number()) fail(at, "must be a number");
    const double number = value.get<double>();
    if (!(number >= rule.low && number <= rule.high)) fail(at, out_of_range(value, rule));
    return number;
}

void Checker::array_of_numbers(const json& value, const Rule& rule, const Step* at) const {
    if (!value.is_array()) fail(at, "must be an array");
    if (rule.length != 0 && value.size() != std::size_t(rule.length))
        fail(at, fmt::format("has {} numbers instead of {}", value.size(), rule.length));
    for (std::size_t i = 0; i < value.size(); ++i) {
        const Step step = {at, std::to_string(i)};
        checked_number(value[i], rule, &step);
    }
}

void Checker::bring_into_range(json& value, const Rule& rule, const Step* at) {
    const Rule any = {.path = {}, .kind = Kind::numbers, .length = rule.length};
    if (rule.length == 0)
        checked_number(value, any, at);
    else
        array_of_numbers(value, any, at);

    const std::string before = value.dump();
    bool outside = false;
    const auto bring = [&](json& number) {
        const double given = number.get<double>();
        if (given >= rule.low && given <= rule.high) return;
        number = std::clamp(given, rule.low, rule.high);
        outside = true;
    };
    if (value.is_array())
        std::for_each(value.begin(), value.end(), bring);
    else
        bring(value);
    if (outside)
        losses.push_back(
            {Loss::approximated, file + '#' + pointer(at),
             fmt::format("{} is outside 0 to {}; {} is used", before, rule.high, value.dump())});
}

// What a camera must have depends on its type.
void Checker::cameras() const {
    for (std::size_t i = 0; root.contains("cameras") && i < root["cameras"].size(); ++i) {
        const auto type = root["cameras"][i]["type"].get<std::string>();
        if (!root["cameras"][i].contains(type))
            throw Error(Failure::input, fmt::format("{}#/cameras/{}", file, i),
                        fmt::format("has no '{}'", type));
    }
}

// A channel counts the samplers of its own animation.
void Checker::channels() const {
    for (std::size_t a = 0; root.contains("animations") && a < root["animations"].size(); ++a) {
        const json& animation = root["animations"][a];
        const std::size_t samplers = animation["samplers"].size();
        for (std::size_t c = 0; c < animation["channels"].size(); ++c)
            if (const auto index = animation["channels"][c]["sampler"].get<std::size_t>();
                index >= samplers)
                throw Error(
                    Failure::input,
                    fmt::format("{}#/animations/{}/channels/{}/sampler", file, a, c),
                    fmt::format("is {}, but the animation has {} samplers", index, samplers));
    }
}

}  // namespace

void check_schema(json& root, const std::string& file, Losses& losses) {
    Checker checker{root, file, losses};
    const Step start;
    if (root.contains("scene") && !root.contains("scenes")) {
        losses.push_back({Loss::approximated, file + "#/scene",
                          "the file has no scenes; all its nodes are shown"});
        root.erase("scene");
    }
    for (const Rule& rule : schema) checker.follow(root, rule.path, rule, &start);
    for (const std::string_view texture : texture_references)
        for (const Rule& rule : texture_members) {
            const std::string path = std::string(texture).append(rule.path);
            checker.follow(root, path, rule, &start);
        }
    checker.cameras();
    checker.channels();
}

}  // namespace penumbra::gltf
