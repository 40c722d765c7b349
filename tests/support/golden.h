// Texts that were reviewed by eye and must not change by themselves.
#pragma once

#include "support/support.h"

namespace test {

/// Compares with a file beside the tests of exporters; PENUMBRA_UPDATE_GOLDEN=1 writes it instead.
inline void check_golden(const std::string& name, const std::string& text) {
    const fs::path file = fs::path(PENUMBRA_SOURCE_DIR) / "tests/exporters/golden" / name;
    if (std::getenv("PENUMBRA_UPDATE_GOLDEN")) write(file, text);
    CHECK(text == read(file));
}

}  // namespace test
