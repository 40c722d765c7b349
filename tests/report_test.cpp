#include "support.h"
#include "validation/markup.h"

#include "penumbra/image.h"
#include "penumbra/validation.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <span>
#include <vector>

using namespace penumbra;
using nlohmann::json;

namespace {

bool has(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

Image ball(int w, int h, float brightness) {
    Image image(w, h);
    for (int y = 0; y < h; ++y)
        for (int x = 0; x < w; ++x)
            if (std::hypot(x - w * 0.45, y - h * 0.5) < h * 0.4)
                image.at(x, y) =
                    Color(0.8F, 0.5F, 0.2F) * brightness * (0.2F + 0.8F * float(x) / float(w));
    return image;
}

Case ball_case(const std::string& name, float brightness) {
    Case one;
    one.name = name;
    one.test = ball(64, 48, brightness);
    one.reference = ball(64, 48, 1);
    one.comparison = compare(one.test, one.reference);
    one.losses = {{"a.gltf#/materials/0", "sheen is ignored"},
                  {"a.gltf#/materials/1", "sheen is ignored"},
                  {"a.gltf#/materials/0", "sheen is ignored"}};
    one.seconds = {{"import", 0.25}, {"render", 1.5}, {"povray", 2}};
    one.commands = {"penumbra validate a.gltf"};
    one.files = {{"pov", "a.pov"}, {"reference", "povray.exr"}};
    one.povray_log = "POV-Ray finished\n";
    return one;
}

Case broken_case() {
    Case one;
    one.name = "broken";
    one.message = "povray: not found";
    one.comparison.verdict = Verdict::error;
    return one;
}

Case empty_case() {
    Case one;
    one.name = "empty";
    one.test = one.reference = Image(16, 16);
    one.comparison = compare(one.test, one.reference);
    return one;
}

// A text that breaks out of everything that is not escaped.
const std::string evil = "<script>alert(1)</script>\"'&]]>\x01\xff{}";

Case evil_case() {
    Case one = ball_case(evil, 2);
    one.test_name = one.reference_name = one.povray_log = one.message = evil;
    one.losses = {{evil, evil}};
    one.commands = {evil};
    one.files = {{evil, "javascript:" + evil}};
    one.seconds[evil] = 1;
    one.comparison.diagnosis = {evil};
    return one;
}

// Elements nest, attributes are quoted, only known entities occur, no character is forbidden.
std::string xml_defect(const std::string& text) {
    std::vector<std::string> open;
    for (std::size_t i = 0; i < text.size();) {
        if (std::uint8_t(text[i]) < 0x20 && text[i] != '\n') return "control character";
        if (text[i] == '&') {
            const std::string name = text.substr(i + 1, text.find(';', i) - i - 1);
            if (name != "amp" && name != "lt" && name != "gt" && name != "quot" && name != "#39")
                return "entity " + name;
        }
        if (text[i] != '<') {
            ++i;
            continue;
        }
        std::size_t end = i;
        for (bool quoted = false; end < text.size() && (quoted || text[end] != '>'); ++end) {
            if (text[end] == '"') quoted = !quoted;
            if (quoted && text[end] == '<') return "< in an attribute";
        }
        const std::string tag = text.substr(i + 1, end - i - 1);
        i = end + 1;
        if (tag.starts_with('?') || tag.starts_with('!')) continue;
        const std::string name = tag.substr(0, tag.find_first_of(" \n"));
        if (!name.starts_with('/'))
            open.push_back(name);
        else if (open.empty() || "/" + open.back() != name)
            return "unexpected " + name;
        else
            open.pop_back();
    }
    return open.empty() ? "" : "unclosed " + open.back();
}

}  // namespace

TEST_CASE("The JSON document has its keys") {
    const json document = json::parse(report_json({ball_case("ball", 1.001F), broken_case()}));
    CHECK(document["version"] == 1);
    CHECK(document["tool"]["name"] == "penumbra");
    REQUIRE(document["cases"].size() == 2);
    const json& one = document["cases"][0];
    CHECK(one["name"] == "ball");
    CHECK(one["verdict"] == "pass");
    CHECK(one["metrics"].size() == 12);
    CHECK(one["metrics"]["parity"]["value"] == 1);
    CHECK(one["metrics"]["parity"]["limit"] == 0.995);
    CHECK(one["metrics"]["parity"]["ok"] == true);
    CHECK(one["metrics"]["exactness"]["limit"].is_null());
    CHECK(one["metrics"]["exactness"]["ok"] == true);
    CHECK(one["worst_pixel"]["test"].size() == 3);
    CHECK(one["worst_pixel"]["x"].is_number_integer());
    CHECK(one["worst_pixel"]["reference"][0].get<float>() > 0);
    CHECK(one["diagnosis"].is_array());
    REQUIRE(one["losses"].size() == 2);
    CHECK(one["losses"][0] ==
          json{{"place", "a.gltf#/materials/0"}, {"what", "sheen is ignored"}, {"count", 2}});
    CHECK(one["seconds"]["render"] == 1.5);
    CHECK(one["commands"] == json{"penumbra validate a.gltf"});
    CHECK(one["files"]["pov"] == "a.pov");
    CHECK_FALSE(one.contains("message"));

    const json& broken = document["cases"][1];
    CHECK(broken["verdict"] == "error");
    CHECK(broken["message"] == "povray: not found");
    CHECK(broken["metrics"].empty());
    CHECK(broken["worst_pixel"].is_null());
    CHECK(report_json({ball_case("ball", 1)}) == report_json({ball_case("ball", 1)}));
}

TEST_CASE("The JSON document says null for what is not known") {
    Case one;
    one.name = "sizes";
    one.comparison = compare(ball(8, 8, 1), ball(9, 8, 1));
    const json document = json::parse(report_json({one}));
    const json& metrics = document["cases"][0]["metrics"];
    CHECK(document["cases"][0]["verdict"] == "not_comparable");
    CHECK(metrics["parity"]["value"].is_null());
    CHECK(metrics["parity"]["ok"] == false);
    CHECK(document["cases"][0]["worst_pixel"].is_null());
    CHECK(json::parse(report_json({}))["cases"].empty());
}

TEST_CASE("The JSON document survives any text") {
    const json document = json::parse(report_json({evil_case()}));
    CHECK(document["cases"][0]["name"] ==
          "<script>alert(1)</script>\"'&]]>\xef\xbf\xbd\xef\xbf\xbd{}");
}

TEST_CASE("The JUnit document has one test a case and says which limit failed") {
    const std::string text =
        report_junit({ball_case("good", 1), ball_case("bad", 1.5F), empty_case(), broken_case()});
    CHECK(xml_defect(text) == "");
    CHECK(has(text, "<testsuites tests=\"4\" failures=\"2\" errors=\"1\" time=\"7.500\">"));
    CHECK(has(text, "<testcase classname=\"penumbra\" name=\"good\" time=\"3.750\">\n"
                    "      <system-out>pass\nparity 1 (limit &gt;= 0.995)\nexactness 1\n"));
    CHECK(has(text, "<failure type=\"fail\" message=\"parity 0."));
    CHECK(has(text, ", limit &gt;= 0.995; "));
    CHECK(has(text, ", limit &lt;= 0.01; flip_tile 0."));
    CHECK(has(text, "the test picture is 50 % brighter"));
    CHECK(has(text, "<failure type=\"not_comparable\" message=\"only 0 % of the picture"));
    CHECK(has(text, "<error type=\"error\" message=\"povray: not found\"></error>"));
    const std::string one_good = report_junit({ball_case("good", 1)});
    CHECK_FALSE(has(one_good, "<failure"));
}

TEST_CASE("JUnit and HTML escape every text") {
    const std::string xml = report_junit({evil_case()});
    CHECK(xml_defect(xml) == "");
    CHECK(has(xml, "name=\"&lt;script&gt;alert(1)&lt;/script&gt;&quot;&#39;&amp;]]&gt;"));

    const test::TempDir folder;
    write_report(folder.path, {evil_case(), evil_case()});
    const std::string page = test::read(folder / "index.html");
    CHECK_FALSE(has(page, "<script"));
    CHECK_FALSE(has(page, "\x01"));
    CHECK_FALSE(has(page, "\xff"));
    CHECK_FALSE(has(page, "href=\"javascript"));
    CHECK(has(page, "href=\"./javascript%3A%3Cscript%3E"));
    CHECK(has(page, "&lt;script&gt;alert(1)&lt;/script&gt;"));
    // Void elements aside the page nests like XML.
    std::string xhtml = page.substr(page.find("<body>"));
    for (std::size_t at = 0; (at = xhtml.find("<img", at)) != std::string::npos; ++at)
        xhtml.erase(at, xhtml.find('>', at) - at + 1);
    CHECK(xml_defect(xhtml.substr(0, xhtml.find("</html>"))) == "");
}

TEST_CASE("The page shows what a reader wants to know") {
    const test::TempDir folder;
    Case one = ball_case("ball & co", 1.5F);
    one.comparison.diagnosis.push_back("one more sentence");
    write_report(folder / "new" / "deeper", {one});
    const std::string page = test::read(folder / "new" / "deeper" / "index.html");
    CHECK(has(page, "<title>ball &amp; co: fail – penumbra</title>"));
    CHECK(has(page, "<span class=\"chip fail\">fail</span>"));
    std::size_t pictures = 0;
    for (std::size_t at = 0;
         (at = page.find("data:image/png;base64,iVBORw0KGgo", at)) != std::string::npos; ++at)
        ++pictures;
    CHECK(pictures == 4);
    CHECK(has(page, "difference × 100"));
    CHECK(has(page, "linear-gradient(90deg,#000004,"));
    CHECK(has(page, "<span class=\"bad\">✗"));
    CHECK(has(page, "<span class=\"good\">✓"));
    CHECK(has(page, "≥ 0.995"));
    CHECK(has(page, "<h3>Worst pixel ("));
    CHECK(has(page, "sheen is ignored (2 times)"));
    CHECK(has(page, "<td>1.50 s</td>"));
    CHECK(has(page, "<td>3.75 s</td>"));
    CHECK(has(page, "<pre>penumbra validate a.gltf"));
    CHECK(has(page, "<details><summary>POV-Ray's log</summary><pre>POV-Ray finished"));
    CHECK(has(page, "<a href=\"./povray.exr\">povray.exr</a>"));
    CHECK(has(page, "one more sentence"));
    CHECK_FALSE(has(page, "<nav>"));  // one scene needs no index
    CHECK_FALSE(has(page, "http://"));
    CHECK_FALSE(has(page, "https://"));

    CHECK(json::parse(test::read(folder / "new" / "deeper" / "report.json"))["cases"].size() == 1);
    CHECK(has(test::read(folder / "new" / "deeper" / "junit.xml"), "name=\"ball &amp; co\""));
    std::size_t files = 0;
    for ([[maybe_unused]] const auto& entry :
         test::fs::directory_iterator(folder / "new" / "deeper"))
        ++files;
    CHECK(files == 3);
}

TEST_CASE("Several scenes get an index with their verdicts") {
    const test::TempDir folder;
    Case sizes = ball_case("sizes", 1);
    sizes.test = ball(60, 48, 1);
    sizes.comparison = compare(sizes.test, sizes.reference);
    write_report(folder.path, {ball_case("one", 1), ball_case("two", 2), broken_case(), sizes});
    const std::string page = test::read(folder / "index.html");
    CHECK(has(page, "1 of 4 scenes pass"));
    CHECK(has(page, "<a href=\"#case-2\">two</a>"));
    CHECK(has(page, "<section id=\"case-2\">"));
    CHECK(has(page, "<span class=\"chip not_comparable\">not comparable</span>"));
    CHECK(has(page, "povray: not found"));
    CHECK(has(page, "the pictures differ in size"));
    CHECK(has(page, "<td>–</td><td>≥ 0.995</td>"));
}

TEST_CASE("A report that cannot be written is an error with its reason") {
    const test::TempDir folder;
    test::write(folder / "file", "in the way");
    try {
        write_report(folder / "file" / "report", {});
        FAIL("was written");
    } catch (const Error& error) {
        CHECK(error.failure == Failure::output);
        CHECK(has(error.what(),
                  (folder / "file" / "report").string() + ": cannot make the folder: "));
    }
    test::fs::create_directories(folder / "out" / "report.json");
    CHECK(has(test::message_of([&] { write_report(folder / "out", {}); }),
              (folder / "out" / "report.json").string() + ": cannot write"));
}

TEST_CASE("Text is cleaned to what XML allows") {
    using markup::clean;
    const std::string mark = "\xef\xbf\xbd";
    CHECK(clean("plain\ttext\n") == "plain\ttext\n");
    CHECK(clean("gr\xc3\xbc\xc3\x9f \xe2\x82\xac \xf0\x9f\x98\x80") ==
          "gr\xc3\xbc\xc3\x9f \xe2\x82\xac \xf0\x9f\x98\x80");
    CHECK(clean(std::string("a\0b", 3)) == "a" + mark + "b");
    CHECK(clean("\x1b[0m") == mark + "[0m");
    CHECK(clean("\x7f") == mark);
    CHECK(clean("\xc3") == mark);                                   // cut short
    CHECK(clean("\xc0\xaf") == mark + mark);                        // overlong
    CHECK(clean("\xed\xa0\x80") == mark + mark + mark);             // surrogate
    CHECK(clean("\xf4\x90\x80\x80") == mark + mark + mark + mark);  // beyond Unicode
    CHECK(clean("\xef\xbf\xbf") == mark);                           // U+FFFF
}

TEST_CASE("Links are relative, encoded and without a scheme") {
    using markup::link;
    CHECK(link("a b/c.pov") == "./a%20b/c.pov");
    CHECK(link("javascript:alert(1)") == "./javascript%3Aalert%281%29");
    CHECK(link("//evil/x") == "/evil/x");
    CHECK(link("\"><x") == "./%22%3E%3Cx");
    CHECK(link("gr\xc3\xbc.exr") == "./gr%C3%BC.exr");
}

TEST_CASE("Bytes become Base64") {
    const auto uri = [](const std::string& text) {
        return markup::png_uri(std::as_bytes(std::span(text))).substr(22);
    };
    CHECK(uri("") == "");  // RFC 4648, section 10
    CHECK(uri("f") == "Zg==");
    CHECK(uri("fo") == "Zm8=");
    CHECK(uri("foo") == "Zm9v");
    CHECK(uri("foobar") == "Zm9vYmFy");
}
