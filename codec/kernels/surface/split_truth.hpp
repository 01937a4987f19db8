// What an encoder of splits (splits.hpp) knows beforehand.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "fan_spokes.hpp"

namespace ebz {

class SplitTruth {
public:
    // A decoder's.
    SplitTruth() = default;

    SplitTruth(std::span<const Index> opposite, std::span<const Index> fan, Index n_fans, std::span<const Index> label)
        : label_(label), rank_(label.empty() ? 0 : static_cast<size_t>(*std::max_element(label.begin(), label.end())) + 1, none) {
        is_apart_ = are_different();
        if (is_apart_) return;
        find_cuts(fan, n_fans);
        find_gaps(FanSpokes(opposite, fan));
    }

    // Whether each corner has a vertex of its own.
    bool is_apart() const { return is_apart_; }

    bool differ(Index a, Index b) const { return label_[a] != label_[b]; }
    bool is_cut(Index fan) const { return is_cut_[fan]; }
    uint64_t gap(size_t i) const { return gaps_[i]; }

    // The rank at its point of the vertex of a corner, none if it has not been told.
    Index& rank(Index corner) { return rank_[label_[corner]]; }
    Index& rank_of_fan(Index f) { return rank_[label_of_fan_[f]]; }

private:
    bool are_different() const {
        if (rank_.size() < label_.size()) return false;
        std::vector<uint8_t> seen(rank_.size());
        for (const Index label : label_) {
            if (seen[label]) return false;
            seen[label] = true;
        }
        return true;
    }

    void find_cuts(std::span<const Index> fan, Index n_fans) {
        is_cut_.resize(static_cast<size_t>(n_fans));
        label_of_fan_.assign(is_cut_.size(), none);
        for (size_t c = 0; c < fan.size(); ++c) {
            Index& known = label_of_fan_[fan[c]];
            if (known == none) known = label_[c];
            is_cut_[fan[c]] |= known != label_[c];
        }
    }

    void find_gaps(const FanSpokes& spokes) {
        std::vector<uint8_t> is_reached(is_cut_.size());
        for (Index h = 0; h < static_cast<Index>(label_.size()); ++h) {
            if (!is_cut_[spokes.fan(h)] || !spokes.is_spoke(h) || !differ(h, spokes.beyond(h))) continue;
            if (const Index other = spokes.other_fan(h); other > spokes.fan(h)) is_reached[other] = true;
        }
        uint64_t gap = 0;
        for (size_t f = 0; f < is_cut_.size(); ++f) {
            if (is_reached[f]) continue;
            if (is_cut_[f]) gaps_.push_back(gap);
            gap = is_cut_[f] ? 0 : gap + 1;
        }
        gaps_.push_back(gap);
    }

    std::span<const Index> label_;
    bool is_apart_ = false;
    std::vector<Index> rank_;          // of each label
    std::vector<Index> label_of_fan_;  // one of those of each
    std::vector<uint8_t> is_cut_;      // fans
    std::vector<uint64_t> gaps_;       // whole fans before each cut one, of those that no cut reaches from an earlier fan
};

// What an encoder asks for; a decoder does not.
template <class Coder, class Ask>
auto known(Ask ask) {
    if constexpr (Coder::encoding) return ask();
    else return decltype(ask()){};
}

}  // namespace ebz
