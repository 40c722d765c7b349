// Runs a target on files, without libFuzzer: fuzz_replay TARGET FILE_OR_FOLDER...
// Names each input before it runs; one that breaks a rule aborts the program.
#include "fuzz.h"

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <iterator>

namespace {

namespace fs = std::filesystem;

std::vector<fs::path> files_in(const char* name) {
    if (!fs::is_directory(name)) return {name};
    std::vector<fs::path> files;
    for (const auto& entry : fs::recursive_directory_iterator(name))
        if (entry.is_regular_file()) files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    return files;
}

bool run(const fuzz::Target& target, const fs::path& file) {
    std::puts(file.c_str());
    std::fflush(stdout);
    std::ifstream in(file, std::ios::binary);
    if (!in) return false;
    const std::string input{std::istreambuf_iterator<char>(in), {}};
    fuzz::start_memory_count();
    target.run(input);
    return true;
}

}  // namespace

int main(int count, char** words) {
    const fuzz::Target* const target = count > 1 ? fuzz::target_named(words[1]) : nullptr;
    if (target == nullptr || count < 3) {
        std::fputs("Usage: fuzz_replay TARGET FILE_OR_FOLDER...\n", stderr);
        return 2;
    }
    std::size_t done = 0;
    for (int i = 2; i < count; ++i) {
        for (const fs::path& file : files_in(words[i])) {
            if (!run(*target, file)) {
                std::fputs("cannot be read\n", stderr);
                return 2;
            }
            ++done;
        }
    }
    std::printf("%zu inputs of target %s are harmless\n", done, target->name);
    return done == 0 ? 1 : 0;
}
