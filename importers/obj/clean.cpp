#include "importers/obj/clean.h"

#include "base/memory.h"
#include "base/parallel.h"
#include "importers/obj/left_out.h"
#include "importers/obj/text/encoding.h"
#include "importers/obj/text/tally.h"
#include "importers/obj/text/words.h"

#include "penumbra/limits.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <span>

namespace penumbra::obj {

namespace {

struct Cleaner {
    const std::string& file;
    Tally& tally;
    Piece result = {};
    Index line = 0;
    std::string mended = {};

    [[noreturn]] void fail(const std::string& problem) const {
        throw Error(Failure::input, place_of(file, line), problem);
    }

    void keep(std::string_view text) { result.text += text; }

    // "3.1+e2", seen in the wild, means 3.1e+2. Returns whether there was something to mend.
    bool mend(std::string_view& rest) {
        std::string words(rest);
        for (std::size_t at = 1; at + 1 < words.size(); ++at)
            if ((words[at] == '+' || words[at] == '-') && words[at + 1] == 'e')
                std::swap(words[at], words[at + 1]);
        if (words == rest) return false;
        tally.add(Loss::approximated,
                  "a sign before the e of an exponent is taken as the exponent's", line);
        mended = std::move(words);
        rest = mended;
        return true;
    }

    // Makes 0 of the numbers of a v or vt line that are not finite. Whether a vertex may be without
    // a position depends on whether a face uses it.
    void replace_not_finite(std::string_view keyword, std::string_view& rest) {
        std::string words;
        const std::size_t used = keyword == "v" ? 3 : 2;
        std::size_t at = 0;
        for (auto word = next_word(rest); !word.empty(); word = next_word(rest), ++at) {
            const bool bad = kind_of(word) == Word::not_finite;
            (words += ' ') += bad ? "0" : word;
            if (!bad) continue;
            if (keyword == "v" && at < used)
                lose_position(word);
            else if (keyword == "v" || at < used)
                tally.add(Loss::approximated,
                          fmt::format("a number of {} that is not finite is taken as 0",
                                      keyword == "v" ? "a vertex colour" : "vt"),
                          line);
        }
        mended = std::move(words);
        rest = mended;
    }

    void lose_position(std::string_view word) {
        std::vector<NotFinite>& list = result.not_finite;
        if (!list.empty() && list.back().vertex == result.counts.positions) return;
        make_room(list, file);
        list.push_back({result.counts.positions, line, printable(word)});
    }

    // Checks the numbers of a v, vt or vn line; returns how many there are.
    std::size_t numbers(std::string_view keyword, std::string_view& rest, std::size_t least) {
        std::size_t count = 0;
        std::string_view ahead = rest;
        for (auto word = next_word(ahead); !word.empty(); word = next_word(ahead), ++count) {
            const Word kind = kind_of(word);
            if (kind == Word::number) continue;
            if (kind == Word::not_finite) {
                replace_not_finite(keyword, rest);
                return numbers(keyword, rest, least);
            }
            if (mend(rest)) return numbers(keyword, rest, least);
            fail(fmt::format("{} has '{}' where a number should be", keyword, printable(word)));
        }
        if (count < least)
            fail(fmt::format("{} needs {} numbers but has {}", keyword, least, count));
        return count;
    }

    void vertex(std::string_view rest) {
        const std::size_t count = numbers("v", rest, 3);
        if (count >= 6) color(rest);
        ++result.counts.positions;
        if (count == 4) weight(rest);
        if (count == 5 || count > 6)
            tally.add(Loss::dropped, "numbers at the end of a v line are ignored", line);
        (result.text += "v ") += rest;
    }

    static float number(std::string_view& rest) {
        std::string_view word = next_word(rest);
        if (word.starts_with('+')) word.remove_prefix(1);
        float value = 0;
        std::from_chars(word.data(), word.data() + word.size(), value);
        return value;
    }

    void color(std::string_view rest) {
        for (int skip = 0; skip < 3; ++skip) next_word(rest);
        Color color(0);
        for (int i = 0; i < 3; ++i) {
            color[i] = std::max(number(rest), 0.0F);
            result.brightest = std::max(result.brightest, color[i]);
        }
        make_room(result.colors, file);
        result.colors.push_back(color);
        std::vector<ColorRun>& runs = result.color_runs;
        const std::size_t vertex = result.counts.positions;
        if (runs.empty() || runs.back().vertex + runs.back().count != vertex) {
            make_room(runs, file);
            runs.push_back({.vertex = vertex});
        }
        ++runs.back().count;
    }

    // "#MRGB MMRRGGBBMMRRGGBB...", in hexadecimal: mask and colour of one vertex after the other,
    // as ZBrush says in a comment of its files. The mask is for painting only.
    void polypaint(std::string_view rest) {
        Polypaint row = {.vertices = result.counts.positions, .line = line};
        for (auto word = next_word(rest); !word.empty(); word = next_word(rest))
            for (; !word.empty(); word.remove_prefix(8), ++row.count) {
                unsigned value = 0;
                const char* const end = word.data() + std::min(word.size(), std::size_t(8));
                const auto [next, error] = std::from_chars(word.data(), end, value, 16);
                if (word.size() < 8 || next != end || error != std::errc{}) {
                    if (result.bad_polypaint == 0) result.bad_polypaint = line;
                    return;
                }
                make_room(result.paint, file);
                result.paint.push_back(Color(float(value >> 16 & 0xff), float(value >> 8 & 0xff),
                                             float(value & 0xff)) /
                                       255);
            }
        make_room(result.polypaint, file);
        result.polypaint.push_back(row);
    }

    void weight(std::string_view rest) {
        for (int skip = 0; skip < 3; ++skip) next_word(rest);
        if (number(rest) != 1)
            tally.add(Loss::dropped, "the weight w of a vertex is ignored: facets have none", line);
    }

    // A normal that is no number is a common export fault; it becomes zero, which the facet's
    // replaces later.
    void normal(std::string_view rest) {
        ++result.counts.normals;
        std::string_view words = rest;
        for (auto word = next_word(words); !word.empty(); word = next_word(words)) {
            if (kind_of(word) != Word::not_finite) continue;
            keep("vn 0 0 0");
            return;
        }
        numbers("vn", rest, 3);
        (result.text += "vn ") += rest;
    }

    void texcoord(std::string_view rest) {
        ++result.counts.texcoords;
        numbers("vt", rest, 1);
        (result.text += "vt ") += rest;
    }

    // Takes an index off the front of `rest`, up to a slash; none where there is none.
    std::optional<int> take_index(std::string_view& rest, std::string_view word) const {
        if (rest.size() > 1 && rest[0] == '+' && rest[1] != '-') rest.remove_prefix(1);
        int value = 0;
        const auto [next, error] = std::from_chars(rest.data(), rest.data() + rest.size(), value);
        if (error == std::errc::result_out_of_range)
            fail(fmt::format("index '{}' is out of range", printable(word)));
        if (error != std::errc{}) return {};
        rest.remove_prefix(std::size_t(next - rest.data()));
        if (!rest.empty() && rest.front() != '/') return {};
        return value;
    }

    // The corner without those of its indices that are 0, which some programs write where there is
    // nothing.
    std::string_view without_zeros(std::span<const int> indices, std::string_view word) {
        if (indices[0] == 0)
            fail(fmt::format("'{}' has the index 0; the first is 1", printable(word)));
        mended = fmt::format("{}", indices[0]);
        for (std::size_t part = 1; part < indices.size(); ++part) {
            mended += '/';
            if (indices[part] != 0) mended += fmt::format("{}", indices[part]);
        }
        while (mended.ends_with('/')) mended.pop_back();
        return mended;
    }

    void lose_zero(std::size_t part) {
        tally.add(Loss::dropped,
                  fmt::format("a {} index of 0 is ignored; the first is 1",
                              part == 1 ? "texture coordinate" : "normal"),
                  line);
    }

    // "7", "7/1", "7//3", "7/1/3", and "7/", "7//", "7/1/", which lose the slashes at their end.
    std::string_view corner(std::string_view word) {
        std::string_view kept = word;
        while (kept.ends_with('/')) kept.remove_suffix(1);
        std::string_view rest = kept;
        std::array<int, 3> indices = {0, 0, 0};
        bool zero = false;
        for (std::size_t part = 0; part < 3; ++part) {
            const bool omitted = part == 1 && rest.starts_with('/');
            if (!omitted) {
                const std::optional<int> index = take_index(rest, word);
                if (!index) break;
                indices[part] = *index;
                if (*index == 0 && part > 0) lose_zero(part);
                zero = zero || *index == 0;
            }
            if (rest.empty()) return zero ? without_zeros(indices, word) : kept;
            rest.remove_prefix(1);
        }
        fail(fmt::format("'{}' is not a vertex of the form v, v/vt, v//vn or v/vt/vn",
                         printable(word)));
    }

    void face(std::string_view rest) {
        const std::size_t begin = result.text.size();
        keep("f");
        std::size_t count = 0;
        for (auto word = next_word(rest); !word.empty(); word = next_word(rest), ++count)
            (result.text += ' ') += corner(word);
        if (count < 3) {
            tally.add(Loss::dropped, "a face with fewer than three corners is ignored", line);
            result.text.resize(begin);
            return;
        }
        make_room(result.face_lines, file);
        result.face_lines.push_back(line);
        ++result.counts.faces;
        result.counts.corners += count;
    }

    void change(Change::Of of, std::string name, Index number = 0) {
        // Of what is said twice before a face the second counts.
        if (of != Change::Of::material && !result.changes.empty() &&
            result.changes.back().of == of && result.changes.back().face == result.counts.faces)
            result.changes.pop_back();
        make_room(result.changes, file);
        result.changes.push_back({of, result.counts.faces, std::move(name), number, line});
    }

    void smoothing(std::string_view rest) {
        const std::string_view word = next_word(rest);
        Index value = 0;
        const auto [next, error] = std::from_chars(word.data(), word.data() + word.size(), value);
        const bool is_number = error == std::errc{} && next == word.data() + word.size();
        if (!is_number && word == "on")
            value = 1;
        else if (!is_number && word != "off")
            tally.add(
                Loss::approximated,
                fmt::format("smoothing group '{}' is not a number; taken as off", printable(word)),
                line);
        change(Change::Of::smoothing, "", value);
    }

    // A face may be of several groups.
    static std::string group_names(std::string_view text) {
        std::string names;
        std::string_view rest = name_without_comment(text);
        for (auto word = next_word(rest); !word.empty() && names.size() <= max_name;
             word = next_word(rest))
            (names += names.empty() ? "" : " ") += word;
        return kept_name(names);
    }

    void other(std::string_view keyword) {
        const std::string what = left_out(keyword);
        if (!what.empty()) tally.add(Loss::dropped, what, line);
    }

    void statement(std::string_view text) {
        const std::string_view keyword = next_word(text);
        if (keyword == "#MRGB") return polypaint(text);
        if (keyword.empty() || keyword.front() == '#') return;
        const std::string_view plain = without_comment(text);
        if (keyword == "v") return vertex(plain);
        if (keyword == "f" || keyword == "fo") return face(plain);
        if (keyword == "vt") return texcoord(plain);
        if (keyword == "vn") return normal(plain);
        if (keyword == "s") return smoothing(plain);
        if (keyword == "usemtl")
            return change(Change::Of::material, kept_name(name_without_comment(text)));
        if (keyword == "o")
            return change(Change::Of::object, kept_name(name_without_comment(text)));
        if (keyword == "g") return change(Change::Of::group, group_names(text));
        if (keyword == "mtllib") return result.libraries.push_back({std::string(trim(text)), line});
        other(keyword);
    }

    void clean(std::string_view lines) {
        const MemoryClaim claim(2 * lines.size(), file);
        result.text.reserve(lines.size() + 1);
        for (std::size_t at = 0; at < lines.size(); ++line) {
            const std::size_t end = std::min(lines.find('\n', at), lines.size());
            statement(lines.substr(at, end - at));
            keep("\n");
            at = end + 1;
        }
    }
};

// A text in runs of whole lines, long enough to be worth a task.
std::vector<std::string_view> pieces_of(std::string_view text) {
    constexpr std::size_t least = 1U << 20U;
    std::vector<std::string_view> pieces;
    while (!text.empty()) {
        const std::size_t end = text.size() > least ? text.find('\n', least) : text.npos;
        pieces.push_back(text.substr(0, end == text.npos ? end : end + 1));
        text.remove_prefix(pieces.back().size());
    }
    return pieces;
}

}  // namespace

std::vector<Piece> clean_obj(std::string bytes, const std::string& file, Tally& tally) {
    const std::size_t size = bytes.size();
    MemoryClaim claim(2 * size, file);
    const std::string text = to_lines(std::move(bytes));
    claim = {};
    const std::vector<std::string_view> lines = pieces_of(text);
    std::vector<Piece> pieces(lines.size());
    std::vector<Tally> tallies(lines.size(), Tally{.file = file});
    for (std::size_t i = 1; i < lines.size(); ++i)
        pieces[i].first_line =
            pieces[i - 1].first_line + Index(std::ranges::count(lines[i - 1], '\n'));
    for_each_in_parallel(lines.size(), [&](std::size_t i) {
        const Index first_line = pieces[i].first_line;
        Cleaner cleaner = {.file = file,
                           .tally = tallies[i],
                           .result = {.first_line = first_line},
                           .line = first_line};
        cleaner.clean(lines[i]);
        pieces[i] = std::move(cleaner.result);
    });
    for (const Tally& part : tallies) tally.losses.append(part.losses);
    return pieces;
}

}  // namespace penumbra::obj
