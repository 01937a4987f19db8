// The spokes of a fan: the edges between two of its corners, each named by the half-edge that starts there.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "corner_table.hpp"

namespace ebz {

class FanSpokes {
public:
    FanSpokes(std::span<const Index> opposite, std::span<const Index> fan) : opposite_(opposite), fan_(fan) {}

    Index fan(Index corner) const { return fan_[corner]; }

    // The corner on the other side of half-edge h, which has an opposite.
    Index beyond(Index h) const { return next(opposite_[h]); }

    // Whether half-edge h is a spoke of the fan that it starts at.
    bool is_spoke(Index h) const { return opposite_[h] != none && fan_[beyond(h)] == fan_[h]; }

    // The fan that spoke h ends at, none if it is no spoke there.
    Index other_fan(Index h) const {
        const Index fan = fan_[opposite_[h]];
        return fan_[next(h)] == fan ? fan : none;
    }

    // Takes the corners of a fan in turn, each behind its spoke: of a closed fan from corner c on, of an open one
    // from the end that has no spoke.
    void turn_from(Index c) {
        const Index fan = fan_[c];
        corners_.clear();
        Index at = c;
        do {
            corners_.push_back(at);
            at = opposite_[previous(at)];
        } while (at != none && at != c && fan_[at] == fan);
        is_closed_ = at == c;
        if (is_closed_ || !is_spoke(c)) return;
        const auto n = static_cast<std::ptrdiff_t>(corners_.size());
        for (at = c; is_spoke(at); corners_.push_back(at)) at = beyond(at);
        std::reverse(corners_.begin() + n, corners_.end());
        std::rotate(corners_.begin(), corners_.begin() + n, corners_.end());
    }

    bool is_closed() const { return is_closed_; }
    const std::vector<Index>& corners() const { return corners_; }

private:
    std::span<const Index> opposite_, fan_;
    std::vector<Index> corners_;
    bool is_closed_ = false;
};

}  // namespace ebz
