// Cases that tests of the report make documents of, and what they check of any document.
#pragma once

#include "support/pictures.h"

#include "penumbra/compare.h"
#include "penumbra/report.h"

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

namespace test {

using penumbra::Case;

inline Image ball(int w, int h, float brightness) {
    Image image(w, h);
    for (int y = 0; y < h; ++y)
        for (int x = 0; x < w; ++x)
            if (std::hypot(x - w * 0.45, y - h * 0.5) < h * 0.4)
                image.at(x, y) =
                    Color(0.8F, 0.5F, 0.2F) * brightness * (0.2F + 0.8F * float(x) / float(w));
    return image;
}

inline Case ball_case(const std::string& name, float brightness) {
    Case one;
    one.name = name;
    one.test = ball(64, 48, brightness);
    one.reference = ball(64, 48, 1);
    one.comparison = compare(one.test, one.reference);
    one.losses = {{penumbra::Loss::dropped, "a.gltf#/materials/0", "sheen is ignored"},
                  {penumbra::Loss::dropped, "a.gltf#/materials/1", "sheen is ignored"},
                  {penumbra::Loss::dropped, "a.gltf#/materials/0", "sheen is ignored"}};
    one.seconds = {{"import", 0.25}, {"render", 1.5}, {"povray", 2}};
    one.commands = {"penumbra validate a.gltf"};
    one.files = {{"pov", "a.pov"}, {"reference", "povray.exr"}};
    one.povray_log = "POV-Ray finished\n";
    return one;
}

inline Case broken_case() {
    Case one;
    one.name = "broken";
    one.message = "povray: not found";
    one.comparison.verdict = penumbra::Verdict::error;
    return one;
}

inline Case empty_case() {
    Case one;
    one.name = "empty";
    one.test = one.reference = Image(16, 16);
    one.comparison = compare(one.test, one.reference);
    return one;
}

// A text that breaks out of everything that is not escaped.
inline const std::string evil = "<script>alert(1)</script>\"'&]]>\x01\xff{}";

inline Case evil_case() {
    Case one = ball_case(evil, 2);
    one.test_name = one.reference_name = one.povray_log = one.message = evil;
    one.losses = {{penumbra::Loss::approximated, evil, evil}};
    one.commands = {evil};
    one.files = {{evil, "javascript:" + evil}};
    one.seconds[evil] = 1;
    one.comparison.diagnosis = {evil};
    return one;
}

// Elements nest, attributes are quoted, only known entities occur, no character is forbidden.
inline std::string xml_defect(const std::string& text) {
    std::vector<std::string> open;
    for (std::size_t i = 0; i < text.size();) {
        if (std::uint8_t(text[i]) < 0x20 && text[i] != '\n') return "control character";
        if (text[i] == '&') {
            const std::string name = text.substr(i + 1, text.find(';', i) - i - 1);
            if (name != "amp" && name != "lt" && name != "gt" && name != "quot" && name != "#39")
                return "entity " + name;
        }
        if (text[i] != '<') {
            ++i;
            continue;
        }
        std::size_t end = i;
        for (bool quoted = false; end < text.size() && (quoted || text[end] != '>'); ++end) {
            if (text[end] == '"') quoted = !quoted;
            if (quoted && text[end] == '<') return "< in an attribute";
        }
        const std::string tag = text.substr(i + 1, end - i - 1);
        i = end + 1;
        if (tag.starts_with('?') || tag.starts_with('!') || tag.ends_with('/')) continue;
        const std::string name = tag.substr(0, tag.find_first_of(" \n"));
        if (!name.starts_with('/'))
            open.push_back(name);
        else if (open.empty() || "/" + open.back() != name)
            return "unexpected " + name;
        else
            open.pop_back();
    }
    return open.empty() ? "" : "unclosed " + open.back();
}

}  // namespace test
