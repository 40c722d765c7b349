#include "base/text/number.h"
#include "support/support.h"

#include <limits>

using namespace penumbra;

TEST_CASE("A number that is not quite 1 does not look like 1") {
    CHECK(number_text(1) == "1");
    CHECK(number_text(0.5) == "0.5");
    CHECK(number_text(0.123456789) == "0.123457");
    CHECK(number_text(1 - 1.0 / 8294400) == "0.9999999");
    CHECK(number_text(1 - 1.0 / 30000000) == "0.99999997");
    CHECK(number_text(std::numeric_limits<double>::quiet_NaN()) == "nan");
}

TEST_CASE("A number is told from the limit that it does not meet") {
    CHECK(number_text(0.99499996, 0.995) == "0.99499996");
    CHECK(number_text(0.99499985, 0.9949999) == "0.99499985");
    CHECK(number_text(-0.00300000001, 0.003) == "-0.00300000001");
    CHECK(number_text(0.995, 0.995) == "0.995");
    CHECK(number_text(0.99, 0.995) == "0.99");
    CHECK(limit_text(0.995) == "0.995");
    CHECK(limit_text(0.99999999) == "0.99999999");
}
