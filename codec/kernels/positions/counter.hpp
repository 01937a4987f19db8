// Adaptive probability of a bit in one context, with the number of bits it has seen.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "float_logistic.hpp"
#include "lanes.hpp"

namespace ebz::positions {
inline namespace EBZ_INSTRUCTIONS {

// The probability of a 1 in the upper 22 bits, the count, at most 90, in the lower 10.
using CounterState = uint32_t;

namespace counter {

inline constexpr int32_t max_n = 90;
inline constexpr CounterState unseen = 1u << 31;

// Several counters at a time.
template <class Ints>
Ints n(Ints state) {
    return state & 1023;
}

template <class Floats>
Floats p(IntsOf<Floats> state) {  // in units of 2^-22
    return __builtin_convertvector((state >> 10) & 0x3fffff, Floats);
}

template <class Floats>
Floats logit_of(IntsOf<Floats> state) {
    const Floats one = p<Floats>(state) + 0.5f;
    return log2_ratio(one, 4194304.5f - one);
}

// The logit, shrunk while few bits have been seen: by n / (n + 1.5).
template <class Floats>
Floats opinion(IntsOf<Floats> state) {
    const Floats seen = __builtin_convertvector(n(state), Floats);
    return logit_of<Floats>(state) * (seen / (seen + 1.5f));
}

// After a bit in each lane, told by its target; an unseen context starts from what is expected (in units of 2^-22).
template <class Floats>
IntsOf<Floats> updated(IntsOf<Floats> state, Floats target, Floats expected) {
    const IntsOf<Floats> seen = n(state);
    const Floats old = seen == 0 ? expected : p<Floats>(state);
    const Floats now = old + (target - old) / (__builtin_convertvector(seen, Floats) + 1.6f);
    const IntsOf<Floats> next = seen < max_n ? seen + 1 : seen;
    return __builtin_convertvector(now, IntsOf<Floats>) << 10 | next;
}

// The target of a bit.
inline constexpr float certain = 4194303.0f;

}  // namespace counter

// One alone.
class Counter {
public:
    uint32_t p16() const { return state_ >> 16; }
    uint32_t n() const { return state_ & 1023; }

    void update(bool bit, uint32_t expected16) {
        const uint32_t n_seen = n();
        const float old = static_cast<float>(n_seen == 0 ? expected16 << 6 : state_ >> 10);
        const float now = old + ((bit ? counter::certain : 0.0f) - old) * rates[n_seen];
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

}  // namespace EBZ_INSTRUCTIONS
}  // namespace ebz::positions
