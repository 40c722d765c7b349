#include "support/report_cases.h"
#include "support/support.h"
#include "validation/report/markup.h"

#include "penumbra/compare.h"
#include "penumbra/image.h"
#include "penumbra/report.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <span>
#include <vector>

using namespace penumbra;
using nlohmann::json;
using namespace test;

TEST_CASE("The JSON document has its keys") {
    const json document = json::parse(report_json({ball_case("ball", 1.001F), broken_case()}));
    CHECK(document["version"] == 1);
    CHECK(document["tool"]["name"] == "penumbra");
    REQUIRE(document["cases"].size() == 2);
    const json& one = document["cases"][0];
    CHECK(one["name"] == "ball");
    CHECK(one["verdict"] == "pass");
    CHECK(one["metrics"].size() == 24);
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
    CHECK(one["losses"][0] == json{{"place", "a.gltf#/materials/0"},
                                   {"what", "sheen is ignored (2 times)"},
                                   {"kind", "dropped"},
                                   {"count", 2}});
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

TEST_CASE("The JSON document gives losses back as they were, with kind and count") {
    Case one = ball_case("ball", 1);
    one.losses = {{Loss::approximated, "a.obj:3", "Ps is odd (and 2 more materials)", 3},
                  {Loss::dropped, "a.obj", "points are ignored"}};
    CHECK(cases_of_json(report_json({one})).at(0).losses == one.losses);
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

TEST_CASE("The JSON document that is read again is the same") {
    const std::string document = report_json({ball_case("ball", 1.5F), broken_case()});
    const std::vector<Case> cases = cases_of_json(document);
    REQUIRE(cases.size() == 2);
    REQUIRE(cases[0].losses.size() == 2);
    CHECK(cases[0].losses[0].count == 2);
    CHECK(report_json(cases) == document);
}

TEST_CASE("A JSON document that is no report is an error") {
    const json document = json::parse(report_json({ball_case("ball", 1.5F)}));
    const auto message = [&](const char* pointer, const json& value) {
        json changed = document;
        changed[json::json_pointer(pointer)] = value;
        return test::message_of([&] { cases_of_json(changed.dump()); });
    };
    CHECK(message("/version", 2) == "is not of version 1");
    const std::string no_report = "is no report of penumbra: ";
    CHECK(message("/cases/0/name", 1).starts_with(no_report));
    CHECK(message("/cases/0/metrics/flip/value", "x").starts_with(no_report));
    CHECK(message("/cases/0/worst_pixel/test", {0.5}).starts_with(no_report));
    CHECK(test::message_of([] { cases_of_json("[1"); }).starts_with(no_report));
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

TEST_CASE("The JUnit document escapes every text") {
    const std::string xml = report_junit({evil_case()});
    CHECK(xml_defect(xml) == "");
    CHECK(has(xml, "name=\"&lt;script&gt;alert(1)&lt;/script&gt;&quot;&#39;&amp;]]&gt;"));
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
