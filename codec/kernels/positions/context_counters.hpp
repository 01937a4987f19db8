// Counters of every decision in hashed contexts, several at once.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

#include "counter.hpp"
#include "expectation.hpp"
#include "lanes.hpp"

namespace ebz::positions {
inline namespace EBZ_INSTRUCTIONS {

class ContextCounters {
public:
    static constexpr size_t n_slots = 24;

    explicit ContextCounters(size_t n_vertices)
        : log2_lines_(std::clamp(static_cast<int>(std::bit_width(n_vertices)) - 1, 9, 12)), lines_(n << log2_lines_) {}

    // Ahead of start(), so that the lines are there by then.
    void find(const Expectation& x) {
        for (size_t i = 0; i < n; ++i) {
            line_[i] = &lines_[(i << log2_lines_) + (x.context[i] >> (32 - log2_lines_))];
            __builtin_prefetch(line_[i], 1);
            __builtin_prefetch(&line_[i]->counters[n_slots - 1], 1);
        }
    }

    void start(const Expectation& x) {
        for (size_t i = 0; i < n; ++i) {
            if (line_[i]->tag != x.context[i]) line_[i]->start(x.context[i]);
        }
    }

    // Logits by the counters of a slot.
    WideLanes opinions(size_t slot) {
        const auto at = [&](size_t i) { return static_cast<int32_t>(line_[i]->counters[slot]); };
        states_ = WideIntLanes{at(0), at(1), at(2), at(3), 0, 0, 0, 0};
        return counter::opinion<WideLanes>(states_);
    }

    // For the slot whose opinions were asked last.
    void learn(size_t slot, bool bit, float expected) {
        const WideLanes target = splat<WideLanes>(bit ? counter::certain : 0.0f);
        const WideIntLanes next = counter::updated(states_, target, splat<WideLanes>(expected));
        for (size_t i = 0; i < n; ++i) line_[i]->counters[slot] = static_cast<CounterState>(next[i]);
    }

private:
    static constexpr size_t n = Expectation::n_contexts;
    static_assert(n == 4, "the lanes of states_");

    // Two cache lines, the slots asked most in the first.
    struct alignas(64) Line {
        uint32_t tag;
        std::array<CounterState, n_slots> counters;

        // In vectors: assigning it becomes an instruction for long blocks, which is slow to begin.
        void start(uint32_t context) {
            const WideIntLanes unseen{};
            for (size_t at = 0; at < sizeof(Line); at += sizeof unseen)
                std::memcpy(reinterpret_cast<std::byte*>(this) + at, &unseen, sizeof unseen);
            tag = context;
        }
    };
    static_assert(sizeof(Line) == 128);

    int log2_lines_;
    std::vector<Line> lines_;
    std::array<Line*, n> line_{};
    WideIntLanes states_{};
};

}  // namespace EBZ_INSTRUCTIONS
}  // namespace ebz::positions
