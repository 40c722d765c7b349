// The command line that the programs of bench/ share.
#pragma once

#include "penumbra/error.h"
#include "penumbra/importers.h"

#include <charconv>
#include <string>
#include <vector>

namespace penumbra::bench {

struct Arguments {
    std::vector<std::string> names = {};  ///< what is no option
    LoadOptions load = {};                ///< --set KEY=VALUE
    int threads = 1;                      ///< --threads N
};

inline int whole_number(const std::string& word) {
    int value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size() || value < 1)
        throw Error(Failure::usage, "--threads", "'" + word + "' is not a number of threads");
    return value;
}

inline Arguments parse(int count, char** words) {
    Arguments out;
    for (int i = 1; i < count; ++i) {
        const std::string word = words[i];
        if (word == "--set" && i + 1 < count)
            out.load.settings.emplace_back(words[++i]);
        else if (word == "--threads" && i + 1 < count)
            out.threads = whole_number(words[++i]);
        else if (word.starts_with("-"))
            throw Error(Failure::usage, word, "unknown option, or one without its value");
        else
            out.names.push_back(word);
    }
    return out;
}

}  // namespace penumbra::bench
