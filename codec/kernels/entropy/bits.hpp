// Plain bits, the lowest first.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include "../instruction_set.hpp"

namespace ebz {
inline namespace EBZ_INSTRUCTIONS {

inline constexpr int max_plain_bits = 57;  // at once: the rest of a byte and they fit 64

class BitWriter {
public:
    static constexpr bool encoding = true;

    // The low n_bits <= max_plain_bits of `value`, which has no others.
    uint64_t bits(uint64_t value, int n_bits) {
        held_ |= value << n_held_;
        n_held_ += n_bits;
        for (; n_held_ >= 8; n_held_ -= 8, held_ >>= 8) bytes_.push_back(static_cast<uint8_t>(held_));
        return value;
    }

    // Calls work with a function like bits, for max_plain_bits in all.
    template <class Work>
    void together(Work work) {
        work([&](uint64_t value, int n_bits) { return bits(value, n_bits); });
    }

    std::vector<uint8_t> finish() {
        if (n_held_ > 0) bytes_.push_back(static_cast<uint8_t>(held_));
        return std::move(bytes_);
    }

private:
    uint64_t held_ = 0;
    int n_held_ = 0;
    std::vector<uint8_t> bytes_;
};

// Past the end all bits are zero.
class BitReader {
public:
    static constexpr bool encoding = false;

    explicit BitReader(std::span<const uint8_t> bytes) : bytes_(bytes.size() + 8), last_(bytes.size()) {
        if (!bytes.empty()) std::memcpy(bytes_.data(), bytes.data(), bytes.size());
    }

    uint64_t bits(uint64_t, int n_bits) {
        const uint64_t value = ahead() & ((uint64_t{1} << n_bits) - 1);
        at_ += static_cast<size_t>(n_bits);
        return value;
    }

    template <class Work>
    void together(Work work) {
        uint64_t word = ahead();
        size_t at = at_;
        work([&](uint64_t, int n_bits) {
            const uint64_t value = word & ((uint64_t{1} << n_bits) - 1);
            word >>= n_bits;
            at += static_cast<size_t>(n_bits);
            return value;
        });
        at_ = at;
    }

private:
    uint64_t ahead() const {
        const size_t byte = at_ >> 3;
        uint64_t word;
        std::memcpy(&word, bytes_.data() + (byte < last_ ? byte : last_), 8);
        if constexpr (std::endian::native == std::endian::big) word = __builtin_bswap64(word);
        return word >> (at_ & 7);
    }

    std::vector<uint8_t> bytes_;  // with zeros at the end
    size_t last_, at_ = 0;
};

}  // namespace EBZ_INSTRUCTIONS
}  // namespace ebz
