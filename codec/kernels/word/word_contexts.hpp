// The contexts in which the mixed models see a word; part of the format.
//
// They were found by leaving out one after another of many; the degrees of the vertices closed last, the
// excess of closed neighbours and long matches are what plain degrees and symbols do not tell.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "match_model.hpp"
#include "word_priors.hpp"
#include "word_view.hpp"

namespace ebz {

// One hash of a context's number and up to 96 bits.
constexpr uint32_t context_hash(uint32_t context, uint32_t a, uint32_t b = 0, uint32_t c = 0) {
    const uint64_t key = (uint64_t{b} << 32 | a) + 0xC2B2AE3D27D4EB4Fu * (c + 1) + context;
    return static_cast<uint32_t>((key * 0x9E3779B97F4A7C15u) >> 32);
}

// Bits side by side, four each but for the first.
template <class... Nibble>
constexpr uint32_t pack(uint32_t first, Nibble... nibbles) {
    ((first = first << 4 | nibbles), ...);
    return first;
}

struct StrongContexts {
    static constexpr const auto& prior = strong_prior;
    static constexpr int n = 14, of_lengths = 9;
    static constexpr int n_table_bits = 18;
    static constexpr bool thorough = true;

    static void hash(const WordView& v, const WordHistory& past, const MatchModel& near,
                     const MatchModel& far, std::array<uint32_t, n>& h) {
        int i = 0;
        const auto add = [&](uint32_t a, uint32_t b = 0, uint32_t c = 0) {
            h[i] = context_hash(i, a, b, c);
            ++i;
        };
        add(v.l0, past.latest(2));
        add(past.latest(3), pack(past.since_close(), v.l0));
        add(past.latest(4), pack(v.l0, v.l1));
        add(past.latest(10), v.l0);
        add(pack(v.l0, v.l1, v.l2, v.l3, v.r0), past.closed_degrees(1));
        add(pack(v.l0, v.l1, v.l2, v.r0, v.r1, v.r2), past.latest(3));
        add(pack(v.l0, v.r0, v.excess_l0), v.can_close);
        add(pack(v.l0, v.l1, v.excess_l0, v.excess_l1), v.excess_r0);
        add(v.l0, past.closed_degrees(3), past.since_close());
        add(pack(std::min(v.length, 9u), std::min(v.conflict, 9u)), v.l0);
        add(pack(far.predicted(), far.confidence(), v.l0));
        add(pack(near.predicted(), near.confidence(), v.l0));
        add(pack(v.l0, v.l1, v.excess_l0, v.r0), past.closed_degrees(2));
        add(past.latest(10), past.closed_degrees(6));
    }
};

struct FastContexts {
    static constexpr const auto& prior = fast_prior;
    static constexpr int n = 6, of_lengths = -1;
    static constexpr int n_table_bits = 14;
    static constexpr bool thorough = false;

    static void hash(const WordView& v, const WordHistory& past, const MatchModel&, const MatchModel& far,
                     std::array<uint32_t, n>& h) {
        int i = 0;
        const auto add = [&](uint32_t a, uint32_t b = 0, uint32_t c = 0) {
            h[i] = context_hash(i, a, b, c);
            ++i;
        };
        add(v.l0, past.latest(2));
        add(pack(v.l0, v.l1, v.r0, v.r1), v.can_close);
        add(past.latest(6), pack(v.l0, v.r0));
        add(past.latest(10), v.l0);
        add(pack(v.l0, v.l1, v.excess_l0, v.r0), past.closed_degrees(2));
        add(pack(far.predicted(), far.confidence(), v.l0));
    }
};

}  // namespace ebz
