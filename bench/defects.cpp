// The defect study of docs/validation.md: what the limits catch, what they let pass, and how often
// the diagnosis names the cause.
//
//   penumbra-defects [--size WxH] [--scene TEXT] [--defect TEXT] [--save FOLDER] [--write FILE]
//                    SCENE...
//
// Every scene is rendered as it is and with each defect that it can show; the latter is what
// another renderer with that fault would give. Prints the tables, or puts them between the markers
// of FILE.
#include "defect_kinds.h"

#include "penumbra/compare.h"
#include "penumbra/exporters.h"
#include "penumbra/importers.h"
#include "penumbra/povray.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <map>
#include <stdexcept>

namespace {

using namespace defects;
namespace fs = std::filesystem;

struct Arguments {
    std::string size = "240,180", scene = {}, defect = {}, save = {};
    fs::path document = {};
    std::vector<fs::path> scenes = {};
};

Arguments parse(int count, char** words) {
    Arguments arguments;
    for (int i = 1; i < count; ++i) {
        const std::string word = words[i];
        const auto value = [&] { return std::string(i + 1 < count ? words[++i] : ""); };
        if (word == "--size") {
            arguments.size = value();
            std::ranges::replace(arguments.size, 'x', ',');
        } else if (word == "--scene") {
            arguments.scene = value();
        } else if (word == "--defect") {
            arguments.defect = value();
        } else if (word == "--write") {
            arguments.document = value();
        } else if (word == "--save") {
            arguments.save = value();
        } else {
            arguments.scenes.emplace_back(word);
        }
    }
    return arguments;
}

double now() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
}

// ---- measuring --------------------------------------------------------------------------------

// The limits of `penumbra validate`, of `penumbra compare`, and of one rule alone.
const std::map<std::string, double>& default_limits() {
    static const Limits limits;
    return limits.limits;
}

const std::map<std::string, double>& profile() {
    static const Limits limits = profile_limits("equivalent");
    return limits.limits;
}

// How many times the error that a limit allows a figure has; beyond 1 it fails.
double excess(const Comparison& comparison, const std::string& name, double limit) {
    const double value = comparison.value(name);
    if (std::isnan(value)) return INFINITY;
    if (name == "psnr_db") return std::pow(10, (limit - value) / 20);
    const bool at_least = name == "parity" || name.starts_with("ssim");
    return at_least ? (1 - value) / (1 - limit) : std::abs(value) / limit;
}

struct Excess {
    double times = 0;
    std::string rule = {};
};

Excess largest(const Comparison& comparison, const std::map<std::string, double>& limits) {
    Excess result;
    for (const auto& [name, limit] : limits)
        if (const double times = excess(comparison, name, limit); times > result.times)
            result = {times, name};
    return result;
}

struct Outcome {
    std::string scene = {}, defect = {};
    Comparison comparison = {};
    bool named = false;
    double render_seconds = 0, explain_seconds = 0;

    bool caught(const std::map<std::string, double>& limits) const {
        return largest(comparison, limits).times > 1;
    }
};

Outcome judge(const Stage& stage, const Defect& defect, const Arguments& arguments) {
    Outcome outcome = {.scene = stage.name, .defect = defect.name};
    const double start = now();
    const Image reference = defect.make(stage);
    outcome.render_seconds = now() - start;
    Limits limits;
    limits.limits = profile();
    outcome.comparison = compare(stage.picture, reference,
                                 {.limits = limits, .background = stage.scene.scene.background});
    const double compared = now();
    explain(stage.scene, stage.options, stage.picture, reference, outcome.comparison);
    outcome.explain_seconds = now() - compared;
    outcome.named = defect.causes.contains(outcome.comparison.cause);
    if (!arguments.save.empty()) {
        fs::create_directories(arguments.save);
        save_image(fs::path(arguments.save) / (stage.name + " " + defect.name + ".png"), reference);
    }
    outcome.comparison.flip_map = {};
    return outcome;
}

// ---- pairs that are meant to be the same ------------------------------------------------------

struct Good {
    std::string kind = {}, profile = {}, scene = {};
    Comparison comparison = {};
};

Image of_povray(const Stage& stage, const RenderOptions& options) {
    const fs::path folder =
        fs::temp_directory_path() / fmt::format("penumbra-defects-{}", getpid());
    fs::create_directories(folder);
    write_pov(stage.scene, options, folder / "scene.pov");
    Image result =
        run_povray(folder / "scene.ini", options.width, options.height, {.keep_exr = false}).image;
    fs::remove_all(folder);
    return result;
}

Image of_eight_bits(const Image& image) {
    Image result = image;
    for (Color& color : result.pixels)
        for (int c = 0; c < 3; ++c) {
            const float shown = linear_to_srgb(std::clamp(color[c], 0.F, 1.F));
            color[c] = srgb_to_linear(std::round(shown * 255) / 255);
        }
    return result;
}

void add_good_pairs(const Stage& stage, std::vector<Good>& pairs) {
    const auto add = [&](const std::string& kind, const std::string& name, const Image& test,
                         const Image& reference) {
        pairs.push_back({kind, name, stage.name,
                         compare(test, reference,
                                 {.limits = profile_limits(name),
                                  .background = stage.scene.scene.background})});
        pairs.back().comparison.flip_map = {};
    };
    const auto sampled = [&](int samples) {
        RenderOptions options = stage.options;
        options.samples = samples;
        return options;
    };
    const auto ours = [&](int samples) { return render(stage.scene, sampled(samples)); };
    const Image fine = ours(3);
    add("8 bits against float", "equivalent", stage.picture, of_eight_bits(stage.picture));
    add("3 x 3 samples against 4 x 4", "similar", fine, ours(4));
    add("3 x 3 samples against 9 x 9", "similar", fine, ours(9));
    try {
        add("POV-Ray", "equivalent", stage.picture, of_povray(stage, stage.options));
        add("POV-Ray, 3 x 3 samples", "equivalent", fine, of_povray(stage, sampled(3)));
    } catch (const Error& error) {
        fmt::print(stderr, "{}: {}\n", stage.name, error.what());
    }
}

// ---- tables -----------------------------------------------------------------------------------

std::string percent(std::size_t part, std::size_t all) {
    return fmt::format("{} of {} ({:.1f} %)", part, all, 100.0 * double(part) / double(all));
}

std::string defect_table(const std::vector<Outcome>& outcomes) {
    std::string text =
        "| defect | scenes | caught | named | weakest alarm |\n|---|---|---|---|---|\n";
    for (const Defect& defect : all_defects()) {
        int count = 0, caught = 0, named = 0;
        Excess weakest = {INFINITY, ""};
        for (const Outcome& o : outcomes) {
            if (o.defect != defect.name) continue;
            ++count;
            const Excess alarm = largest(o.comparison, profile());
            caught += alarm.times > 1;
            named += alarm.times > 1 && o.named;
            if (alarm.times < weakest.times) weakest = alarm;
        }
        if (count > 0)
            text += fmt::format("| {} | {} | {} | {} | {:.1f} x `{}` |\n", defect.name, count,
                                caught, named, weakest.times, weakest.rule);
    }
    return text;
}

std::string rule_table(const std::vector<Outcome>& outcomes, const std::vector<Good>& pairs) {
    std::string text = "| rule | catches | false alarms |\n|---|---|---|\n";
    const auto row = [&](const std::string& name, const std::map<std::string, double>& limits) {
        std::size_t caught = 0, alarms = 0;
        for (const Outcome& o : outcomes) caught += o.caught(limits);
        for (const Good& pair : pairs)
            if (pair.profile == "equivalent") alarms += largest(pair.comparison, limits).times > 1;
        text += fmt::format("| {} | {} | {} |\n", name, percent(caught, outcomes.size()), alarms);
    };
    row("all of `equivalent` (`compare`)", profile());
    row("`validate`: parity, ssim, flip, flip_tile", default_limits());
    for (const auto& [name, limit] : profile())
        row(fmt::format("`{}` {} alone", name, limit), {{name, limit}});
    return text;
}

std::string good_table(const std::vector<Good>& pairs) {
    std::string text = "| pair | profile | scenes | false alarms | nearest to an alarm |\n"
                       "|---|---|---|---|---|\n";
    std::vector<std::string> kinds;
    for (const Good& pair : pairs)
        if (std::ranges::find(kinds, pair.kind) == kinds.end()) kinds.push_back(pair.kind);
    for (const std::string& kind : kinds) {
        int count = 0, alarms = 0;
        std::string name;
        Excess nearest;
        for (const Good& pair : pairs) {
            if (pair.kind != kind) continue;
            ++count;
            name = pair.profile;
            const Verdict verdict = pair.comparison.verdict;
            alarms += verdict != Verdict::pass && verdict != Verdict::warn;
            const Excess found = largest(pair.comparison, profile_limits(name).limits);
            if (found.times > nearest.times || nearest.rule.empty()) nearest = found;
        }
        text += fmt::format("| {} | `{}` | {} | {} | {:.2f} of `{}` |\n", kind, name, count, alarms,
                            nearest.times, nearest.rule);
    }
    return text;
}

std::string document(const std::vector<Outcome>& outcomes, const std::vector<Good>& pairs,
                     std::size_t scenes, const std::string& size) {
    std::size_t caught = 0, named = 0;
    std::string missed, unnamed;
    for (const Outcome& o : outcomes) {
        if (!o.caught(profile())) {
            missed += fmt::format("{}{} in {}", missed.empty() ? "" : "; ", o.defect, o.scene);
            continue;
        }
        ++caught;
        named += o.named;
        if (!o.named)
            unnamed +=
                fmt::format("{}{} in {} ({})", unnamed.empty() ? "" : "; ", o.defect, o.scene,
                            o.comparison.cause.empty() ? "nothing" : o.comparison.cause);
    }
    std::string text = fmt::format(
        "{} scenes at {}x{}, {} pictures with a defect, written by `penumbra-defects`. Caught: {}; "
        "of these named: {}.\n\n",
        scenes, size.substr(0, size.find(',')), size.substr(size.find(',') + 1), outcomes.size(),
        percent(caught, outcomes.size()), percent(named, std::max<std::size_t>(caught, 1)));
    text += defect_table(outcomes);
    text += "\nThe weakest alarm is that of the scene where the defect shows least: how many times "
            "the error that the limit allows the worst figure has.\n\n";
    text += fmt::format("Missed: {}. Named wrongly (what instead): {}.\n\n",
                        missed.empty() ? "none" : missed, unnamed.empty() ? "none" : unnamed);
    text += rule_table(outcomes, pairs) + "\n" + good_table(pairs);
    return text;
}

void write_document(const fs::path& file, const std::string& text) {
    std::ifstream in(file, std::ios::binary);
    std::string all{std::istreambuf_iterator<char>(in), {}};
    const std::string begin = "<!-- defects: begin -->\n", end = "<!-- defects: end -->";
    const std::size_t from = all.find(begin), to = all.find(end);
    if (from == std::string::npos || to == std::string::npos)
        throw Error(Failure::usage, file.string(), "has no markers of the defect study");
    all.replace(from + begin.size(), to - from - begin.size(), text);
    std::ofstream(file, std::ios::binary) << all;
}

bool chosen(const std::string& name, const std::string& part) {
    return name.find(part) != std::string::npos;
}

int run(const Arguments& arguments) {
    std::vector<Outcome> outcomes;
    std::vector<Good> pairs;
    std::size_t scenes = 0;
    double rendering = 0, explaining = 0;
    for (const fs::path& file : arguments.scenes) {
        if (!chosen(file.stem().string(), arguments.scene)) continue;
        ++scenes;
        Imported imported =
            load_scene({file}, {.settings = {"render.size=[" + arguments.size + "]"}});
        const Stage stage =
            make_stage(file.stem().string(), normalise(std::move(imported.scene), imported.render),
                       imported.render);
        for (const Defect& defect : all_defects()) {
            if (!chosen(defect.name, arguments.defect) || !defect.applies(stage)) continue;
            outcomes.push_back(judge(stage, defect, arguments));
            const Outcome& o = outcomes.back();
            const Excess alarm = largest(o.comparison, profile());
            rendering += o.render_seconds;
            explaining += o.explain_seconds;
            fmt::print(stderr, "{:<16} {:<34} {:>8.1f} x {:<10} {:<8} {:.2f} s: {}\n", o.scene,
                       o.defect, alarm.times, alarm.rule, o.named ? "named" : "WRONG",
                       o.explain_seconds,
                       o.comparison.diagnosis.empty() ? "" : o.comparison.diagnosis.back());
        }
        if (arguments.defect.empty()) add_good_pairs(stage, pairs);
    }
    if (outcomes.empty())
        throw std::invalid_argument("no scene given, or none that shows such a defect (see the "
                                    "beginning of bench/defects.cpp)");
    const std::string text = document(outcomes, pairs, scenes, arguments.size);
    if (arguments.document.empty())
        fmt::print("{}", text);
    else
        write_document(arguments.document, text);
    fmt::print(stderr, "explain() took {:.2f} s a case, a picture {:.2f} s\n",
               explaining / double(outcomes.size()), rendering / double(outcomes.size()));
    return 0;
}

}  // namespace

int main(int count, char** words) {
    try {
        return run(parse(count, words));
    } catch (const std::exception& error) {
        fmt::print(stderr, "penumbra-defects: {}\n", error.what());
        return 1;
    }
}
