// What coding a vertex leaves behind for its neighbours.
#pragma once

#include <array>
#include <cstdint>

namespace ebz::positions {

// Positions are signed integers modulo 2^32 or 2^64; the fourth of each does not matter.
template <class Unsigned>
struct alignas(32) Site {
    std::array<Unsigned, 4> position;
    std::array<float, 4> residual;
};

}  // namespace ebz::positions
