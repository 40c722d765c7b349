#include "support/support.h"
#include "validation/povray/render_state.h"

#include "penumbra/image.h"

#include <bit>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

using namespace penumbra;

namespace {

std::string number(std::uint32_t value) {
    return {char(value >> 24), char(value >> 16), char(value >> 8), char(value)};
}

std::string pixel(const Color& c) {
    std::string text;
    for (const float f : {c.x, c.y, c.z, 0.F, 0.F}) text += number(std::bit_cast<std::uint32_t>(f));
    return text;
}

std::string state_header() {
    std::string text = "POV-Ray Render State File0001";
    text.resize(512);
    return text;
}

// A message about the pixels of [left, right] x [top, bottom], with things of no interest.
std::string block(std::uint32_t left, std::uint32_t top, std::uint32_t right, std::uint32_t bottom,
                  const std::string& pixels) {
    const auto integer = [](const std::string& key, std::uint32_t value) {
        return key + "INT4" + number(4) + number(value);
    };
    std::string body = "OBJE" + number(8);
    body += "OClaTYPE" + number(4) + "PixD";
    body += "MsrcADDR" + number(10) + std::string(10, 'x');
    body += "PBloVFL4" + number(std::uint32_t(pixels.size() / 4)) + pixels;
    body += "InneOBJE" + number(1) + integer("Left", 99);
    body += integer("Left", left) + integer("Top ", top) + integer("Righ", right) +
            integer("Bott", bottom);
    return "POVRAYMS" + number(0x370) + number(std::uint32_t(body.size())) + "RAWS" + body;
}

std::optional<Image> decoded(const std::string& text, int width, int height) {
    return decode_render_state(std::as_bytes(std::span(text)), width, height);
}

}  // namespace

TEST_CASE("A render-state file is read block by block") {
    const Color red = {1.5F, -0.25F, 0}, blue = {0, 0.1F, 3};
    const std::string file =
        state_header() + block(0, 0, 1, 1, pixel(red) + pixel(blue) + pixel(blue) + pixel(red)) +
        block(2, 0, 2, 1, pixel(blue) + pixel(blue));
    const auto image = decoded(file, 3, 2);
    REQUIRE(image);
    CHECK(image->at(0, 0) == red);
    CHECK(image->at(1, 0) == blue);
    CHECK(image->at(1, 1) == red);
    CHECK(image->at(2, 1) == blue);

    CHECK_FALSE(decoded(file, 4, 2));  // pixels missing
    CHECK_FALSE(decoded(file, 2, 2));  // blocks outside
    CHECK_FALSE(decoded(file, 0, 0));
    for (std::size_t size = 0; size < file.size(); ++size)
        if (decoded(file.substr(0, size), 3, 2)) FAIL("cut at " << size);
    CHECK_FALSE(decoded("POV-Rax" + file.substr(7), 3, 2));
}

TEST_CASE("A damaged render-state file is refused, not believed") {
    const std::string file = state_header() + block(0, 0, 1, 0, pixel(Color(1)) + pixel(Color(1)));
    REQUIRE(decoded(file, 2, 1));
    // Every byte of the structure in turn; what is still read must have the right size.
    for (std::size_t i = 512; i < file.size(); ++i) {
        for (const int value : {0x00, 0x01, 0x7f, 0x80, 0xff}) {
            std::string damaged = file;
            damaged[i] = char(value);
            const auto image = decoded(damaged, 2, 1);
            if (image) REQUIRE(image->pixels.size() == 2);
        }
    }
    // Objects in objects without end.
    std::string deep;
    for (int i = 0; i < 100'000; ++i) deep += "KeyXOBJE" + number(1);
    const std::string body = "OBJE" + number(1) + deep;
    CHECK_FALSE(decoded(state_header() + number(std::uint32_t(body.size())) + "RAWS" + body, 2, 1));
}
