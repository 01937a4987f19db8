// Coordinates that come again: of points with the same coordinates before, of neighbours with the same ones.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "light_values.hpp"
#include "recall.hpp"

namespace ebz::positions {
inline namespace EBZ_INSTRUCTIONS {

// Coordinates count by their lower 32 bits; of those with the same ones what is nearest to the base is meant.
class LightPlaces {
public:
    explicit LightPlaces(size_t n_vertices)
        : along_(log2_entries(n_vertices)), around_(log2_entries(n_vertices)) {}

    // What will be asked for first, of a vertex with such neighbours.
    void prefetch(size_t d, std::array<uint32_t, 2> neighbours, bool is_first) const {
        around_.prefetch(key(d + 4, neighbours));
        if (is_first) along_.prefetch(key(d, {neighbours[0], 0}));
    }

    // Adds what is recalled for axis d, in this turn.  known: the coordinates before, from a neighbour in the first turn.
    void add_to(LightValues& values, size_t d, size_t turn, std::array<uint32_t, 2> known, std::array<uint32_t, 2> neighbours, uint32_t base) {
        along_key_ = key(d, known);
        around_key_ = key(d + 4, neighbours);
        const auto add = [&](LightValues::Kind kind, uint32_t hits, uint32_t value) {
            values.add(kind, turn, std::min<size_t>(hits - 1, 3), 0, int64_t{static_cast<int32_t>(value - base)});
        };
        found_ = along_.find(along_key_);
        if (found_ != nullptr) {
            const Mirror& mirror = mirrors_[d];
            add(LightValues::along, found_->hits(), found_->value);
            if (mirror.hits > 0) add(LightValues::mirrored, mirror.hits, mirror.sum - found_->value);
        }
        const Coordinates::Entry* around = around_.find(around_key_);
        if (around != nullptr) add(LightValues::around, around->hits(), around->value);
    }

    void learn(size_t d, uint32_t value) {
        if (found_ != nullptr && found_->value != value) mirrors_[d].learn(found_->value + value);
        along_.learn(along_key_, value);
        around_.learn(around_key_, value);
    }

private:
    using Coordinates = Recall<uint32_t>;

    // The sum of a coordinate and its mirror image, by the latest pair.
    struct Mirror {
        uint32_t sum = 0;
        uint32_t hits = 0;  // times in a row that the sum came again

        void learn(uint32_t latest) {
            hits = latest == sum ? std::min(hits + 1, Coordinates::max_hits) : 1;
            sum = latest;
        }
    };

    static int log2_entries(size_t n_vertices) { return std::clamp(static_cast<int>(std::bit_width(n_vertices)) + 1, 8, 15); }

    static uint32_t key(size_t kind, std::array<uint32_t, 2> coordinates) {
        uint32_t h = static_cast<uint32_t>(kind) * 0x9E3779B1u;
        for (const uint32_t x : coordinates) {
            h = (h ^ x) * 0x85EBCA6Bu;
            h ^= h >> 15;
        }
        return h * 0xC2B2AE35u;
    }

    Coordinates along_, around_;  // the axes before, the neighbours
    uint32_t along_key_ = 0, around_key_ = 0;
    const Coordinates::Entry* found_ = nullptr;  // by `along`
    std::array<Mirror, 3> mirrors_;         // by axis
};

}  // namespace EBZ_INSTRUCTIONS
}  // namespace ebz::positions
