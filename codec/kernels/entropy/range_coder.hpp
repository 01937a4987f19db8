// Range coder: integers with frequencies, and single bits with 16-bit probabilities.
//
// Reference: G. N. N. Martin, "Range encoding: an algorithm for removing redundancy from a digitised
// message", 1979.  Carries are propagated into bytes already written instead of being held back.
// The interval has 48 bits, so that products with 16-bit probabilities fit 64 and rounding costs less
// than 2^-23 bits a symbol: what a model promises is what its stream takes.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace ebz {

inline constexpr int probability_bits = 16;
inline constexpr int interval_bits = 48;
inline constexpr uint64_t interval_mask = (uint64_t{1} << interval_bits) - 1;
// Between symbols: least_range <= range < 2^48.
inline constexpr uint64_t least_range = uint64_t{1} << (interval_bits - 8);

class RangeEncoder {
public:
    static constexpr bool encoding = true;

    // Codes a symbol that owns [start, start + frequency) of [0, 2^total_bits); total_bits <= 16.
    void symbol(uint32_t start, uint32_t frequency, int total_bits) {
        const uint64_t unit = range_ >> total_bits;
        add(unit * start);
        range_ = unit * frequency;
        normalise();
    }

    // Codes `bit`, whose probability of being 1 is p1 / 2^16 with 0 < p1 < 2^16.
    bool bit(bool bit, uint32_t p1) {
        const uint64_t bound = (range_ * p1) >> probability_bits;
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
    // symbols), because of least_range: that bounds what a declared count may be.
    std::vector<uint8_t> finish() {
        // Any value in [low, low + range) decodes alike: take one with few bytes, since the decoder
        // reads zeros past the end.
        int n_bytes = 1;
        for (; n_bytes < interval_bits / 8; ++n_bytes) {
            const uint64_t mask = interval_mask >> (8 * n_bytes);
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
        if (low_ > interval_mask) {
            carry();
            low_ &= interval_mask;
        }
    }

    // All bytes written and low stay below 1: there is always a byte that can take the carry.
    void carry() {
        size_t i = bytes_.size();
        while (++bytes_[--i] == 0) {}
    }

    void shift() {
        bytes_.push_back(static_cast<uint8_t>(low_ >> (interval_bits - 8)));
        low_ = (low_ << 8) & interval_mask;
    }

    void normalise() {
        while (range_ < least_range) {
            shift();
            range_ <<= 8;
        }
    }

    uint64_t low_ = 0;
    uint64_t range_ = interval_mask;
    std::vector<uint8_t> bytes_;
};

class RangeDecoder {
public:
    static constexpr bool encoding = false;

    explicit RangeDecoder(std::span<const uint8_t> bytes) : bytes_(bytes) {
        for (int i = 0; i < interval_bits / 8; ++i) code_ = (code_ << 8) | next();
    }

    // How many of the ascending `starts` of [0, 2^16) the next symbol is not below; consume() must
    // follow.  Products instead of peek's quotient.
    template <size_t n>
    int count_below(const std::array<uint16_t, n>& starts) {
        unit_ = range_ >> probability_bits;
        int count = 0;
        for (const uint16_t start : starts) count += code_ >= unit_ * start;
        return count;
    }

    // The position in [0, 2^total_bits) of the next symbol; consume() must follow.
    uint32_t peek(int total_bits) {
        unit_ = range_ >> total_bits;
        const uint64_t position = code_ / unit_;
        const uint64_t last = (uint64_t{1} << total_bits) - 1;  // corrupt data, or slack of the division
        return static_cast<uint32_t>(position < last ? position : last);
    }

    void consume(uint32_t start, uint32_t frequency) {
        code_ -= unit_ * start;
        range_ = unit_ * frequency;
        normalise();
    }

    bool bit(bool, uint32_t p1) {
        const uint64_t bound = (range_ * p1) >> probability_bits;
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
    uint64_t next() { return at_ < bytes_.size() ? bytes_[at_++] : 0; }

    // A damaged stream may leave code_ above range_; both stay below 2^48 all the same.
    void normalise() {
        while (range_ < least_range) {
            code_ = ((code_ << 8) | next()) & interval_mask;
            range_ <<= 8;
        }
    }

    std::span<const uint8_t> bytes_;
    size_t at_ = 0;
    uint64_t code_ = 0;
    uint64_t range_ = interval_mask;
    uint64_t unit_ = 1;
};

}  // namespace ebz
