// Coordinates that come again: of points with the same coordinates before, of neighbours with the same ones.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "int_lanes.hpp"
#include "recall.hpp"

namespace ebz::positions {
inline namespace EBZ_INSTRUCTIONS {

// Coordinates count by their lower 32 bits; of those with the same ones what is nearest to the base is meant.
class LightPlaces {
public:
    explicit LightPlaces(size_t n_vertices)
        : along_(log2_entries(n_vertices)), around_(log2_entries(n_vertices)) {}

    // Of a vertex; a, b: two neighbours.  first: the axis that is asked for first.
    void start(UintLanes a, UintLanes b, size_t first) {
        const UintLanes kinds = {0, 1, 2, 0};
        const auto keys = [&](UintLanes kind, UintLanes x, UintLanes y) { return std::bit_cast<Keys>(key(kind, x, y)); };
        around_keys_ = keys(kinds + 4, a, b);
        first_keys_ = keys(kinds, a, UintLanes{});
        for (size_t d = 0; d < 3; ++d) around_.prefetch(around_keys_[d]);
        along_.prefetch(first_keys_[first]);
    }

    // Adds what is recalled for axis d, in this turn.  known: the coordinates of the turns before.
    template <class Values>
    void add_to(Values& values, size_t d, size_t turn, std::array<uint32_t, 2> known, uint32_t base) {
        d_ = d;
        along_key_ = turn == 0 ? first_keys_[d] : key(static_cast<uint32_t>(d), known[0], turn == 1 ? 0 : known[1]);
        found_along_ = &along_.at(along_key_);
        found_around_ = &around_.at(around_keys_[d]);
        const auto add = [&](typename Values::Kind kind, uint32_t hits, uint32_t value) {
            values.add(kind, turn, std::min<size_t>(hits - 1, 3), static_cast<int32_t>(value - base));
        };
        knows_along_ = found_along_->is_of(along_key_);
        if (knows_along_) {
            const Mirror& mirror = mirrors_[d];
            add(Values::along, found_along_->hits(), found_along_->value);
            if (mirror.hits > 0) add(Values::mirrored, mirror.hits, mirror.sum - found_along_->value);
        }
        knows_around_ = found_around_->is_of(around_keys_[d]);
        if (knows_around_) add(Values::around, found_around_->hits(), found_around_->value);
    }

    // After values have been added.
    void learn(uint32_t value) {
        if (knows_along_ && found_along_->value != value) mirrors_[d_].learn(found_along_->value + value);
        found_along_->learn(along_key_, knows_along_, value);
        found_around_->learn(around_keys_[d_], knows_around_, value);
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

    // For integers, or for lanes of them.
    template <class T>
    static T key(T kind, T x, T y) {
        T h = kind * 0x9E3779B1u;
        for (const T z : {x, y}) {
            h = (h ^ z) * 0x85EBCA6Bu;
            h ^= h >> 15;
        }
        return h * 0xC2B2AE35u;
    }

    Coordinates along_, around_;   // the axes before, the neighbours
    std::array<Mirror, 3> mirrors_;  // by axis

    // Of the vertex under way, per axis.
    using Keys = std::array<uint32_t, 4>;
    Keys first_keys_{}, around_keys_{};

    // Of the axis under way.
    size_t d_ = 0;
    uint32_t along_key_ = 0;
    Coordinates::Entry *found_along_ = nullptr, *found_around_ = nullptr;
    bool knows_along_ = false, knows_around_ = false;
};

}  // namespace EBZ_INSTRUCTIONS
}  // namespace ebz::positions
