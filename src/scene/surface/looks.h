// The looks that surfaces have.
#pragma once

#include "penumbra/scene.h"

#include <vector>

namespace penumbra {

/// Calls `work` with every material and with the second look of those that have one.
template <class Work>
void each_look(std::vector<Material>& materials, const Work& work) {
    for (Material& m : materials) {
        work(m);
        if (m.blend)
            for (Material& other : m.blend->other) work(other);
    }
}

}  // namespace penumbra
