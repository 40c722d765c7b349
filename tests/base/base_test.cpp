// Hashes, text, file descriptors and temporary names.
#include "base/base64.h"
#include "base/descriptor.h"
#include "base/hash.h"
#include "base/temporary.h"
#include "base/text/ascii.h"
#include "base/text/decomposed.h"
#include "base/text/suggest.h"
#include "base/text/text.h"
#include "base/text/utf8.h"
#include "support/support.h"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>

using namespace penumbra;

namespace {

std::span<const std::byte> bytes_of(std::string_view text) {
    return std::as_bytes(std::span(text));
}

std::string text_of_bytes(const std::vector<std::byte>& bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

bool is_open(int descriptor) { return ::fcntl(descriptor, F_GETFD) != -1; }

}  // namespace

// The values of empty input are those of the specification (doc/xxhash_spec.md), the others of
// Debian's libxxhash.so (XXH3_64bits, XXH3_128bits).
TEST_CASE("hashes are XXH3 of all bytes, however they come") {
    CHECK(text_of(Hash().digest()) == "99aa06d3014798d86001c324468d497f");
    CHECK(hash_of({}) == 0x2d06800538d394c2U);
    CHECK(hash_of(bytes_of("penumbra")) == 0x0723eca6fa58faf2U);
    std::string long_text;
    for (int i = 0; i < 1000; ++i) long_text += std::to_string(i) + ",";
    Hash whole, pieces;
    whole.add(bytes_of(long_text));
    for (std::size_t at = 0; at < long_text.size(); at += 7)
        pieces.add(bytes_of(std::string_view(long_text).substr(at, 7)));
    CHECK(text_of(whole.digest()) == "545836c9155befd08ab48c0f33b8b879");
    CHECK(pieces.digest() == whole.digest());
    pieces.add(bytes_of("x"));
    CHECK_FALSE(pieces.digest() == whole.digest());
}

TEST_CASE("hashes of texts know where each ends") {
    Hash a, b;
    a.add("ab");
    a.add("c");
    b.add("a");
    b.add("bc");
    CHECK_FALSE(a.digest() == b.digest());
}

TEST_CASE("words that were mistyped are recognised") {
    CHECK(did_you_mean("rendre", {"export", "render"}) == " (did you mean 'render'?)");
    CHECK(did_you_mean("--SIZE", {"--size"}) == " (did you mean '--size'?)");
    CHECK(did_you_mean("xyz", {"export", "render"}).empty());
    CHECK(did_you_mean(std::string(200, 'a'), {std::string(199, 'a')}).empty());
}

TEST_CASE("extensions and letters are compared in lower case") {
    CHECK(lower_extension("a.b/C.TIFF") == ".tiff");
    CHECK(lower_extension("a.b/c").empty());
    CHECK(lower_case("\u00c4 AZ[@") == "\u00c4 az[@");
    CHECK(trimmed(" \ta b\t ") == "a b");
    CHECK(trimmed(" \t").empty());
    CHECK(trimmed("\ra\r ", " \r") == "a");
}

TEST_CASE("letters and digits are those of ASCII") {
    int letters = 0, digits = 0, either = 0;
    for (int c = -128; c < 128; ++c) {
        letters += is_letter(char(c)) ? 1 : 0;
        digits += is_digit(char(c)) ? 1 : 0;
        either += is_letter_or_digit(char(c)) ? 1 : 0;
    }
    CHECK(letters == 52);
    CHECK(digits == 10);
    CHECK(either == 62);
    for (const char c : {'a', 'z', 'A', 'Z'}) CHECK(is_letter(c));
    for (const char c : {'`', '{', '@', '[', '0', '\xe9'}) CHECK_FALSE(is_letter(c));
    CHECK((is_digit('0') && is_digit('9')));
}

TEST_CASE("quoted words stay on one line and are cut between characters") {
    CHECK(printable("a\nb\x7f\u009b\xff") == "a?b???");
    CHECK(printable("abcdef", 6) == "abcdef");
    CHECK(printable("abcdef", 5) == "abcde...");
    CHECK(printable("ab\u4e2d\u4e2d", 7) == "ab\u4e2d...");
}

TEST_CASE("UTF-8 is what RFC 3629 says it is") {
    for (const char* text : {"", "plain ASCII of more than eight bytes", "\u00e9", "\uffff",
                             "\U0010ffff", "12345678\u00e9"})
        CHECK(is_utf8(text));
    // Too long, surrogates, beyond Unicode, cut, continued without a start.
    for (const char* text : {"\xc0\x80", "\xe0\x80\x80", "\xed\xa0\x80", "\xf4\x90\x80\x80",
                             "\xf5\x80\x80\x80", "12345678\xe2\x82", "\x80", "a\xff"})
        CHECK_FALSE(is_utf8(text));
    for (const std::uint32_t code : {0x41U, 0x7fU, 0x80U, 0x7ffU, 0x800U, 0xffffU, 0x10000U}) {
        std::string text;
        append_utf8(text, code);
        std::uint32_t read = 0;
        CHECK(utf8_character(text, read) == text.size());
        CHECK(read == code);
    }
}

// The vectors of RFC 4648, section 10.
TEST_CASE("base64 is read and written") {
    const std::pair<const char*, const char*> vectors[] = {{"", ""},
                                                           {"f", "Zg=="},
                                                           {"fo", "Zm8="},
                                                           {"foo", "Zm9v"},
                                                           {"foob", "Zm9vYg=="},
                                                           {"fooba", "Zm9vYmE="},
                                                           {"foobar", "Zm9vYmFy"}};
    for (const auto& [plain, coded] : vectors) {
        CHECK(to_base64(bytes_of(plain)) == coded);
        CHECK(text_of_bytes(from_base64(coded).value()) == plain);
    }
    CHECK(text_of_bytes(from_base64("Zm 9v\r\nYg").value()) == "foob");
    CHECK_FALSE(from_base64("Zg==Zg"));
    CHECK_FALSE(from_base64("Z-_v"));
}

TEST_CASE("descriptors are closed once, by the last owner") {
    Descriptor first(::open("/dev/null", O_RDONLY | O_CLOEXEC));
    Descriptor second(::open("/dev/null", O_RDONLY | O_CLOEXEC));
    REQUIRE(first);
    const int kept = first.get(), dropped = second.get();
    second = std::move(first);
    CHECK_FALSE(first);
    CHECK(second.get() == kept);
    CHECK(is_open(kept));
    CHECK_FALSE(is_open(dropped));
    {
        const Descriptor last = std::move(second);
    }
    CHECK_FALSE(is_open(kept));
    CHECK_FALSE(Descriptor(-1));
}

TEST_CASE("spellings of the same text in Unicode become the same") {
    CHECK(decomposed("plain.png") == "plain.png");
    CHECK(decomposed("\u00e9") == "e\u0301");
    CHECK(decomposed("\u1ead") == "a\u0323\u0302");
    CHECK(decomposed("\u00e2\u0323") == decomposed("\u1ead"));
    CHECK(decomposed("\u1f82") == "\u03b1\u0313\u0300\u0345");
    CHECK(decomposed("\u0451") == "\u0435\u0308");
    CHECK(decomposed("\u304c\u30d1") == "\u304b\u3099\u30cf\u309a");
    CHECK(decomposed("\ud55c\uac00") == "\u1112\u1161\u11ab\u1100\u1161");
    CHECK(decomposed("\u212b") == decomposed("\u00c5"));
    // Marks of one class stay in their order, and so does what is no UTF-8.
    CHECK(decomposed("e\u0301\u0308") == "e\u0301\u0308");
    CHECK(decomposed("e\u0308\u0301") == "e\u0308\u0301");
    CHECK(decomposed("\xe9.png") == "\xe9.png");
    CHECK(decomposed("\u4e2d\U0001f600") == "\u4e2d\U0001f600");
}

TEST_CASE("what killed processes of this machine have left is removed, and nothing of others") {
    const test::TempDir folder;
    const pid_t gone = ::fork();
    if (gone == 0) ::_exit(0);
    ::waitpid(gone, nullptr, 0);
    const std::string self = std::to_string(::getpid()), dead = std::to_string(gone);
    const std::string mark = process_mark();
    REQUIRE(mark.ends_with('.' + self));
    const std::string machine = mark.substr(0, mark.size() - self.size());
    test::write(folder / ("a.png." + machine + dead + "-2.tmp"), "");
    test::write(folder / (".report." + machine + dead + ".tmp/index.html"), "");
    const std::vector<std::string> kept = {
        "a.png." + mark + "-1.tmp",              // at work
        "a.png." + machine + dead + "-2.tmp.x",  // not of this kind
        "a.png." + machine + "x.tmp",
        "a.png.other-" + machine + dead + "-2.tmp",  // of another host
        "a.png.x" + machine.substr(1) + dead + ".tmp",
        "a.png." + dead + "-2.tmp",  // of who knows whom
        "b.png." + machine + dead + "-2.tmp",
    };
    for (const std::string& name : kept) test::write(folder / name, "");
    remove_stale(folder.path, "a.png.");
    remove_stale(folder.path, ".report.");
    std::vector<std::string> left;
    for (const auto& entry : test::fs::directory_iterator(folder.path))
        left.push_back(entry.path().filename().string());
    std::vector<std::string> expected = kept;
    std::sort(left.begin(), left.end());
    std::sort(expected.begin(), expected.end());
    CHECK(left == expected);
}
