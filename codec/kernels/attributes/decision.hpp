// One binary decision: the mix of counted contexts, distributions and candidates.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "../positions/counter.hpp"
#include "../positions/lanes.hpp"
#include "../positions/mixer.hpp"
#include "curve.hpp"
#include "initial_weights.hpp"

namespace ebz::attributes {

using positions::Counter;
using positions::CounterState;
using positions::WideIntLanes;
using positions::WideLanes;

// One wide vector each.
inline constexpr size_t n_contexts = 8, n_candidates = 8;
inline constexpr size_t n_value_contexts = 32;
using Hashes = std::array<uint32_t, n_contexts>;

inline uint32_t hash(uint64_t a, uint64_t b) {
    uint64_t x = (a + 0x9E3779B97F4A7C15ull) * 0xBF58476D1CE4E5B9ull ^ (b + 0xD6E8FEB86659FD93ull) * 0x94D049BB133111EBull;
    x ^= x >> 31;
    x *= 0x9E3779B97F4A7C15ull;
    return static_cast<uint32_t>(x >> 32);
}

class Decision {
public:
    static constexpr size_t n_slots = 31, n_nodes = 32, n_levels = 12;

    // initial: the weights of a node at first.
    template <class Initial>
    Decision(size_t n_values, Initial initial)
        : log2_lines_(std::clamp(static_cast<int>(std::bit_width(n_values)), 9, 14)),
          mixer_(n_nodes, n_nodes * n_levels * 3),
          curve_(n_nodes * 3) {
        for (size_t node = 0; node < n_nodes; ++node) {
            std::array<float, 8 * n_lanes> start{};
            const InitialWeights& weights = initial(node);
            std::copy(weights.begin(), weights.end(), start.begin());
            mixer_.start(node, start);
        }
        for (auto& lines : lines_) lines.resize(size_t{1} << log2_lines_);
    }

    // Which contexts the next decisions are counted in.
    void enter(const Hashes& hashes) {
        for (size_t i = 0; i < n_contexts; ++i) {
            line_[i] = &lines_[i][hashes[i] >> (32 - log2_lines_)];
            if (line_[i]->tag != hashes[i]) line_[i]->reset(hashes[i]);
        }
    }

    // Candidates that may be exactly right, with what is known of each.
    void consider(unsigned candidates, const std::array<uint8_t, n_candidates>& contexts) {
        contexts_ = contexts;
        offered_ = candidates;
        alive_ = 0;
        for_each(candidates, [&](size_t i) {
            if (hits_[i][contexts_[i]].p16() >= min_hits) alive_ |= 1u << i;
        });
    }

    unsigned alive() const { return alive_; }
    void keep(unsigned candidates) { alive_ &= candidates; }

    // What came of those that were considered.
    void settle(unsigned right) {
        for_each(offered_, [&](size_t i) { hits_[i][contexts_[i]].update((right >> i & 1) != 0, 16384); });
    }

    // Logits of the bit by each distribution; zeros where there are none.
    WideLanes distributions{};

    // upper: the candidates for which the bit would be 1.  slot: n_slots for no counters.
    template <class Coder>
    bool code(Coder& coder, size_t node, size_t slot, size_t turn, size_t level, unsigned upper, bool bit) {
        const uint32_t p = predict(node, slot, turn, level, upper);
        bit = coder.bit(bit, p);
        learn(node, slot, upper, bit);
        return bit;
    }

private:
    static constexpr size_t n_lanes = 4;  // counters, distributions, candidates, a constant
    static constexpr uint32_t min_hits = 1024;  // of 65536: others do not pay for their time

    struct alignas(64) Line {  // two cache lines
        std::array<CounterState, n_slots> counters;
        uint32_t tag = 0;

        Line() { counters.fill(positions::counter::unseen); }
        void reset(uint32_t new_tag) {
            counters.fill(positions::counter::unseen);
            tag = new_tag;
        }
    };

    template <class Work>
    static void for_each(unsigned set, Work work) {
        for (; set != 0; set &= set - 1) work(static_cast<size_t>(std::countr_zero(set)));
    }

    uint32_t predict(size_t node, size_t slot, size_t turn, size_t level, unsigned upper) {
        inputs_[0] = WideLanes{};
        if (slot < n_slots) {
            const auto at = [&](size_t i) { return static_cast<int32_t>(line_[i]->counters[slot]); };
            states_ = WideIntLanes{at(0), at(1), at(2), at(3), at(4), at(5), at(6), at(7)};
            inputs_[0] = positions::counter::opinion<WideLanes>(states_);
        }
        inputs_[1] = distributions;
        inputs_[2] = WideLanes{};
        for_each(alive_, [&](size_t i) {
            const Counter& c = agreement_[i][contexts_[i]][node];
            const float agrees = c.n() == 0 ? 0.0f : positions::logits[c.p16() >> 4];
            inputs_[2][i] = (upper >> i & 1) != 0 ? agrees : -agrees;
        });
        inputs_[3] = WideLanes{0.4f};
        const size_t set = node * 3 + std::min<size_t>(turn, 2);
        const float logit = mixer_.mix(inputs_, node, set * n_levels + level);
        p_ = positions::squash(logit);
        const float refined = curve_.refine(logit, set);
        const float q = p_ + 0.5f * (refined - p_);
        p16_ = static_cast<uint32_t>(std::clamp(static_cast<int32_t>(q * 65536.0f), 1, 65535));
        return p16_;
    }

    void learn(size_t node, size_t slot, unsigned upper, bool bit) {
        const float target = bit ? 1.0f : 0.0f;
        n_decisions_ += 1.0f;
        const float rate = 0.0005f * (1.0f + 5.0f / (1.0f + n_decisions_ * (1.0f / 4000.0f)));
        mixer_.update(inputs_, (target - p_) * rate);
        curve_.update(target, 0.02f);
        if (slot < n_slots) {
            const auto all = [](float x) { return positions::splat<WideLanes>(x); };
            const WideLanes expected = all(static_cast<float>(p16_ << 6));
            const WideLanes seen = all(bit ? positions::counter::certain : 0.0f);
            const WideIntLanes next = positions::counter::updated(states_, seen, expected);
            for (size_t i = 0; i < n_contexts; ++i) line_[i]->counters[slot] = static_cast<CounterState>(next[i]);
        }
        for_each(alive_, [&](size_t i) {
            agreement_[i][contexts_[i]][node].update(bit == ((upper >> i & 1) != 0), 49152);
        });
    }

    int log2_lines_;
    std::array<std::vector<Line>, n_contexts> lines_;
    std::array<Line*, n_contexts> line_{};
    positions::Mixer<n_lanes> mixer_;
    Curve curve_;
    std::array<std::array<std::array<Counter, n_nodes>, n_value_contexts>, n_candidates> agreement_{};
    std::array<std::array<Counter, n_value_contexts>, n_candidates> hits_{};
    std::array<uint8_t, n_candidates> contexts_{};
    unsigned offered_ = 0, alive_ = 0;
    float n_decisions_ = 0;

    positions::Mixer<n_lanes>::Inputs inputs_{};
    WideIntLanes states_{};
    float p_ = 0;
    uint32_t p16_ = 0;
};

}  // namespace ebz::attributes
