// The HTML pages of a report as text. What they do in a browser: browser/report_test.py.
#include "support/random.h"
#include "support/report_cases.h"
#include "support/support.h"
#include "validation/report/html.h"
#include "validation/report/markup.h"
#include "validation/report/report.h"
#include "validation/report/thumbnails.h"

#include "penumbra/compare.h"
#include "penumbra/image.h"
#include "penumbra/report.h"

#include <array>
#include <cstdio>
#include <limits>
#include <span>
#include <vector>

using namespace penumbra;
using namespace test;

namespace {

std::size_t count(const std::string& text, const std::string& part) {
    std::size_t result = 0;
    for (std::size_t at = 0; (at = text.find(part, at)) != std::string::npos; ++at) ++result;
    return result;
}

// The body without its script; void elements aside it nests like XML.
std::string body_of(const std::string& page) {
    std::string body = page.substr(page.find("<body>"));
    body.erase(body.find("<script>"), body.find("</script>") + 9 - body.find("<script>"));
    for (const std::string name : {"<img", "<input"})
        for (std::size_t at = 0; (at = body.find(name, at)) != std::string::npos;)
            body.erase(at, body.find('>', at) - at + 1);
    return body.substr(0, body.find("</html>"));
}

std::string script_of(const std::string& page) {
    const std::size_t begin = page.find("<script>") + 8;
    return page.substr(begin, page.find("</script>") - begin);
}

// "sha256-..." as the page's policy has it, by the tool of the coreutils.
std::string policy_hash(const std::string& script) {
    const test::TempDir folder;
    test::write(folder / "script", script);
    std::FILE* pipe = popen(("sha256sum " + (folder / "script").string()).c_str(), "r");
    std::string hex(64, '0');
    const bool complete = std::fread(hex.data(), 1, 64, pipe) == 64;
    pclose(pipe);
    if (!complete) return "";
    std::array<std::byte, 32> digest{};
    for (std::size_t i = 0; i < 32; ++i)
        digest[i] = std::byte(std::stoi(hex.substr(2 * i, 2), nullptr, 16));
    const std::string uri = markup::png_uri(digest);
    return "sha256-" + uri.substr(uri.find(',') + 1);
}

// Two pictures that no compressor makes smaller.
Case noisy_case() {
    Case one = ball_case("noise", 1);
    test::Random random;
    const auto level = [&] { return float(random(0, 1)); };
    const auto noise = [&] {
        Image image(800, 600);
        for (Color& pixel : image.pixels) pixel = Color(level(), level(), level());
        return image;
    };
    one.test = noise();
    one.reference = noise();
    one.comparison = compare(one.test, one.reference);
    return one;
}

}  // namespace

TEST_CASE("The policy of a page has the hash of its script") {
    const std::string pages[] = {case_page(ball_case("ball", 1), ""), index_page({})};
    for (const std::string& page : pages) {
        const std::string script = script_of(page);
        CHECK(script.size() > 1000);
        CHECK(has(page, "script-src '" + policy_hash(script) + "'"));
        CHECK(has(page, "default-src 'none'"));
        CHECK_FALSE(has(script, "</"));
        CHECK_FALSE(has(script, "<!--"));
    }
}

TEST_CASE("The scripts and styles of the pages are the files of the report's folder") {
    // Without the comment at the head of each.
    const auto text_of = [](const std::string& file, const std::string& first) {
        const test::fs::path folder = test::fs::path(PENUMBRA_SOURCE_DIR) / "validation/report/web";
        const std::string text = test::read(folder / file);
        return "\n" + text.substr(text.find(first));
    };
    CHECK(script_of(case_page(ball_case("ball", 1), "")) ==
          text_of("viewer.js", "'use strict'") + text_of("controls.js", "  // ---- the pixel"));
    const std::string index = index_page({});
    CHECK(script_of(index) == text_of("index.js", "'use strict'"));
    CHECK(has(index, "<style>" + text_of("style.css", ":root") + "</style>"));
}

TEST_CASE("The pages escape every text") {
    Case evil = evil_case();
    evil.comparison.cause = test::evil;
    const std::string override = "\xe2\x80\xae";  // U+202E
    evil.name += override + "gnp.exe";
    for (const std::string& page : {case_page(evil, ""), index_page({evil, evil})}) {
        CHECK(count(page, "<script") == 1);
        CHECK_FALSE(has(page, "\x01"));
        CHECK_FALSE(has(page, "\xff"));
        CHECK_FALSE(has(page, override));
        CHECK_FALSE(has(page, "href=\"javascript"));
        CHECK(has(page, "&lt;script&gt;alert(1)&lt;/script&gt;"));
        CHECK(xml_defect(body_of(page)) == "");
    }
    CHECK(has(case_page(evil, ""), "href=\"./javascript%3A%3Cscript%3E"));
    CHECK(html::text("a" + override + "b") == "a\xef\xbf\xbd"
                                              "b");
}

TEST_CASE("The page of a case shows what a reader wants to know") {
    const test::TempDir folder;
    Case one = ball_case("ball & co", 1.5F);
    one.comparison.diagnosis.push_back("one more sentence");
    one.comparison.cause = "gain";
    one.comparison.worst_tiles = {{16, 16, 16, 0.25}};
    one.files["mask"] = "../mask.png";
    write_case_page(folder / "new" / "deeper", one, "../index.html");
    const std::string page = test::read(folder / "new" / "deeper" / "index.html");
    CHECK(has(page, "<title>ball &amp; co: fail – penumbra</title>"));
    CHECK(has(page, "<span class=\"chip fail\">fail</span>"));
    CHECK(has(page, "<a href=\"./../index.html\">"));
    CHECK(has(page, "Cause: <strong>gain</strong>"));
    CHECK(count(page, "data:image/png;base64,iVBORw0KGgo") == 6);  // three pictures, three crops
    CHECK(has(page, "linear-gradient(90deg,#000004,"));
    CHECK(has(page, "<span class=\"bad\">✗<span class=\"word\"> no"));
    CHECK(has(page, "<span class=\"good\">✓<span class=\"word\"> yes"));
    CHECK(has(page, "≥ 0.995"));
    CHECK(has(page, "From 80 % on, the mark on the bar"));
    CHECK(has(page, "<h2>Worst pixel ("));
    CHECK(has(page, "1. x 16 to 31, y 16 to 31: FLIP 0.25"));
    CHECK(has(page, "data-tiles=\"16,16,16\""));
    CHECK(has(page, "sheen is ignored (2 times)"));
    CHECK(has(page, "<td>1.50 s</td>"));
    CHECK(has(page, "<td>3.75 s</td>"));
    CHECK(has(page, ">penumbra validate a.gltf\n</pre>"));
    CHECK(has(page, "<summary>POV-Ray’s log</summary>"));
    CHECK(has(page, ">POV-Ray finished\n</pre>"));
    CHECK(has(page, "<a href=\"./povray.exr\">povray.exr</a>"));
    CHECK(has(page, "one more sentence"));
    CHECK_FALSE(has(page, "http://"));
    CHECK_FALSE(has(page, "https://"));
    CHECK(xml_defect(body_of(page)) == "");
    CHECK(case_page(one, "") == case_page(one, ""));
    CHECK_FALSE(has(case_page(one, ""), "<nav"));
}

TEST_CASE("Links to files lead from the page of a case to them") {
    Case one = ball_case("ball", 1);
    one.folder = "cases/ball";
    one.files = {{"ours", "cases/ball/ours.exr"}, {"heat", "heat.png"}, {"other", "/tmp/x.png"}};
    const std::string page = case_page(one, "");
    CHECK(has(page, "href=\"./ours.exr\""));
    CHECK(has(page, "href=\"./../../heat.png\""));
    CHECK(has(page, "href=\"/tmp/x.png\""));
}

TEST_CASE("A case without pictures has a page with its message and log") {
    Case broken = broken_case();
    broken.povray_log = "Parse Error";
    const test::TempDir folder;
    write_case_page(folder.path, broken, "");
    const std::string page = test::read(folder / "index.html");
    CHECK(has(page, "povray: not found"));
    CHECK(has(page, "<details class=\"card\" open>"));
    CHECK(has(page, "Parse Error"));
    CHECK_FALSE(has(page, "<img"));
    CHECK_FALSE(has(page, "id=\"viewer\""));
    CHECK(xml_defect(body_of(page)) == "");
    CHECK_FALSE(test::fs::exists(folder / "thumbnails.png"));
}

TEST_CASE("Pictures of different sizes are shown without a difference") {
    Case sizes = ball_case("sizes", 1);
    sizes.test = ball(60, 48, 1);
    sizes.comparison = compare(sizes.test, sizes.reference);
    const std::string page = case_page(sizes, "");
    CHECK(has(page, "60 × 48 and 64 × 48 pixels"));
    CHECK(has(page, "the pictures differ in size"));
    CHECK(has(page, "value=\"side\""));
    CHECK_FALSE(has(page, "value=\"difference\""));
    CHECK_FALSE(has(page, "value=\"flip\""));
    CHECK(has(page, "<td role=\"cell\">–</td><td role=\"cell\">≥ 0.995</td>"));
    CHECK(xml_defect(body_of(page)) == "");
}

TEST_CASE("The plots count every pixel") {
    Case one = ball_case("ball", 1);
    one.reference = one.test;
    const auto brighter = [&](int x, float steps) {  // of black, below the sRGB curve's bend
        one.test.at(x, 0) = Color(srgb_to_linear(steps / 255));
        one.reference.at(x, 0) = Color(0);
    };
    brighter(0, 1);
    brighter(1, 1.01F);
    brighter(2, 4);
    brighter(3, 255);
    brighter(4, 0.05F);
    one.test.at(5, 0) = Color(std::numeric_limits<float>::quiet_NaN());
    const std::string plots = html::plots(one);
    const auto row = [&](const std::string& edge, const std::string& counted) {
        return has(plots, "<tr><th scope=\"row\">" + edge + "</th><td>" + counted + "</td>");
    };
    CHECK(row("0.001", "3066"));
    CHECK(row("0.01", "0"));
    CHECK(row("0.1", "1"));
    CHECK(row("1", "1"));
    CHECK(row("2", "1"));
    CHECK(row("4", "1"));
    CHECK(row("255", "2"));
    CHECK(has(plots, "<td>100 %</td></tr>\n</tbody>"));
    CHECK(count(plots, "<rect class=\"within\"") == 3);
    CHECK(count(plots, "<rect class=\"beyond\"") == 3);
    CHECK(xml_defect(plots) == "");
}

TEST_CASE("A page of noise of 800 x 600 pixels stays under 5 MB") {
    CHECK(case_page(noisy_case(), "").size() < 5'000'000);
}

TEST_CASE("Thumbnails show both pictures and a single wrong pixel") {
    Case one = ball_case("ball", 1);
    one.test = ball(800, 600, 1);
    one.reference = ball(800, 600, 1);
    one.reference.at(401, 299) = Color(50);
    one.comparison = compare(one.test, one.reference);
    const Image strip = html::thumbnails(one);
    CHECK(strip.width == 3 * 144 + 2 * 3);
    CHECK(strip.height == 108);
    const Color left = strip.at(60, 54), right = strip.at(60 + 147, 54);
    CHECK(std::abs(left.x - right.x) < 0.01F);
    CHECK(left.x > 0.2F);
    const Color error = strip.at(2 * 147 + 72, 53);
    CHECK(error.x > 0.2F);  // bright in the colours of the map
    const Color none = strip.at(2 * 147 + 5, 5);
    CHECK(none.x < 0.01F);

    const test::TempDir folder;
    write_case_page(folder.path, one, "");
    CHECK(load_image(folder / "thumbnails.png").width == strip.width);
    one.test = {};
    one.comparison.flip_map = {};
    CHECK(html::thumbnails(one).width == 2 * 144 + 3);
    one.reference = Image(1, 3000);
    CHECK(html::thumbnails(one).height == 108);
}

TEST_CASE("A figure below 1 is not shown as 1") {
    CHECK(html::value(0.99999792) == "0.9999979");
    CHECK(html::value(1 - 1e-13) == "0.999999999");
    CHECK(html::value(0.99137) == "0.99137");
    CHECK(html::value(0.9954321, 4) == "0.9954");
    CHECK(html::value(1) == "1");
    CHECK(html::value(0.5) == "0.5");
    CHECK(html::value(40.53871, 4) == "40.54");
    CHECK(html::value(std::numeric_limits<double>::quiet_NaN()) == "–");
}

TEST_CASE("The list ranks the cases and links to their pages") {
    Case good = ball_case("good", 1), bad = ball_case("bad", 2), broken = broken_case();
    good.folder = "cases/good";
    bad.folder = "a b?";
    bad.comparison.cause = "gain";
    broken.folder = "broken";
    good.cached = true;
    const std::string page = index_page({good, bad, broken, empty_case()});
    CHECK(has(page, "1 of 4 cases pass: 1 error, 1 not comparable, 1 fail, 1 pass"));
    CHECK(has(page, "<a href=\"./a%20b%3F/index.html\"><bdi>bad</bdi></a>"));
    CHECK(has(page, "src=\"./cases/good/thumbnails.png\""));
    CHECK_FALSE(has(page, "src=\"./broken/thumbnails.png\""));
    CHECK(page.find("<bdi>broken") < page.find("<bdi>empty"));
    CHECK(page.find("<bdi>empty") < page.find("<bdi>bad"));
    CHECK(page.find("<bdi>bad") < page.find("<bdi>good"));
    CHECK(has(page, "data-name=\"cause\" data-key=\"gain\""));
    CHECK(has(page, "povray: not found"));
    CHECK(has(page, "unchanged since an earlier run"));
    CHECK(has(page, "<td role=\"cell\" data-name=\"parity\" data-key=\"\">–</td>"));
    CHECK(has(page, "aria-sort=\"descending\">severity</th>"));
    CHECK(has(page, "value=\"not_comparable\" checked"));
    CHECK_FALSE(has(page, "value=\"warn\""));
    CHECK(xml_defect(body_of(page)) == "");
    CHECK(has(index_page({}), "There are no cases."));
}

TEST_CASE("A page that cannot be written is an error with its reason") {
    const test::TempDir folder;
    test::write(folder / "file", "in the way");
    CHECK(has(test::message_of([&] { write_case_page(folder / "file" / "x", broken_case()); }),
              (folder / "file" / "x").string() + ": cannot make the folder: "));
}
