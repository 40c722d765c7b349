#include "exporters/tachyon/output.h"

#include <algorithm>
#include <span>

namespace penumbra::tachyon {

void Text::flush() {
    file_.write(std::as_bytes(std::span(buffer_.data(), buffer_.size())));
    buffer_.clear();
}

void Text::commit() {
    flush();
    file_.commit();
}

Output::Output(const Scene& of, const std::filesystem::path& to, const ExportOptions& with)
    : scene(of), file(to), options(with), text(to), textures(of.materials.size()) {}

void Output::note_loss(Loss::Kind kind, const std::string& name, const char* of,
                       const std::string& what) {
    const Loss loss{kind, name.empty() ? of : name, what};
    if (std::find(losses.begin(), losses.end(), loss) == losses.end()) losses.push_back(loss);
}

std::string color(const Color& c) { return fmt::format("{:.6g} {:.6g} {:.6g}", c.x, c.y, c.z); }

}  // namespace penumbra::tachyon
