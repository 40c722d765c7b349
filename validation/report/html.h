// The pieces that the HTML pages of the report are made of. Every text that they are given is
// escaped by them.
#pragma once

#include "validation/report/web.h"

#include "penumbra/compare.h"
#include "penumbra/report.h"

#include <string>

namespace penumbra::html {

/// `text` for content and quoted attributes. Marks that reverse the direction of writing become
/// U+FFFD like other control characters, so that no name can look like another.
std::string text(const std::string& text);

/// `value` in `digits` significant digits; below 1 in as many as it takes to tell it from 1.
std::string value(double value, int digits = 6);

/// The verdict as a coloured word.
std::string chip(Verdict verdict);

struct Document {
    std::string title = {}, body = {};  ///< title is plain text, body is HTML
    Script script = {};
};
std::string document(const Document& parts);

bool has_pixels(const Image& image);

/// Both pictures are there and have one size.
bool comparable_pictures(const Case& one);

/// `image` as an <img> with its pixels inside.
std::string picture(const Image& image, const std::string& description,
                    const std::string& attributes = "");

/// FLIP errors as an <img> whose grey levels are the errors in steps of 1/255. A filter of the page
/// shows them in the colours of the map: three times smaller than colours would be, and a script
/// can read the errors.
std::string heat_picture(const Image& flip_map, const std::string& attributes = "");

/// That filter; once a page.
std::string heat_filter();

// Sections of the page of one case; each is empty when there is nothing to show.
std::string viewer(const Case& one);
std::string worst_tiles(const Case& one);
std::string plots(const Case& one);
std::string figures(const Comparison& comparison);
std::string worst_pixel(const Case& one);
std::string losses(const Case& one);
std::string times(const Case& one);
std::string files(const Case& one);
std::string commands(const Case& one);
std::string log(const Case& one);

/// A table cell with the encoded colour in steps of 1/255, and a swatch of it.
std::string color_cell(const Color& linear);

}  // namespace penumbra::html
