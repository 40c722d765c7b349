// JSON text -> JSON that can be trusted.
#pragma once

#include "penumbra/error.h"

#include <nlohmann/json_fwd.hpp>

#include <string>
#include <string_view>

namespace penumbra::gltf {

/// Parses JSON; extras and what is nested deeper than any glTF are left out, long names are cut.
/// Throws Error (input).
nlohmann::json parse_json(std::string_view text, const std::string& file, Losses& losses);

/// Refuses versions and required extensions that are not supported. Throws Error (input).
void check_asset(const nlohmann::json& root, const std::string& file, Losses& losses);

/// Checks types, references and numbers of the whole document against the glTF 2.0 schema, writes
/// whole numbers as integers and clamps factors. Throws Error (input).
void check_schema(nlohmann::json& root, const std::string& file, Losses& losses);

/// Checks that accessors lie in their buffer views and these in their buffers, and that the nodes
/// form trees; names accessors that are not aligned and nodes with two transforms. Precondition:
/// check_schema() passed. Throws Error (input).
void check_layout(const nlohmann::json& root, const std::string& file, Losses& losses);

/// Names rules that the file breaks, but that it can be read without. Precondition: check_schema()
/// passed.
void check_rules(const nlohmann::json& root, const std::string& file, Losses& losses);

}  // namespace penumbra::gltf
