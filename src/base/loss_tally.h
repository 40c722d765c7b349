// The same sentence about many things -> one Loss with their number.
#pragma once

#include "penumbra/error.h"

#include <cstddef>
#include <limits>
#include <string>
#include <unordered_map>
#include <unordered_set>
#include <vector>

namespace penumbra {

/// Counts losses that say the same; what they become stands at the place of the first.
class LossTally {
  public:
    /// How a sentence goes on that is said of `count` things, two or more.
    using Ending = std::string (*)(std::size_t count);
    static std::string times(std::size_t count);     ///< " (3 times)"
    static std::string and_more(std::size_t count);  ///< " (and 2 more)"

    /// What a loss is counted by.
    struct About {
        std::string sentence = {};    ///< the same for all that are counted together
        const void* thing = nullptr;  ///< one that is named several times in a row counts once
        std::string subject = {};     ///< of `thing`: only what is said first of it; empty: all is
    };

    /// Beyond `most` sentences all others are one.
    explicit LossTally(Ending of_many = times,
                       std::size_t most = std::numeric_limits<std::size_t>::max())
        : ending_(of_many), most_sentences_(most) {}

    void add(const Loss& loss) { add(loss, {.sentence = loss.what}); }
    void add(const Loss& loss, const About& about);
    /// A loss of its own, whatever else says the same.
    void add_alone(const Loss& loss);
    /// `number` things are ignored at `place`, each of them a `noun`: "6 points are ignored".
    void add_ignored(const std::string& place, const std::string& noun, std::size_t number);
    /// Counts a loss whose sentence is known already; false where it is not. Spares the making of
    /// places that nobody reads.
    bool add_again(const std::string& sentence);
    /// Adds what a later part has.
    void append(const LossTally& later);

    /// In the order of the first ones.
    Losses losses() const;

  private:
    struct Entry {
        Loss loss = {};             // the first, with the number of all
        std::string sentence = {};  // empty: alone
        std::size_t said = 0;       // how often; a loss may have a count of its own
        std::size_t ignored = 0;    // how many things of that noun
        const void* thing = nullptr;

        std::string what(Ending ending) const;
    };
    Ending ending_;
    std::size_t most_sentences_;
    std::vector<Entry> entries_ = {};
    std::unordered_map<std::string, std::size_t> known_ = {};  // sentences, into entries
    const void* thing_ = nullptr;                              // the last one with a subject
    std::unordered_set<std::string> subjects_ = {};            // of it

    Entry& entry(const Loss& loss, const std::string& sentence);
};

/// Equal losses as one, "(n times)".
Losses merged(const Losses& losses);

/// Losses that say the same of several places as one, "(and n more)".
Losses merged_places(const Losses& losses);

}  // namespace penumbra
