// The measured tables of docs/fidelity.md, each between <!-- measured: NAME --> and <!-- end -->.
#pragma once

#include "support/parity.h"
#include "support/support.h"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>
#include <vector>

namespace test {

using Cells = std::vector<std::string>;

struct Table {
    std::string name = {};
    Cells columns = {};
    std::vector<Cells> rows = {};
};

/// Parity, exactness and the largest difference, as all of the tables show them.
inline Cells figures(const Parity& m) {
    return {fmt::format("{:.6f}", m.parity), fmt::format("{:.6f}", m.exactness),
            fmt::format("{:.2g}", m.max_error)};
}

inline std::string text(const Cells& cells) {
    return fmt::format("| {} |\n", fmt::join(cells, " | "));
}

inline std::string text(const Table& table) {
    std::string result = "<!-- measured: " + table.name + " -->\n" + text(table.columns) + "|";
    for (std::size_t i = 0; i < table.columns.size(); ++i) result += "---|";
    result += "\n";
    for (const Cells& row : table.rows) result += text(row);
    return result + "<!-- end -->\n";
}

/// The rows of a table in the document, its heading first.
inline std::vector<Cells> documented(const std::string& name) {
    const std::string document = read(fs::path(PENUMBRA_SOURCE_DIR) / "docs/fidelity.md"),
                      marker = "<!-- measured: " + name + " -->\n";
    const std::size_t at = document.find(marker);
    if (at == std::string::npos) return {};
    std::istringstream lines(document.substr(at + marker.size()));
    std::vector<Cells> rows;
    for (std::string line; std::getline(lines, line) && line.starts_with("|");) {
        if (line.starts_with("|---")) continue;
        Cells cells;
        for (std::size_t from = 2, to; (to = line.find(" |", from)) != std::string::npos;
             from = to + 3)
            cells.push_back(line.substr(from, to - from));
        rows.push_back(cells);
    }
    return rows;
}

/// What is left of a table's figures: "lights | spot" of each row.
inline std::vector<std::string> names(const Cells& columns, const std::vector<Cells>& rows) {
    const auto width = std::find(columns.begin(), columns.end(), "parity") - columns.begin();
    std::vector<std::string> result;
    for (const Cells& row : rows)
        result.push_back(fmt::format(
            "{}", fmt::join(row.begin(), row.begin() + std::min(width, std::ssize(row)), " | ")));
    return result;
}

/// Figures may differ by that between machines; all else must be the same.
constexpr double documented_margin = 2e-4;

inline void check_cell(const std::string& column, const std::string& written,
                       const std::string& measured) {
    INFO(column);
    // A single pixel decides on the largest difference: it is shown, and not held against anybody.
    if (column == "largest difference") return;
    const bool figure =
        column == "parity" || column == "exactness" || column == "SSIM" || column == "FLIP";
    if (figure)
        CHECK(std::stod(written) == Approx(std::stod(measured)).margin(documented_margin));
    else
        CHECK(written == measured);
}

/// The document must have these very rows, no more and no fewer. When PENUMBRA_WRITE_FIDELITY names
/// a file, the table is appended to that instead.
inline void document(const Table& table) {
    if (const char* file = std::getenv("PENUMBRA_WRITE_FIDELITY")) {
        std::ofstream(file, std::ios::app) << text(table);
        return;
    }
    std::vector<Cells> rows = documented(table.name);
    INFO("the table '" << table.name
                       << "' of docs/fidelity.md is stale: write it anew with scripts/fidelity");
    REQUIRE(!rows.empty());
    CHECK(rows[0] == table.columns);
    rows.erase(rows.begin());
    REQUIRE(names(table.columns, rows) == names(table.columns, table.rows));
    for (std::size_t i = 0; i < table.rows.size(); ++i) {
        const Cells &written = rows[i], &measured = table.rows[i];
        INFO(text(measured));
        REQUIRE(written.size() == measured.size());
        for (std::size_t k = 0; k < measured.size(); ++k)
            check_cell(table.columns[k], written[k], measured[k]);
    }
}

}  // namespace test
