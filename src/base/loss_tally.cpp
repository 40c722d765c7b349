#include "base/loss_tally.h"

#include <fmt/format.h>

#include <utility>

namespace penumbra {

std::string LossTally::times(std::size_t count) { return fmt::format(" ({} times)", count); }

std::string LossTally::and_more(std::size_t count) {
    return fmt::format(" (and {} more)", count - 1);
}

std::string LossTally::Entry::what(Ending ending) const {
    std::string text = loss.what;
    if (ignored > 0)
        text = fmt::format("{} {}{} ignored", ignored, loss.what, ignored == 1 ? " is" : "s are");
    return said > 1 ? text + ending(said) : text;
}

// The entry that losses with this sentence are counted in; a new one has counted none.
LossTally::Entry& LossTally::entry(const Loss& loss, const std::string& sentence) {
    if (const auto found = known_.find(sentence); found != known_.end())
        return entries_[found->second];
    const bool full = known_.size() >= most_sentences_;
    const std::string others = "other things of many kinds are ignored";
    const auto [place, fresh] = known_.try_emplace(full ? others : sentence, entries_.size());
    if (!fresh) return entries_[place->second];
    entries_.push_back({.loss = loss, .sentence = place->first});
    entries_.back().loss.count = 0;
    if (full) {
        entries_.back().loss.kind = Loss::dropped;
        entries_.back().loss.what = others;
    }
    return entries_.back();
}

void LossTally::add(const Loss& loss, const About& about) {
    if (!about.subject.empty()) {
        if (std::exchange(thing_, about.thing) != about.thing) subjects_.clear();
        if (!subjects_.insert(about.subject).second) return;
    }
    Entry& counted = entry(loss, about.sentence);
    const bool repeated = about.thing != nullptr && counted.thing == about.thing;
    counted.thing = about.thing;
    if (repeated) return;
    ++counted.said;
    counted.loss.count += loss.count;
}

void LossTally::add_alone(const Loss& loss) { entries_.push_back({.loss = loss, .said = 1}); }

void LossTally::add_ignored(const std::string& place, const std::string& noun, std::size_t number) {
    Entry& counted = entry({Loss::dropped, place, noun}, noun);
    ++counted.said;
    ++counted.loss.count;
    counted.ignored += number;
}

bool LossTally::add_again(const std::string& sentence) {
    const auto found = known_.find(sentence);
    if (found == known_.end()) return false;
    ++entries_[found->second].said;
    ++entries_[found->second].loss.count;
    return true;
}

void LossTally::append(const LossTally& later) {
    for (const Entry& own : later.entries_) {
        if (own.sentence.empty()) {
            entries_.push_back(own);
            continue;
        }
        Entry& counted = entry(own.loss, own.sentence);
        counted.said += own.said;
        counted.loss.count += own.loss.count;
        counted.ignored += own.ignored;
        counted.thing = own.thing;
    }
}

Losses LossTally::losses() const {
    Losses result;
    result.reserve(entries_.size());
    for (const Entry& each : entries_) {
        result.push_back(each.loss);
        result.back().what = each.what(ending_);
    }
    return result;
}

Losses merged(const Losses& losses) {
    LossTally tally;
    for (const Loss& loss : losses)
        tally.add(loss,
                  {.sentence = fmt::format("{}\n{}\n{}", int(loss.kind), loss.place, loss.what)});
    return tally.losses();
}

Losses merged_places(const Losses& losses) {
    LossTally tally(LossTally::and_more);
    for (const Loss& loss : losses) tally.add(loss);
    return tally.losses();
}

}  // namespace penumbra
