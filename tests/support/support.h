// What tests share: folders, small files, and the message of a caught Error.
#pragma once

#include "support/catch.h"

#include "penumbra/error.h"

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <string>

// CTest shows a test that prints this as skipped.
#define PENUMBRA_SKIP(why)                                                                         \
    do {                                                                                           \
        std::cout << "SKIPPED: " << (why) << '\n';                                                 \
        return;                                                                                    \
    } while (false)

namespace test {

namespace fs = std::filesystem;

/// A folder of its own that is removed at the end.
struct TempDir {
    fs::path path;
    TempDir() {
        std::string name = (fs::temp_directory_path() / "penumbra-test-XXXXXX").string();
        path = mkdtemp(name.data());
    }
    ~TempDir() { fs::remove_all(path); }
    TempDir(const TempDir&) = delete;
    TempDir& operator=(const TempDir&) = delete;
    fs::path operator/(const std::string& name) const { return path / name; }
};

inline fs::path write(const fs::path& file, const std::string& text) {
    fs::create_directories(file.parent_path());
    std::ofstream(file, std::ios::binary) << text;
    return file;
}

inline std::string read(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

/// The message of the Error that `work` throws; "" when it throws none.
template <class Work>
std::string message_of(Work&& work) {
    try {
        work();
    } catch (const penumbra::Error& error) {
        return error.what();
    }
    return "";
}

/// What the Error that `work` throws says that its caller could allow; none when it throws none.
template <class Work>
penumbra::Remedy remedy_of(Work&& work) {
    try {
        work();
    } catch (const penumbra::Error& error) {
        return error.remedy;
    }
    return penumbra::Remedy::none;
}

/// Real models by other people; not in a user's clone.
inline fs::path assets() {
    const char* given = std::getenv("PENUMBRA_ASSETS");
    return given ? fs::path(given) : fs::path(PENUMBRA_SOURCE_DIR) / "../shared/assets";
}

}  // namespace test
