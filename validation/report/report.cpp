// Cases -> the files of a report.
#include "validation/report/report.h"

#include "base/file.h"
#include "validation/report/html.h"
#include "validation/report/thumbnails.h"

#include "penumbra/error.h"

#include <system_error>

namespace penumbra {
namespace {

void make_folder(const std::filesystem::path& folder) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error)
        throw Error(Failure::output, folder.string(), "cannot make the folder: " + error.message());
}

}  // namespace

void write_case_page(const std::filesystem::path& folder, const Case& one,
                     const std::string& index) {
    make_folder(folder);
    if (html::has_pixels(one.test) || html::has_pixels(one.reference))
        write_file(folder / "thumbnails.png", encode_png(html::thumbnails(one)));
    write_file(folder / "index.html", case_page(one, index));
}

void write_report(const std::filesystem::path& folder, const std::vector<Case>& cases) {
    make_folder(folder);
    write_file(folder / "report.json", report_json(cases));
    write_file(folder / "junit.xml", report_junit(cases));
    if (cases.size() == 1 && cases[0].folder.empty())
        write_case_page(folder, cases[0]);
    else
        write_file(folder / "index.html", index_page(cases));
}

}  // namespace penumbra
