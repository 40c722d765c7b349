// Nested transparent objects.
#pragma once

#include "penumbra/math.h"

#include <array>
#include <cassert>
#include <cstdint>
#include <deque>

namespace penumbra {

/// A transparent object around a ray, and those around that; shared by all rays that are in them.
struct Medium {
    Index object = no_index;
    std::uint32_t depth = 1;  ///< 1: the outermost
    const Medium* around = nullptr;
};

/// The transparent objects that a ray is inside of, in the order of entering, as POV-Ray keeps
/// them. Belongs to the Media that made it.
class MediumStack {
  public:
    MediumStack() = default;
    explicit MediumStack(const Medium* last) : last_(last) {}

    std::uint32_t count() const { return last_ == nullptr ? 0 : last_->depth; }
    /// The one entered last. Precondition: count() > 0.
    Index last() const {
        assert(last_ != nullptr);
        return last_->object;
    }
    bool contains(Index object) const {
        for (const Medium* m = last_; m != nullptr; m = m->around)
            if (m->object == object) return true;
        return false;
    }

  private:
    friend class Media;
    const Medium* last_ = nullptr;
};

/// Makes the stacks of one thread. Rays that go the same way share theirs, so that a path carries a
/// pointer however deep it is.
class Media {
  public:
    /// Crosses the surface of `object`. Returns whether that enters it.
    bool toggle(MediumStack& stack, Index object) {
        const bool enters = !stack.contains(object);
        stack.last_ = enters ? entered(object, stack.last_) : left(object, stack.last_);
        return enters;
    }
    /// Ends all stacks that it has made.
    void clear() {
        media_.clear();
        recent_.fill(nullptr);
    }

  private:
    std::deque<Medium> media_;
    std::array<const Medium*, 16> recent_ = {};  // by a hash

    const Medium* entered(Index object, const Medium* around) {
        const std::uint32_t depth = around == nullptr ? 1 : around->depth + 1;
        const Medium*& known = recent_[(object + depth) % recent_.size()];
        if (known == nullptr || known->object != object || known->around != around)
            known = &media_.emplace_back(Medium{object, depth, around});
        return known;
    }
    // The rest keeps its order; an object is in a stack once.
    const Medium* left(Index object, const Medium* last) {
        std::array<Index, 32> inner;
        const Medium* at = last;
        std::size_t count = 0;
        for (; at->object != object && count < inner.size(); at = at->around)
            inner[count++] = at->object;
        // What lies deeper than the array is left behind first.
        const Medium* rest = at->object == object ? at->around : left(object, at);
        while (count > 0) rest = entered(inner[--count], rest);
        return rest;
    }
};

}  // namespace penumbra
