// Statements of OBJ that show nothing here.
#pragma once

#include <string>
#include <string_view>

namespace penumbra::obj {

/// What is lost with a statement that is not read; empty where another statement says so.
std::string left_out(std::string_view keyword);

}  // namespace penumbra::obj
