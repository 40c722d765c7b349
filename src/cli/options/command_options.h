// What options each command has.
#pragma once

#include "cli/options/arguments.h"
#include "cli/options/descriptions.h"
#include "cli/options/option_reader.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>

namespace penumbra::cli {

inline constexpr Interval any_number = {-HUGE_VAL, HUGE_VAL};
inline constexpr Interval not_negative = {0, HUGE_VAL};

/// The options of one of penumbra's commands, and what they set in its Arguments.
class CommandOptions : public OptionReader {
  public:
    CommandOptions(CLI::App& program, const Description& description, Arguments& result)
        : OptionReader(program, description.name, description.what), arguments_(result) {
        arguments_.command = description.command;
        app->footer(std::string("Example:\n") + description.example);
        declare();
    }

    // What depends on several options.
    void finish() {
        if (color_ || no_color_) arguments_.color = !no_color_;
        finish_limits();
        const std::size_t given = arguments_.inputs.size();
        if (arguments_.command == Command::compare && given != 2)
            throw Error(Failure::usage, "",
                        fmt::format("compare takes two pictures or two folders, not {} (see "
                                    "'penumbra compare --help')",
                                    given));
        if (arguments_.command == Command::calibrate && (given == 0 || given % 2 != 0))
            throw Error(Failure::usage, "",
                        fmt::format("calibrate takes pairs of pictures or of folders, not {} (see "
                                    "'penumbra calibrate --help')",
                                    given));
        if (arguments_.manifest && given > 0)
            throw Error(Failure::usage, "--manifest", "names the inputs; none are given beside it");
        const bool has_input =
            given > 0 || arguments_.manifest || (arguments_.load.sidecar && !arguments_.each);
        if (!has_input)
            throw Error(
                Failure::usage, "",
                fmt::format("no input is given (see 'penumbra {} --help')", app->get_name()));
        if (arguments_.command == Command::validate && arguments_.jobs > 1 && !arguments_.each &&
            !arguments_.manifest)
            throw Error(Failure::usage, "--jobs", "needs --each or --manifest");
    }

    void finish_limits() {
        Limits& limits = arguments_.judging.limits;
        if (!profile_.empty())
            limits = profile_limits(profile_);
        else if (arguments_.command == Command::compare)
            limits = profile_limits("equivalent");
        for (const auto& [metric, value] : overrides_) limits.limits[metric] = value;
        if (warn_band_) limits.warn_band = *warn_band_;
    }

  private:
    Arguments& arguments_;
    bool color_ = false, no_color_ = false;
    std::string profile_;
    std::map<std::string, double> overrides_;
    std::optional<double> warn_band_;

    // An option that stands for a sidecar key.
    void setting(const std::string& name, const std::string& type, const std::string& what,
                 const std::function<std::string(const std::string&)>& to_setting) {
        value(name, type, what, [this, name, to_setting](const std::string& text) {
            const std::string made = to_setting(text);
            arguments_.load.settings.push_back(made);
            arguments_.origins[made] = shell_command({name, text});
        });
    }

    // One that stands for a whole number from 1 to `most` in [render].
    void whole_setting(const std::string& name, const char* key, double most,
                       const std::string& what) {
        setting(name, "N", what, [=](const std::string& text) {
            return fmt::format("render.{}={}", key, read_integer(name, text, {1, most}));
        });
    }

    void limit(const std::string& name, const std::string& metric, const std::string& what) {
        const std::string help = fmt::format("{} ({})", what, default_limits().at(metric));
        value(name, "X", help, [this, name, metric](const std::string& text) {
            overrides_[metric] = read_number(name, text, {0, 1});
        });
    }

    void declare() {
        const Command command = arguments_.command;
        declare_inputs();
        if (!judges_pictures()) declare_scene();
        if (command == Command::validate) declare_povray();
        if (command == Command::validate || command == Command::compare) declare_limits();
        if (command == Command::calibrate) declare_calibration();
        group = "Resources";
        value("--max-memory", "SIZE",
              "Memory to use, such as 2G (PENUMBRA_MAX_MEMORY, else 3/4 of what is free)",
              [this](const std::string& text) {
                  arguments_.max_memory = read_memory("--max-memory", text);
              });
        declare_console();
    }

    // Takes pictures rather than scenes.
    bool judges_pictures() const {
        return arguments_.command == Command::compare || arguments_.command == Command::calibrate;
    }

    std::string inputs_help() const {
        switch (arguments_.command) {
        case Command::compare:
            return "The picture to judge and the reference, or two folders of them";
        case Command::calibrate: return "Pairs of equally good pictures, or of folders of them";
        default: break;
        }
        std::vector<std::string> extensions;
        for (const Format& format : formats())
            std::ranges::copy(format.extensions, std::back_inserter(extensions));
        return fmt::format("Models ({}) and sidecars (.toml) that form one scene",
                           fmt::join(extensions, ", "));
    }

    static std::string scene_extensions() {
        std::vector<std::string> all;
        for (const ExportFormat& format : export_formats())
            all.insert(all.end(), format.extensions.begin(), format.extensions.end());
        return fmt::format("{}", fmt::join(all, ", "));
    }

    void declare_inputs() {
        positional(judges_pictures() ? "PICTURES" : "INPUT", inputs_help(),
                   [this](const std::string& text) { arguments_.inputs.emplace_back(text); });
        group = "Output";
        switch (arguments_.command) {
        case Command::render:
            output(".png, .exr, .tif, .jpg or .hdr file to write (<first input>.png)");
            value("--depth", "8|16", "Bits per channel of a .png or .tif (8)",
                  [this](const std::string& text) {
                      arguments_.bits = read_choice("--depth", text, {"8", "16"}) == 0 ? 8 : 16;
                  });
            flag("--resume", arguments_.resume,
                 "Go on from the checkpoint of an interrupted run, FILE.checkpoint");
            value("--checkpoint", "SECONDS", "Time between checkpoints; 0 for none (5)",
                  [this](const std::string& text) {
                      arguments_.checkpoint_interval =
                          read_number("--checkpoint", text, not_negative);
                  });
            break;
        case Command::export_scene:
            output("Scene to write: " + scene_extensions() + " (<first input>.pov, or .inc)");
            choice("--pov-style", {"standalone", "include"},
                   "A scene to render, or the model alone, for a scene of your own (standalone)",
                   arguments_.pov_style);
            flag("--force", arguments_.force,
                 "Replace files that are not from an export, too, but never an input");
            break;
        case Command::validate:
        case Command::compare:
            value("--report", "DIR", "Folder of the report", [this](const std::string& text) {
                arguments_.report = not_empty("--report", text);
            });
            flag("--force", arguments_.force,
                 "Replace files that are not from a report, too, but never an input");
            break;
        case Command::calibrate:
        case Command::info: break;
        }
    }

    void output(const std::string& what) {
        value("-o,--output", "FILE", what,
              [this](const std::string& text) { arguments_.output = not_empty("--output", text); });
    }

    static std::string not_empty(const std::string& option, const std::string& text) {
        if (text.empty()) throw Error(Failure::usage, option, "its value is empty");
        return text;
    }

    // scene_options.cpp
    void declare_scene();
    void declare_light();
    void declare_instant();
    void declare_rendering();
    void declare_sampling();

    void declare_povray() {
        group = "POV-Ray";
        value("--povray", "PATH", "The POV-Ray program (PENUMBRA_POVRAY, else povray)",
              [this](const std::string& text) {
                  arguments_.povray.binary = not_empty("--povray", text);
              });
        value("--timeout", "SECONDS", "Longest time that POV-Ray may take (600)",
              [this](const std::string& text) {
                  arguments_.povray.timeout =
                      std::chrono::seconds(read_integer("--timeout", text, {1, 1e9}));
              });
        value("--renderer", "NAME=COMMAND",
              "Compare with another renderer too; COMMAND may hold {pov}, {scene}, {out}, {width} "
              "and {height}",
              [this](const std::string& text) {
                  arguments_.renderers.push_back(read_renderer("--renderer", text));
              });
        group = "Scenes";
        flag("--each", arguments_.each, "Every INPUT is a scene of its own");
        value("--manifest", "FILE", "Validate the scenes that this .toml file lists",
              [this](const std::string& text) {
                  arguments_.manifest = not_empty("--manifest", text);
              });
        jobs();
        flag("--fresh", arguments_.fresh, "Render unchanged scenes of an earlier report again");
    }

    void jobs() {
        value("--jobs", "N", "Of several: so many at once (1)", [this](const std::string& text) {
            arguments_.jobs = read_integer("--jobs", text, {1, 256});
        });
    }

    void alpha() {
        choice("--alpha", {"count", "ignore"},
               "Compare alpha and what it leaves of the colours, or colours alone (count)",
               arguments_.ignore_alpha);
    }

    void declare_calibration() {
        group = "Pictures";
        alpha();
        group = "Limits";
        value("--margin", "X", "Allow X times the error of the worst pair (1.5)",
              [this](const std::string& text) {
                  arguments_.margin = read_number("--margin", text, {1, 1000});
              });
    }

    void declare_limits() {
        group = "Limits";
        value("--profile", "NAME", "Set of limits: strict, equivalent or similar",
              [this](const std::string& text) { profile_ = text; });
        limit("--min-parity", "parity", "Least share of equal pixels");
        limit("--min-ssim", "ssim", "Least structural similarity");
        limit("--max-flip", "flip", "Largest mean FLIP error");
        limit("--max-flip-tile", "flip_tile", "Largest FLIP error of a tile");
        value("--limit", "METRIC=X", "Limit of any metric, such as bias=0.002",
              [this](const std::string& text) {
                  const auto [metric, number] = read_limit("--limit", text);
                  overrides_[metric] = number;
              });
        value("--warn-band", "SHARE", "Warn within this share of a limit (0.2)",
              [this](const std::string& text) {
                  warn_band_ = read_number("--warn-band", text, {0, 1});
              });
        declare_pixels();
        if (arguments_.command != Command::compare) return;
        group = "Pictures";
        jobs();
        alpha();
        value("--exposure", "EV", "Brighten both by 2^EV before they are compared (0)",
              [this](const std::string& text) {
                  arguments_.exposure = read_number("--exposure", text, {-32, 32});
              });
        value("--background", "R,G,B", "Linear colour that counts as empty (that of the border)",
              [this](const std::string& text) {
                  arguments_.background = read_color("--background", text);
              });
    }

    void declare_pixels() {
        group = "Pixels";
        value("--mask", "FILE", "Picture that is black where pixels are ignored",
              [this](const std::string& text) {
                  arguments_.judging.mask = not_empty("--mask", text);
              });
        value("--ignore", "X0,Y0,X1,Y1", "Ignore the pixels from X0,Y0 up to, not with, X1,Y1",
              [this](const std::string& text) {
                  arguments_.judging.ignored.push_back(read_box("--ignore", text));
              });
        value("--shift-tolerance", "PX", "Accept the colour of a pixel that is so near (0)",
              [this](const std::string& text) {
                  arguments_.judging.shift_tolerance =
                      read_integer("--shift-tolerance", text, {0, 16});
              });
    }

    void declare_console() {
        group = "Messages";
        flag("--json", arguments_.json, "Print the result as JSON");
        if (arguments_.command == Command::validate || arguments_.command == Command::compare)
            value("--summary", "markdown", "Print a table in Markdown",
                  [this](const std::string& text) {
                      read_choice("--summary", text, {"markdown"});
                      arguments_.markdown = true;
                  });
        if (!judges_pictures())
            flag("--strict", arguments_.strict, "Fail when something cannot be carried over");
        flag("-q,--quiet", arguments_.quiet, "Print errors and results only");
        flag("-v,--verbose", arguments_.verbose, "Print every warning and what is being done");
        flag("--color", color_, "Colour messages even where no terminal is");
        flag("--no-color", no_color_, "Do not colour messages (NO_COLOR)");
    }
};

}  // namespace penumbra::cli
