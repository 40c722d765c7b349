// Colours behind v, and those of ZBrush, which stand in comments.
//
// The format does not say in what space colours are. Programs store what they display: sRGB.
// Blender, for one, encodes them on export and decodes them on import.
#include "importers/obj/colors.h"

#include "base/memory.h"
#include "base/parallel.h"

#include "penumbra/image.h"

#include <algorithm>
#include <span>

namespace penumbra::obj {

namespace {

void add_colors(const std::vector<Piece>& pieces, std::vector<Color>& colors, Tally& tally) {
    float brightest = 0;
    for (const Piece& piece : pieces) brightest = std::max(brightest, piece.brightest);
    if (brightest > 1)
        tally.add(Loss::approximated, "vertex colours exceed 1; they are taken as 0 to 255", 0);
    const float scale = brightest > 1 ? 1.0F / 255 : 1.0F;
    std::size_t first = 0;
    for (const Piece& piece : pieces) {
        auto color = piece.colors.begin();
        for (const ColorRun& run : piece.color_runs)
            for (std::size_t i = 0; i < run.count; ++i) {
                Color& into = colors[first + run.vertex + i];
                into = *color++ * scale;
                for (float& value : std::span(&into[0], 3)) value = std::min(value, 1.0F);
            }
        first += piece.counts.positions;
    }
}

// All lines of colours, in the order of the file.
struct Paint {
    std::vector<Polypaint> rows = {};  // `vertices` counts from the start of the file
    std::vector<Color> colors = {};
};

Paint all_paint(const std::vector<Piece>& pieces, const std::string& file) {
    Paint result;
    std::size_t first = 0, rows = 0, colors = 0;
    for (const Piece& piece : pieces) {
        rows += piece.polypaint.size();
        colors += piece.paint.size();
    }
    const MemoryClaim claim(rows * sizeof(Polypaint) + colors * sizeof(Color), file);
    result.rows.reserve(rows);
    result.colors.reserve(colors);
    for (const Piece& piece : pieces) {
        for (const Polypaint& row : piece.polypaint)
            result.rows.push_back({first + row.vertices, row.count, row.line});
        result.colors.insert(result.colors.end(), piece.paint.begin(), piece.paint.end());
        first += piece.counts.positions;
    }
    return result;
}

// Lines with no v between them are a block. Each is of the vertices that end where it stands, for
// other objects of the file may have none.
void add_polypaint(const Paint& paint, std::vector<Color>& colors, Tally& tally) {
    const Color* color = paint.colors.data();
    for (auto row = paint.rows.begin(); row != paint.rows.end();) {
        const Polypaint& first = *row;
        std::size_t count = 0;
        for (; row != paint.rows.end() && row->vertices == first.vertices; ++row)
            count += row->count;
        if (count > first.vertices)
            tally.add(Loss::dropped, "#MRGB has more colours than there are vertices before it",
                      first.line);
        const std::size_t used = std::min(count, first.vertices);
        for (std::size_t i = 0; i < used; ++i) {
            Color& into = colors[first.vertices - used + i];
            if (!has_color(into)) into = color[i];
        }
        color += count;
    }
}

Index bad_polypaint(const std::vector<Piece>& pieces) {
    for (const Piece& piece : pieces)
        if (piece.bad_polypaint != 0) return piece.bad_polypaint;
    return 0;
}

}  // namespace

std::vector<Color> vertex_colors(const std::vector<Piece>& pieces, const std::string& file,
                                 Tally& tally) {
    std::size_t count = 0;
    bool any = false;
    for (const Piece& piece : pieces) {
        count += piece.counts.positions;
        any = any || !piece.colors.empty() || !piece.polypaint.empty() || piece.bad_polypaint != 0;
    }
    if (!any) return {};
    const MemoryClaim claim(times(count, sizeof(Color)), file);
    std::vector<Color> colors(count, no_color);
    add_colors(pieces, colors, tally);
    if (const Index line = bad_polypaint(pieces))
        tally.add(
            Loss::dropped,
            "the colours of #MRGB are ignored: they are not eight hexadecimal digits for each "
            "vertex",
            line);
    else
        add_polypaint(all_paint(pieces, file), colors, tally);
    if (std::ranges::none_of(colors, has_color)) return {};
    for_each_block(colors.size(), [&](std::size_t from, std::size_t to) {
        for (Color& color : std::span(colors).subspan(from, to - from)) {
            if (!has_color(color)) continue;
            for (float& value : std::span(&color[0], 3)) value = srgb_to_linear(value);
        }
    });
    return colors;
}

}  // namespace penumbra::obj
