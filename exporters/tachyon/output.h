// What the parts of a Tachyon scene are written to, and how numbers stand in it.
#pragma once

#include "base/file.h"

#include "penumbra/error.h"
#include "penumbra/exporters.h"
#include "penumbra/scene.h"

#include <fmt/format.h>

#include <filesystem>
#include <iterator>
#include <string>
#include <vector>

namespace penumbra::tachyon {

/// A text file in the making, which is written in large pieces. All throw Error (output).
class Text {
  public:
    explicit Text(const std::filesystem::path& path) : file_(path) {}
    template <class... Values>
    void add(fmt::format_string<Values...> format, Values&&... values) {
        fmt::format_to(std::back_inserter(buffer_), format, std::forward<Values>(values)...);
        if (buffer_.size() > 1000000) flush();
    }
    /// Gives the file its name.
    void commit();

  private:
    StagedFile file_;
    fmt::memory_buffer buffer_;
    void flush();
};

/// A Tachyon scene in the making.
struct Output {
    const Scene& scene;
    const std::filesystem::path& file;
    const ExportOptions& options;
    Text text;
    Losses losses = {};
    std::vector<std::filesystem::path> images = {};  ///< written
    std::vector<std::string> textures =
        {};  ///< of Scene::materials off planes; empty: not yet made
    /// Mean brightness of the lights, which Tachyon leaves out of the highlights of metals.
    float light = 0;

    Output(const Scene& scene, const std::filesystem::path& file, const ExportOptions& options);
    /// Notes a loss, once. What has no name is called `of`.
    void note_loss(Loss::Kind kind, const std::string& name, const char* of,
                   const std::string& what);
};

/// "x y z". Tachyon's space is left-handed: z is turned over.
template <class V>
std::string vector(const V& v) {
    return fmt::format("{:.7g} {:.7g} {:.7g}", v.x, v.y, -v.z);
}

/// "r g b"
std::string color(const Color& c);

inline float mean(const Color& c) { return (c.x + c.y + c.z) / 3; }

}  // namespace penumbra::tachyon
