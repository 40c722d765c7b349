// The house keeps its floors: what a file may include is in rooms.txt.
#include "support/support.h"

#include <algorithm>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <vector>

namespace {

namespace fs = std::filesystem;
using Names = std::set<std::string>;

const fs::path source = PENUMBRA_SOURCE_DIR;

// By room: the rooms that its files may include.
std::map<std::string, Names> read_rooms() {
    std::map<std::string, Names> rooms;
    std::istringstream text(test::read(source / "tests/layers/rooms.txt"));
    for (std::string line; std::getline(text, line);) {
        if (line.empty() || line[0] == '#') continue;
        std::istringstream words(line);
        std::string room, word;
        words >> room;
        REQUIRE(room.back() == ':');
        room.pop_back();
        Names allowed;
        while (words >> word) {
            const bool whole = word[0] == '+';
            const std::string name = word.substr(whole ? 1 : 0);
            INFO(room << " names " << name << ", which does not stand above it");
            REQUIRE(rooms.contains(name));
            allowed.insert(name);
            if (whole) allowed.insert(rooms[name].begin(), rooms[name].end());
        }
        rooms[room] = allowed;
    }
    return rooms;
}

using Folders = std::vector<std::string>;
const Folders rooms_of_sources = {"src", "importers", "exporters", "validation"};

std::vector<fs::path> sources(const Folders& folders = rooms_of_sources) {
    std::vector<fs::path> files;
    for (const std::string& top : folders)
        for (const auto& entry : fs::recursive_directory_iterator(source / top))
            if (entry.path().extension() == ".h" || entry.path().extension() == ".cpp")
                files.push_back(fs::relative(entry.path(), source));
    std::sort(files.begin(), files.end());
    return files;
}

struct Includes {
    std::vector<fs::path> ours = {};  // relative to the repository
    Names unknown = {};               // quoted, but no file of ours
};

// Ours are spelled from src/ or from the repository, in quotes or, as the compiler allows, not.
Includes includes_in(const std::string& text) {
    static const std::regex pattern("(^|\\n)[ \t]*#[ \t]*include[ \t]*([<\"])([^>\"]+)[>\"]");
    Includes found;
    for (std::sregex_iterator i(text.begin(), text.end(), pattern), end; i != end; ++i) {
        const std::string name = (*i)[3];
        if (fs::exists(source / "src" / name))
            found.ours.push_back((fs::path("src") / name).lexically_normal());
        else if (fs::exists(source / name))
            found.ours.push_back(fs::path(name).lexically_normal());
        else if ((*i)[2] == "\"")
            found.unknown.insert(name);
    }
    return found;
}

std::vector<fs::path> includes(const fs::path& file) {
    return includes_in(test::read(source / file)).ours;
}

std::string room_of(const fs::path& file) { return file.parent_path().generic_string(); }

// A header and its source are one thing.
std::string unit_of(const fs::path& file) {
    return (file.parent_path() / file.stem()).generic_string();
}

class Circles {
  public:
    explicit Circles(const std::map<std::string, Names>& includes) : includes_(includes) {
        for (const auto& [unit, ignored] : includes) visit(unit);
    }
    const std::vector<std::string>& found() const { return found_; }

  private:
    void visit(const std::string& unit) {
        const auto again = std::find(path_.begin(), path_.end(), unit);
        if (again != path_.end()) {
            std::string circle;
            for (auto i = again; i != path_.end(); ++i) circle += *i + " -> ";
            found_.push_back(circle + unit);
            return;
        }
        if (!seen_.insert(unit).second) return;
        path_.push_back(unit);
        if (const auto entry = includes_.find(unit); entry != includes_.end())
            for (const std::string& next : entry->second) visit(next);
        path_.pop_back();
    }

    const std::map<std::string, Names>& includes_;
    Names seen_ = {};
    std::vector<std::string> path_ = {}, found_ = {};
};

}  // namespace

TEST_CASE("layers, no file includes a room above or beside its own") {
    const auto rooms = read_rooms();
    std::size_t arrows = 0;
    for (const fs::path& file : sources()) {
        const auto room = rooms.find(room_of(file));
        {
            INFO(file.string() << " is in no room of tests/layers/rooms.txt");
            REQUIRE(room != rooms.end());
        }
        for (const fs::path& header : includes(file)) {
            const std::string there = room_of(header);
            if (there == room->first) continue;
            ++arrows;
            INFO(file.string() << " includes " << header.string());
            CHECK((there == "src/penumbra" || room->second.contains(there)));
        }
    }
    CHECK(arrows > 300);
}

TEST_CASE("layers, an include of ours is seen however it is spelled") {
    const Includes found = includes_in("#include \"base/hash.h\"\n  # include <base/file.h>\n"
                                       "#include <vector>\n#include \"hash.h\"\n"
                                       "#include \"importers/obj/parse.h\"\n");
    CHECK(found.ours ==
          std::vector<fs::path>{"src/base/hash.h", "src/base/file.h", "importers/obj/parse.h"});
    CHECK(found.unknown == Names{"hash.h"});
}

TEST_CASE("layers, every include in quotes is spelled from src or from the repository") {
    for (const fs::path& file : sources())
        for (const std::string& name : includes_in(test::read(source / file)).unknown)
            FAIL_CHECK(file.string() << " includes \"" << name << "\", which is in neither");
}

TEST_CASE("layers, no circle of files includes itself") {
    std::map<std::string, Names> units;
    for (const fs::path& file : sources())
        for (const fs::path& header : includes(file))
            if (unit_of(header) != unit_of(file)) units[unit_of(file)].insert(unit_of(header));
    const Circles circles(units);
    for (const std::string& circle : circles.found()) UNSCOPED_INFO(circle);
    CHECK(circles.found().empty());
}

TEST_CASE("layers, rooms and files stay small enough to read") {
    std::map<std::string, int> files;
    Folders folders = rooms_of_sources;
    folders.insert(folders.end(), {"tests", "bench"});
    for (const fs::path& file : sources(folders)) {
        ++files[room_of(file)];
        const std::string text = test::read(source / file);
        INFO(file.string());
        CHECK(std::count(text.begin(), text.end(), '\n') <= 400);
    }
    for (const auto& [room, count] : files) {
        INFO(room);
        CHECK(count <= 25);
    }
}
