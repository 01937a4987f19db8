// Range coder: integers with frequencies, and single bits with 16-bit probabilities.
//
// Reference: G. N. N. Martin, "Range encoding: an algorithm for removing redundancy from a digitised
// message", 1979.  Carries are propagated into bytes already written instead of being held back.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace ebz {

inline constexpr int probability_bits = 16;
inline constexpr uint32_t probability_one = 1u << probability_bits;

class RangeEncoder {
public:
    static constexpr bool encoding = true;

    // Codes a symbol that owns [start, start + frequency) of [0, 2^total_bits); total_bits <= 16.
    void symbol(uint32_t start, uint32_t frequency, int total_bits) {
        const uint32_t unit = range_ >> total_bits;
        add(static_cast<uint64_t>(unit) * start);
        range_ = unit * frequency;
        normalise();
    }

    // Codes `bit`, whose probability of being 1 is p1 / 2^16 with 0 < p1 < 2^16.
    bool bit(bool bit, uint32_t p1) {
        const uint32_t bound = static_cast<uint32_t>((static_cast<uint64_t>(range_) * p1) >> probability_bits);
        if (bit) {
            range_ = bound;
        } else {
            add(bound);
            range_ -= bound;
        }
        normalise();
        return bit;
    }

    // Codes the low n_bits <= 16 of `value` with equal probabilities.
    uint32_t raw(uint32_t value, int n_bits) {
        symbol(value, 1, n_bits);
        return value;
    }

    // The bytes.  A stream of b bytes holds at most 8 b + 8 bits of information (the cost of all its
    // symbols), because range_ >= 2^24: that bounds what a declared count may be.
    std::vector<uint8_t> finish() {
        // Any value in [low, low + range) decodes alike: take one with few bytes, since the decoder
        // reads zeros past the end.
        int n_bytes = 1;
        for (; n_bytes < 4; ++n_bytes) {
            const uint64_t mask = (uint64_t{1} << (32 - 8 * n_bytes)) - 1;
            const uint64_t value = (low_ + mask) & ~mask;
            if (value - low_ < range_) {
                add(value - low_);
                break;
            }
        }
        for (int i = 0; i < n_bytes; ++i) shift();
        return std::move(bytes_);
    }

private:
    void add(uint64_t amount) {
        low_ += amount;
        if (low_ >> 32) {
            carry();
            low_ &= 0xffffffffu;
        }
    }

    // low < 1 over all bytes written: there is always a byte that can take the carry.
    void carry() {
        size_t i = bytes_.size();
        while (++bytes_[--i] == 0) {}
    }

    void shift() {
        bytes_.push_back(static_cast<uint8_t>(low_ >> 24));
        low_ = (low_ << 8) & 0xffffffffu;
    }

    // Invariant: 2^24 <= range_ < 2^32 between symbols, so unit >= 2^8 and frequency 1 is never lost.
    void normalise() {
        while (range_ < (1u << 24)) {
            shift();
            range_ <<= 8;
        }
    }

    uint64_t low_ = 0;  // < 2^32 between calls
    uint32_t range_ = 0xffffffffu;
    std::vector<uint8_t> bytes_;
};

class RangeDecoder {
public:
    static constexpr bool encoding = false;

    explicit RangeDecoder(std::span<const uint8_t> bytes) : bytes_(bytes) {
        for (int i = 0; i < 4; ++i) code_ = (code_ << 8) | next();
    }

    // The position in [0, 2^total_bits) of the next symbol; consume() must follow.
    uint32_t peek(int total_bits) {
        unit_ = range_ >> total_bits;
        const uint32_t position = code_ / unit_;
        const uint32_t last = (1u << total_bits) - 1;  // corrupt data, or the slack above unit * 2^total_bits
        return position < last ? position : last;
    }

    void consume(uint32_t start, uint32_t frequency) {
        code_ -= unit_ * start;
        range_ = unit_ * frequency;
        normalise();
    }

    bool bit(bool, uint32_t p1) {
        const uint32_t bound = static_cast<uint32_t>((static_cast<uint64_t>(range_) * p1) >> probability_bits);
        const bool bit = code_ < bound;
        if (bit) {
            range_ = bound;
        } else {
            code_ -= bound;
            range_ -= bound;
        }
        normalise();
        return bit;
    }

    uint32_t raw(uint32_t, int n_bits) {
        const uint32_t value = peek(n_bits);
        consume(value, 1);
        return value;
    }

private:
    uint32_t next() { return at_ < bytes_.size() ? bytes_[at_++] : 0; }

    void normalise() {
        while (range_ < (1u << 24)) {
            code_ = (code_ << 8) | next();
            range_ <<= 8;
        }
    }

    std::span<const uint8_t> bytes_;
    size_t at_ = 0;
    uint32_t code_ = 0;
    uint32_t range_ = 0xffffffffu;
    uint32_t unit_ = 1;
};

}  // namespace ebz
