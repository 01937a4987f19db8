// Vertices without known neighbours: differences to the one before, in adaptive Exp-Golomb code.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "counter.hpp"

namespace ebz::positions {
inline namespace EBZ_INSTRUCTIONS {

class SeedModel {
public:
    template <class Coder>
    void code(Coder& coder, std::span<int64_t> position) {
        for (size_t d = 0; d < 3; ++d) {
            const auto value = static_cast<uint64_t>(position[d]);
            const uint64_t change = code_change(coder, d, value - static_cast<uint64_t>(last_[d]));
            last_[d] = position[d] = static_cast<int64_t>(static_cast<uint64_t>(last_[d]) + change);
        }
    }

private:
    static constexpr int max_digits = 62;

    template <class Coder>
    bool bit(Coder& coder, Counter& c, bool b) {
        const uint32_t p = std::clamp(c.p16(), 64u, 65472u);
        b = coder.bit(b, p);
        c.update(b, p);
        return b;
    }

    // Zigzag: 0, -1, 1, -2, ... become 0, 1, 2, 3, ...; u + 1 in [2^n, 2^(n+1)) has n digits below its top.
    template <class Coder>
    uint64_t code_change(Coder& coder, size_t d, uint64_t change) {
        const uint64_t u = (change << 1 ^ (0 - (change >> 63))) + 1;
        const int n = static_cast<int>(std::bit_width(u)) - 1;
        int k = 0;
        while (k < max_digits && bit(coder, n_digits_[d][static_cast<size_t>(k)], k < n)) ++k;
        uint64_t value = 1;
        for (int left = k; left > 0;) {
            const int step = std::min(left, 16);
            left -= step;
            value = value << step | coder.raw(static_cast<uint32_t>(u >> left) & ((1u << step) - 1), step);
        }
        --value;
        return value >> 1 ^ (0 - (value & 1));
    }

    std::array<int64_t, 3> last_{};
    std::array<std::array<Counter, max_digits>, 3> n_digits_{};
};

}  // namespace EBZ_INSTRUCTIONS
}  // namespace ebz::positions
