// One residual as binary decisions with one counter each: side, class, leading digit; then raw digits.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

namespace ebz::positions {

class FastModel {
public:
    FastModel() {
        for (auto& axis : counters_)
            for (auto& confidence : axis)
                for (auto& level : confidence) level.fill(1u << 15);
    }

    // confidence < 6; level: half-octaves of the expected size.
    template <class Coder>
    int64_t code(Coder& coder, size_t axis, size_t confidence, int level, int64_t e) {
        shift_ = std::max(0, (level - 18) / 2);
        counter_ = counters_[axis][confidence][static_cast<size_t>(level - 2 * shift_)].data();
        const bool negative = decide(coder, 0, e < 0);
        const int64_t a = negative ? -1 - e : e;
        const int k = code_class(coder, std::max(0, level / 2 - 2), a, negative);
        const int64_t decoded = k < 2 ? k : code_digits(coder, k, a);
        return negative ? -1 - decoded : decoded;
    }

private:
    static constexpr int max_class = 44;
    static constexpr size_t n_levels = 20, n_slots = 32;

    // 16-bit probability of a 1, kept off both ends.
    template <class Coder>
    bool decide(Coder& coder, size_t slot, bool bit) {
        uint16_t& p = counter_[slot];
        bit = coder.bit(bit, p);
        const int32_t target = bit ? 65535 - 15 : 15;
        p = static_cast<uint16_t>(p + ((target - p) >> 4));
        return bit;
    }

    template <class Coder>
    int code_class(Coder& coder, int k, int64_t a, bool negative) {
        const auto above = [&](int j) {
            const auto slot = static_cast<size_t>(std::clamp(j - shift_, 0, 9));
            return decide(coder, 1 + slot * 2 + (negative ? 1 : 0), a >= int64_t{1} << j);
        };
        if (above(k)) {
            while (++k < max_class && above(k)) {}
            return k;
        }
        while (k > 0 && !above(k - 1)) --k;
        return k;
    }

    template <class Coder>
    int64_t code_digits(Coder& coder, int k, int64_t a) {
        int left = k - 2;
        const auto slot = static_cast<size_t>(std::clamp(k - shift_, 0, 10));
        uint64_t value = 2 + (decide(coder, 21 + slot, (a >> left & 1) != 0) ? 1 : 0);
        while (left > 0) {
            const int n_raw = std::min(left, 16);
            left -= n_raw;
            const auto bits = static_cast<uint32_t>(static_cast<uint64_t>(a) >> left) & ((1u << n_raw) - 1);
            value = value << n_raw | coder.raw(bits, n_raw);
        }
        return static_cast<int64_t>(value);
    }

    std::array<std::array<std::array<std::array<uint16_t, n_slots>, n_levels>, 6>, 3> counters_;
    uint16_t* counter_ = nullptr;
    int shift_ = 0;
};

}  // namespace ebz::positions
