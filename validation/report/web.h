// The scripts and styles that stand in the pages, made from the files in web/ by web/embed.cmake.
#pragma once

#include <string_view>

namespace penumbra::html {

/// A script, and "sha256-..." of it, by which the Content-Security-Policy of its page lets it run.
struct Script {
    std::string_view text = {}, hash = {};
};

extern const Script case_script;   ///< viewer.js and controls.js
extern const Script index_script;  ///< index.js
extern const std::string_view report_style;

}  // namespace penumbra::html
