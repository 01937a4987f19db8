// Adaptive probability of a bit in one context, with the number of bits it has seen.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "lanes.hpp"
#include "float_logistic.hpp"

namespace ebz::positions {

// The probability of a 1 in the upper 22 bits, the count, at most 31, in the lower 10.
using CounterState = uint32_t;

namespace counter {

inline constexpr int32_t max_n = 31;
inline constexpr CounterState unseen = 1u << 31;

// Four counters at a time.
inline IntLanes n(IntLanes state) { return state & 1023; }
inline Lanes p(IntLanes state) {  // in units of 2^-22
    return __builtin_convertvector((state >> 10) & 0x3fffff, Lanes);
}

// Logit, shrunk while few bits have been seen: by n / (n + 1.5).
inline Lanes opinion(IntLanes state) {
    const Lanes seen = __builtin_convertvector(n(state), Lanes), one = p(state) + 0.5f;
    return (log2_approx(one) - log2_approx(4194304.5f - one)) * (seen / (seen + 1.5f));
}

// An unseen context starts from what the others expect (in units of 2^-22).
inline IntLanes updated(IntLanes state, bool bit, float expected) {
    const IntLanes seen = n(state);
    const Lanes old = seen == 0 ? splat(expected) : p(state);
    const Lanes target = splat(bit ? 4194303.0f : 0.0f);
    const Lanes now = old + (target - old) / (__builtin_convertvector(seen, Lanes) + 1.6f);
    const IntLanes next = seen < max_n ? seen + 1 : seen;
    return __builtin_convertvector(now, IntLanes) << 10 | next;
}

}  // namespace counter

// One alone.
class Counter {
public:
    uint32_t p16() const { return state_ >> 16; }
    uint32_t n() const { return state_ & 1023; }

    void update(bool bit, uint32_t expected16) {
        const uint32_t n_seen = n();
        const float old = static_cast<float>(n_seen == 0 ? expected16 << 6 : state_ >> 10);
        const float now = old + ((bit ? 4194303.0f : 0.0f) - old) * rates[n_seen];
        const uint32_t n_now = n_seen < counter::max_n ? n_seen + 1 : n_seen;
        state_ = static_cast<uint32_t>(static_cast<int32_t>(now)) << 10 | n_now;
    }

private:
    static constexpr auto rates = [] {
        std::array<float, counter::max_n + 1> table{};
        for (size_t i = 0; i < table.size(); ++i) table[i] = 1.0f / (static_cast<float>(i) + 1.6f);
        return table;
    }();

    CounterState state_ = counter::unseen;
};

}  // namespace ebz::positions
