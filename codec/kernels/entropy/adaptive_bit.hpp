// A probability that learns: the mean of a fast and a slow estimate.
#pragma once

#include <cstdint>

#include "range_coder.hpp"

namespace ebz {

class AdaptiveBit {
public:
    template <class Coder>
    bool code(Coder& coder, bool bit) {
        bit = coder.bit(bit, (static_cast<uint32_t>(fast_) + slow_) >> 1);
        const int32_t target = bit ? ceiling : floor;
        fast_ = static_cast<uint16_t>(fast_ + ((target - fast_) >> 4));
        slow_ = static_cast<uint16_t>(slow_ + ((target - slow_) >> 7));
        return bit;
    }

    // Estimates stay within [floor, ceiling] (shifts round down, so floor is met and ceiling is not):
    // the cheapest bit costs log2(2^16 / (2^16 - 32)) = 0.0007 bits, which bounds declared counts.
    static constexpr int32_t floor = 32, ceiling = 65536 - 32;

private:
    uint16_t fast_ = 32768, slow_ = 32768;
};

}  // namespace ebz
