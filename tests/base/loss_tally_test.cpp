// Losses that say the same are told once, with their number.
#include "base/loss_tally.h"
#include "support/support.h"

using namespace penumbra;

namespace {

Loss ignored(const std::string& place, const std::string& what = "sheen is ignored") {
    return {Loss::dropped, place, what};
}

}  // namespace

TEST_CASE("A loss tally, tells a sentence once, at the first place and with its number") {
    LossTally tally;
    tally.add(ignored("a"));
    tally.add({Loss::approximated, "b", "fog is thin"});
    tally.add(ignored("c"));
    tally.add(ignored("d"));
    CHECK(tally.losses() == Losses{{Loss::dropped, "a", "sheen is ignored (3 times)", 3},
                                   {Loss::approximated, "b", "fog is thin"}});
}

TEST_CASE("A loss tally, leaves alone what is not to be counted") {
    LossTally tally;
    tally.add(ignored("a"));
    tally.add_alone(ignored("b"));
    tally.add_alone(ignored("b"));
    tally.add(ignored("c"));
    CHECK(tally.losses() == Losses{{Loss::dropped, "a", "sheen is ignored (2 times)", 2},
                                   ignored("b"),
                                   ignored("b")});
}

TEST_CASE("A loss tally, counts by what the sentences have in common") {
    LossTally tally(LossTally::and_more);
    tally.add(ignored("a", "oak: Ps is ignored"), {.sentence = "Ps is ignored"});
    tally.add(ignored("b", "elm: Ps is ignored"), {.sentence = "Ps is ignored"});
    CHECK(tally.losses() == Losses{{Loss::dropped, "a", "oak: Ps is ignored (and 1 more)", 2}});
}

TEST_CASE("A loss tally, counts a thing once, and of a subject of it only what is said first") {
    const int oak = 0, elm = 0;
    LossTally tally;
    const auto add = [&](const int& thing, const char* what, const char* subject) {
        tally.add(ignored("a", what), {.sentence = what, .thing = &thing, .subject = subject});
    };
    add(oak, "Ps is ignored", "");
    add(oak, "Ps is ignored", "");
    add(oak, "Kd 2 is out of range", "kd");
    add(oak, "Kd 3 is out of range", "kd");
    add(elm, "Ps is ignored", "");
    add(elm, "Kd 3 is out of range", "kd");
    CHECK(tally.losses() == Losses{{Loss::dropped, "a", "Ps is ignored (2 times)", 2},
                                   ignored("a", "Kd 2 is out of range"),
                                   ignored("a", "Kd 3 is out of range")});
}

TEST_CASE("A loss tally, adds up things of one kind") {
    LossTally tally;
    tally.add_ignored("a", "point", 1);
    tally.add_ignored("b", "line", 2);
    CHECK(tally.losses() ==
          Losses{ignored("a", "1 point is ignored"), ignored("b", "2 lines are ignored")});
    tally.add_ignored("c", "point", 5);
    CHECK(tally.losses()[0] == Loss{Loss::dropped, "a", "6 points are ignored (2 times)", 2});
}

TEST_CASE("A loss tally, takes all sentences beyond its limit as one, also of a later part") {
    LossTally first(LossTally::times, 2), later(LossTally::times, 2);
    first.add(ignored("a", "A"));
    later.add(ignored("b", "B"));
    later.add(ignored("c", "C"));
    later.add({Loss::approximated, "d", "D"});
    later.add(ignored("e", "B"));
    first.append(later);
    CHECK(first.losses() ==
          Losses{ignored("a", "A"),
                 {Loss::dropped, "b", "B (2 times)", 2},
                 {Loss::dropped, "c", "other things of many kinds are ignored (2 times)", 2}});
    CHECK(first.add_again("A"));
    CHECK_FALSE(first.add_again("E"));
    CHECK(first.losses()[0] == Loss{Loss::dropped, "a", "A (2 times)", 2});
}

TEST_CASE("Merged losses, keep their counts and are told apart by kind and place") {
    const Losses losses = {{Loss::dropped, "a", "A (2 times)", 2},
                           {Loss::dropped, "b", "A (2 times)", 2},
                           {Loss::approximated, "c", "C"},
                           {Loss::dropped, "c", "C"},
                           {Loss::dropped, "c", "C"}};
    CHECK(merged(losses) ==
          Losses{losses[0], losses[1], losses[2], {Loss::dropped, "c", "C (2 times)", 2}});
    CHECK(merged_places({losses[0], losses[1], losses[3]}) ==
          Losses{{Loss::dropped, "a", "A (2 times) (and 1 more)", 4}, losses[3]});
}
