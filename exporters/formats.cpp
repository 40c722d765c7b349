// The formats of export_scene(): a new one is a row of the table.
#include "base/text/suggest.h"
#include "base/text/text.h"
#include "exporters/pov/files.h"
#include "exporters/shared/targets.h"

#include "penumbra/exporters.h"

#include <algorithm>
#include <span>

namespace penumbra {

namespace {

using CheckName = void(const std::filesystem::path& file, PovStyle style);

// Include files are POV-Ray's.
void check_not_include(const std::filesystem::path& file, PovStyle style) {
    if (style == PovStyle::include) pov::check_name(file, style);
}

struct Writer {
    ExportFormat format;
    CheckName* check_name;
    Exported (*write)(const NormalisedScene& scene, const RenderOptions& render,
                      const std::filesystem::path& file, const ExportOptions& options);
};

const std::vector<Writer>& writers() {
    static const std::vector<Writer> table = {
        {{.name = "POV-Ray 3.7", .extensions = {".pov", ".inc"}}, pov::check_name, write_pov},
        {{.name = "Tachyon 0.99", .extensions = {".dat"}}, check_not_include, write_tachyon},
    };
    return table;
}

const Writer& writer_of(const std::filesystem::path& file) {
    const std::string extension = lower_extension(file);
    std::vector<std::string> known;
    for (const Writer& writer : writers()) {
        const std::vector<std::string>& own = writer.format.extensions;
        if (std::find(own.begin(), own.end(), extension) != own.end()) return writer;
        known.insert(known.end(), own.begin(), own.end());
    }
    throw Error(Failure::output, file.string(),
                (extension.empty() ? "its name has no extension" : "unknown scene format") +
                    hint(extension, known, "use one of"));
}

}  // namespace

std::vector<ExportFormat> export_formats() {
    std::vector<ExportFormat> formats;
    for (const Writer& writer : writers()) formats.push_back(writer.format);
    return formats;
}

void check_export_file(const std::filesystem::path& file, const ExportOptions& options) {
    writer_of(file).check_name(file, options.pov_style);
    check_targets(std::span(&file, 1), options);
}

Exported export_scene(const NormalisedScene& scene, const RenderOptions& render,
                      const std::filesystem::path& file, const ExportOptions& options) {
    check_export_file(file, options);
    return writer_of(file).write(scene, render, file, options);
}

}  // namespace penumbra
