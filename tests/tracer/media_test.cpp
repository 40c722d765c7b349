// The transparent objects around a ray.
#include "support/support.h"
#include "tracer/media_stack.h"

using namespace penumbra;

namespace {

// Outermost last.
std::vector<Index> unwound(Media& media, MediumStack stack) {
    std::vector<Index> objects;
    while (stack.count() > 0) {
        objects.push_back(stack.last());
        CHECK_FALSE(media.toggle(stack, stack.last()));
    }
    return objects;
}

}  // namespace

TEST_CASE("Media, are entered and left in any order, however deep") {
    for (const Index depth : {1U, 7U, 8U, 40U, 200U}) {
        Media media;
        MediumStack stack;
        for (Index i = 0; i < depth; ++i) CHECK(media.toggle(stack, i));
        REQUIRE(stack.count() == depth);
        for (Index left = 0; left < depth; ++left) {
            MediumStack other = stack;
            CHECK_FALSE(media.toggle(other, left));
            CHECK(other.count() == depth - 1);
            CHECK_FALSE(other.contains(left));
            std::vector<Index> rest;
            for (Index i = depth; i-- > 0;)
                if (i != left) rest.push_back(i);
            CHECK(unwound(media, other) == rest);
        }
        CHECK(stack.contains(depth - 1));  // a ray's stack does not change with another's
        CHECK(stack.count() == depth);
    }
}

TEST_CASE("Media, hold the same for rays that go the same way") {
    Media media;
    MediumStack first, second;
    for (const Index object : {5U, 3U, 9U}) {
        media.toggle(first, object);
        media.toggle(second, object);
    }
    media.toggle(second, 3);
    CHECK(unwound(media, first) == std::vector<Index>{9, 3, 5});
    CHECK(unwound(media, second) == std::vector<Index>{9, 5});
}
