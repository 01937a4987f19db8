// Where an item would stand if items were sorted by a key, shifted as the items of nearby rank were.
#pragma once

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

#include "../surface/corner_table.hpp"

namespace ebz::order {

class LocalRank {
public:
    explicit LocalRank(std::span<const int64_t> keys)
        : rank_(keys.size()), shift_((keys.size() >> block_bits) + 1, unknown) {
        std::vector<Index> sorted(keys.size());
        std::iota(sorted.begin(), sorted.end(), 0);
        std::stable_sort(sorted.begin(), sorted.end(), [&](Index a, Index b) { return keys[a] < keys[b]; });
        for (Index i = 0; i < static_cast<Index>(sorted.size()); ++i) rank_[sorted[i]] = i;
    }

    int64_t guess(Index item) const {
        const int64_t block = rank_[item] >> block_bits, n = static_cast<int64_t>(shift_.size());
        for (int64_t away = 0; away <= reach; ++away) {
            if (block >= away && shift_[block - away] != unknown) return rank_[item] + shift_[block - away];
            if (block + away < n && shift_[block + away] != unknown) return rank_[item] + shift_[block + away];
        }
        return rank_[item];
    }

    void learn(Index item, Index index) { shift_[rank_[item] >> block_bits] = int64_t{index} - rank_[item]; }

private:
    static constexpr int block_bits = 5, reach = 3;
    static constexpr int64_t unknown = INT64_MIN;

    std::vector<Index> rank_;
    std::vector<int64_t> shift_;  // of the item met last in each block of ranks
};

}  // namespace ebz::order
