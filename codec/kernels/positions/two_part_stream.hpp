// Symbols by ANS of three states, one per axis, and plain bits: two parts of one stream.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "../entropy/ans.hpp"
#include "../entropy/bits.hpp"

namespace ebz::positions {
inline namespace EBZ_INSTRUCTIONS {

// A stream: the size of the symbols' part in 4 bytes, that part, the plain bits.
struct TwoPartEncoder {
    static constexpr bool encoding = true;

    ans::Encoder<3> symbols;
    BitWriter plain;

    // n: how many symbols are expected.
    explicit TwoPartEncoder(size_t n) { symbols.reserve(n); }

    std::vector<uint8_t> finish() {
        const std::vector<uint8_t> first = symbols.finish(), second = plain.finish();
        std::vector<uint8_t> bytes(4 + first.size() + second.size());
        for (size_t i = 0; i < 4; ++i) bytes[i] = static_cast<uint8_t>(first.size() >> (8 * i));
        std::copy(second.begin(), second.end(), std::copy(first.begin(), first.end(), bytes.begin() + 4));
        return bytes;
    }
};

struct TwoPartDecoder {
    static constexpr bool encoding = false;

    ans::Decoder<3> symbols;
    BitReader plain;

    explicit TwoPartDecoder(std::span<const uint8_t> bytes) : TwoPartDecoder(bytes, size_of_symbols(bytes)) {}

private:
    TwoPartDecoder(std::span<const uint8_t> bytes, size_t n)
        : symbols(bytes.subspan(std::min<size_t>(bytes.size(), 4), n)), plain(bytes.subspan(std::min(bytes.size(), 4 + n))) {}

    static size_t size_of_symbols(std::span<const uint8_t> bytes) {
        if (bytes.size() < 4) return 0;
        size_t n = 0;
        for (size_t i = 0; i < 4; ++i) n |= size_t{bytes[i]} << (8 * i);
        return std::min(n, bytes.size() - 4);
    }
};

}  // namespace EBZ_INSTRUCTIONS
}  // namespace ebz::positions
