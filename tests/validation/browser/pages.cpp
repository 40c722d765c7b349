// Writes the reports that the browser test opens: report_pages FOLDER.
//
// The pictures follow formulas that report_test.py knows too.
#include "penumbra/compare.h"
#include "penumbra/image.h"
#include "penumbra/report.h"

#include <filesystem>
#include <iostream>
#include <string>
#include <vector>

using namespace penumbra;

namespace {

Color from_bytes(int r, int g, int b) {
    const auto linear = [](int byte) { return srgb_to_linear(float(byte) / 255); };
    return {linear(r), linear(g), linear(b)};
}

// A ramp, and in `reference` a box of it 20 steps brighter.
Image ramp(bool reference) {
    Image image(160, 120);
    for (int y = 0; y < 120; ++y)
        for (int x = 0; x < 160; ++x) {
            const bool inside = x >= 100 && x < 116 && y >= 40 && y < 56;
            const int more = reference && inside ? 20 : 0;
            image.at(x, y) = from_bytes(x + more, y + more, 200 - y + more);
        }
    return image;
}

Case ramp_case(const std::string& name) {
    Case one;
    one.name = one.folder = name;
    one.test = ramp(false);
    one.reference = ramp(true);
    one.comparison = compare(one.test, one.reference);
    one.losses = {{Loss::dropped, "ramp.gltf#/materials/0", "sheen is ignored"}};
    one.seconds = {{"import", 0.01}, {"render", 0.5}, {"export", 0.02}, {"povray", 1.25}};
    one.commands = {"penumbra validate --report out ramp.gltf", "povray ramp.ini"};
    one.files = {{"pov", name + "/ramp.pov"}, {"reference", name + "/povray.exr"}};
    one.povray_log = "POV-Ray finished\n" + std::string(300, '-') + "\n";
    return one;
}

Case same_case(const std::string& name) {
    Case one = ramp_case(name);
    one.reference = one.test;
    one.comparison = compare(one.test, one.reference);
    return one;
}

Case sizes_case() {
    Case one;
    one.name = one.folder = "sizes";
    one.test = ramp(false);
    one.reference = Image(80, 60);
    one.comparison = compare(one.test, one.reference);
    return one;
}

Case error_case() {
    Case one;
    one.name = one.folder = "broken";
    one.comparison.verdict = Verdict::error;
    one.message = "broken.pov:12: povray: Parse Error: No matching }, { found";
    one.povray_log = "Parse Error: No matching }, { found instead\n";
    return one;
}

// Every text of it tries to become markup.
Case hostile_case() {
    const std::string evil = "\"><img src=x onerror=alert(1)></script></title><script>alert(2)"
                             "</script><!-- '&amp; \x1b[31m \xe2\x80\xaegnp.exe \xff";
    Case one = ramp_case("hostile");
    one.folder = "a \"folder\" & more?#%";
    one.name = one.test_name = one.reference_name = one.povray_log = one.message = evil;
    one.losses = {{Loss::approximated, evil, evil}};
    one.commands = {evil};
    one.files = {{evil, "javascript:alert(3)"}};
    one.comparison.diagnosis = {evil};
    one.comparison.cause = evil;
    return one;
}

// Figures only, as a batch of `count` cases has them when its list is written.
std::vector<Case> batch(int count) {
    std::vector<Case> cases;
    const Case good = same_case("good"), bad = ramp_case("bad");
    for (int i = 0; i < count; ++i) {
        Case one = i % 5 == 3 ? bad : good;
        one.test = one.reference = one.comparison.flip_map = {};
        one.name = "model-" + std::to_string(i);
        one.folder = "model";  // one is enough
        one.seconds["render"] = double(i * 7919 % count) / 10;
        for (Metric& metric : one.comparison.metrics)
            if (metric.name == "ssim") metric.value -= double(i * 104729 % count) / count / 100;
        cases.push_back(one);
    }
    return cases;
}

void write(const std::filesystem::path& folder) {
    const std::vector<Case> cases = {same_case("same"), ramp_case("ramp"), sizes_case(),
                                     error_case(), hostile_case()};
    for (const Case& one : cases) write_case_page(folder / one.folder, one, "../index.html");
    write_report(folder, cases);
    Case single = ramp_case("single");
    single.folder = "";
    write_report(folder / "single", {single});
    write_case_page(folder / "thousand" / "model", single);
    write_report(folder / "thousand", batch(1000));
}

}  // namespace

int main(int count, char** arguments) {
    if (count != 2) {
        std::cerr << "usage: report_pages FOLDER\n";
        return 2;
    }
    write(arguments[1]);
}
