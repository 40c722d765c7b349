// Cases -> the files of a report.
#include "report.h"

#include "file.h"

#include <system_error>

namespace penumbra {

void write_report(const std::filesystem::path& folder, const std::vector<Case>& cases) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error)
        throw Error(Failure::output, folder.string(), "cannot make the folder: " + error.message());
    write_file(folder / "report.json", report_json(cases));
    write_file(folder / "junit.xml", report_junit(cases));
    if (cases.size() == 1 && cases[0].folder.empty())
        write_case_page(folder, cases[0]);
    else
        write_file(folder / "index.html", index_page(cases));
}

}  // namespace penumbra
