// Options of commands that read scenes: what is shown, how it is lit, and how it is rendered.
#include "cli/options/command_options.h"
#include "cli/options/values.h"

#include <fmt/format.h>

namespace penumbra::cli {

void CommandOptions::declare_scene() {
    arguments_.load.model.how_to_allow = "--allow-path DIR lets models read files below DIR";
    group = "Scene";
    value("--sidecar", "FILE", "Lay this sidecar over the inputs", [this](const std::string& text) {
        arguments_.load.sidecar = not_empty("--sidecar", text);
    });
    value("--allow-path", "DIR", "Let models read files below this folder, too",
          [this](const std::string& text) {
              arguments_.load.model.allowed_paths.emplace_back(not_empty("--allow-path", text));
          });
    value("--variant", "NAME", "Use this variant of a glTF model's materials",
          [this](const std::string& text) {
              arguments_.load.model.variant = not_empty("--variant", text);
          });
    declare_instant();
    setting("--camera", "NAME", "Use the model's camera of this name or number",
            [](const std::string& text) { return "camera.name=" + toml_string(text); });
    setting("--size", "WxH", "Size of the picture in pixels (800x600)",
            [](const std::string& text) {
                const auto size = read_size("--size", text);
                return fmt::format("render.size=[{},{}]", size[0], size[1]);
            });
    setting("--background", "R,G,B|FILE",
            "Linear colour or equirectangular image behind the scene (0,0,0)",
            [](const std::string& text) {
                if (text.find_first_of("./") != text.npos && text.find(',') == text.npos)
                    return "render.background=" + toml_string(text);
                const Color c = read_color("--background", text);
                return fmt::format("render.background=[{:.9},{:.9},{:.9}]", c.x, c.y, c.z);
            });
    declare_light();
    value("--sides", "both|front", "Sides of facets that all models show (what they say)",
          [this](const std::string& text) {
              arguments_.load.sides =
                  read_choice("--sides", text, {"both", "front"}) == 0 ? Sides::both : Sides::front;
          });
    value("--set", "KEY=VALUE", "Set any sidecar key, such as lighting.ambient=0.1",
          [this](const std::string& text) { arguments_.load.settings.push_back(text); });
    declare_rendering();
}

void CommandOptions::declare_light() {
    if (arguments_.command == Command::validate) arguments_.load.studio_sources = 16;
    arguments_.load.studio = Studio::floor;
    setting("--environment", "NAME|FILE|R,G,B",
            "Light from all around: studio, overcast, sunset, night, an equirectangular "
            "image, or a colour; none for none",
            [](const std::string& text) { return environment_setting(text); });
    value("--penumbra", "DELTA", "Extent of every light in scene units; 0 for sharp shadows",
          [this](const std::string& text) {
              arguments_.load.penumbra = read_number("--penumbra", text, not_negative);
          });
    choice("--studio", {"black", "plain", "floor"},
           "What a scene without lights gets: three lights in the dark, a studio, or one with a "
           "floor (floor)",
           arguments_.load.studio);
    value("--sources", "N",
          fmt::format("Directional lights that an environment becomes (64{})",
                      arguments_.command == Command::validate ? "; of the studio 16" : ""),
          [this](const std::string& text) {
              arguments_.load.sources = read_integer("--sources", text, {0, most_sources});
          });
}

void CommandOptions::declare_instant() {
    value("--scene", "NAME", "Show the scene of a glTF model of this name or number",
          [this](const std::string& text) {
              arguments_.load.model.scene = not_empty("--scene", text);
          });
    value("--animation", "NAME", "Pose a glTF model by its animation of this name or number",
          [this](const std::string& text) {
              arguments_.load.model.animation = not_empty("--animation", text);
          });
    value("--time", "SECONDS", "The instant of --animation, or of the first one (0)",
          [this](const std::string& text) {
              arguments_.load.model.time = read_number("--time", text, not_negative);
          });
}

void CommandOptions::declare_rendering() {
    group = "Rendering";
    declare_sampling();
    whole_setting("--max-depth", "max_depth", 256, "Ray segments along a path (5)");
    setting(
        "--exposure", "EV|auto", "Brighten by 2^EV (0; auto where the model brings its own light)",
        [](const std::string& text) -> std::string {
            if (text == "auto") return "render.exposure=auto";
            return fmt::format("render.exposure={}", read_number("--exposure", text, {-32, 32}));
        });
    choice("--normal-maps", {"bake", "drop", "pixel"},
           "Make them vertex normals, leave them out, or keep them for render alone (bake)",
           arguments_.load.normal_maps);
    value("--threads", "N", "Threads; 0 for all (PENUMBRA_THREADS, else 0)",
          [this](const std::string& text) {
              arguments_.threads = read_integer("--threads", text, {0, 1024});
          });
}

void CommandOptions::declare_sampling() {
    const bool one = arguments_.command == Command::validate;
    whole_setting("--samples", "samples", 9,
                  fmt::format("Samples per pixel: 1, or a grid of N x N and the centre{}",
                              one ? " (1)" : ""));
    setting("--antialias", "X",
            fmt::format("More samples where a pixel's corners differ by X or more{}",
                        one ? "" : " (0.2)"),
            [](const std::string& text) {
                return fmt::format("render.antialias={}",
                                   read_number("--antialias", text, {0, 1000}));
            });
    whole_setting("--antialias-depth", "antialias_depth", 9,
                  "Of these: cut a pixel into 2^(N-1) x 2^(N-1) cells at most (2)");
}

}  // namespace penumbra::cli
