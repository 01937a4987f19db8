// Adaptive Exp-Golomb codes: the number of bits is modelled, and so are the bits next to the first.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <vector>

#include "adaptive_bit.hpp"
#include "../errors.hpp"

namespace ebz {

class IntegerModel {
public:
    // Codes any 64-bit value; small ones are cheap.  Decoders pass anything and use what comes back.
    template <class Coder>
    uint64_t code(Coder& coder, uint64_t value) {
        const int n_bits = code_width(coder, std::bit_width(value));
        if (n_bits < 2) return static_cast<uint64_t>(n_bits);
        return code_mantissa(coder, value, n_bits);
    }

private:
    static constexpr int max_bits = 64;

    template <class Coder>
    int code_width(Coder& coder, int width) {
        int n_bits = 0;
        while (n_bits < max_bits && more_[n_bits].code(coder, n_bits < width)) ++n_bits;
        return n_bits;
    }

    // The two bits after the leading one are modelled, those below are close to noise.
    template <class Coder>
    uint64_t code_mantissa(Coder& coder, uint64_t value, int n_bits) {
        uint64_t decoded = 1;
        int left = n_bits - 1;
        for (int seen = 1; left > 0 && seen <= 3; seen = static_cast<int>(decoded)) {
            --left;
            decoded = 2 * decoded + mantissa_[n_bits - 1][seen - 1].code(coder, (value >> left) & 1);
        }
        while (left > 0) {
            const int n = left < probability_bits ? left : probability_bits;
            left -= n;
            const uint32_t low = static_cast<uint32_t>(value >> left) & ((1u << n) - 1);
            decoded = (decoded << n) | coder.raw(low, n);
        }
        return decoded;
    }

    std::array<AdaptiveBit, max_bits> more_;
    std::array<std::array<AdaptiveBit, 3>, max_bits> mantissa_;
};

// Small differences of either sign become small values.
constexpr uint64_t zigzag(int64_t x) { return (static_cast<uint64_t>(x) << 1) ^ static_cast<uint64_t>(x >> 63); }
constexpr int64_t unzigzag(uint64_t u) { return static_cast<int64_t>((u >> 1) ^ (~(u & 1) + 1)); }

// Columns of a table, row by row, with a model each; values has n_columns per row.
std::vector<uint8_t> encode_integers(std::span<const uint64_t> values, size_t n_columns);
std::vector<uint64_t> decode_integers(std::span<const uint8_t> bytes, size_t n_rows, size_t n_columns);

}  // namespace ebz
