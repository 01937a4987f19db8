// The faces across the half-edges of faces of any size.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "attributes.hpp"

namespace ebz::attributes {

class FaceEdges {
public:
    explicit FaceEdges(const Items& items) : items_(items), face_(items.offsets.empty() ? 0 : items.opposite.size()) {
        if (face_.empty()) return;
        for (int32_t f = 0; f < items.n; ++f)
            for (int32_t h = begin(f); h < end(f); ++h) face_[static_cast<size_t>(h)] = f;
    }

    int32_t begin(int32_t f) const { return items_.offsets.empty() ? 3 * f : items_.offsets[static_cast<size_t>(f)]; }
    int32_t end(int32_t f) const { return begin(f + 1); }

    // -1 on a boundary.
    int32_t across(int32_t h) const {
        const int32_t o = items_.opposite[static_cast<size_t>(h)];
        if (o < 0) return -1;
        return face_.empty() ? o / 3 : face_[static_cast<size_t>(o)];
    }

private:
    const Items& items_;
    std::vector<int32_t> face_;  // of each half-edge, unless faces are triangles
};

}  // namespace ebz::attributes
