// Sidecars: the input is a sidecar over two small models, or, after a line "--set", the settings.
#include "fuzz.h"

#include <algorithm>

namespace fuzz {
namespace {

using namespace penumbra;

constexpr std::size_t most_settings = 16;

std::vector<std::string> first_lines(Input text) {
    std::vector<std::string> lines;
    while (!text.empty() && lines.size() < most_settings) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        lines.emplace_back(text.substr(0, end));
        text.remove_prefix(std::min(end + 1, text.size()));
    }
    return lines;
}

}  // namespace

void sidecar(Input input) {
    constexpr Input mark = "--set\n";
    LoadOptions options = {.normal_maps = NormalMaps::pixel};
    if (input.starts_with(mark))
        options.settings = first_lines(input.substr(mark.size()));
    else
        options.sidecar = sandbox().write("model.toml", input);
    may_refuse([&] {
        check_scene(load_scene({sandbox().in / "plain.obj", sandbox().in / "plain.gltf"}, options));
    });
}

}  // namespace fuzz
