// The spokes of a fan: the edges between two of its corners, each named by the half-edge that starts there.
#pragma once

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
    Index other_fan(Index h) const { return is_spoke(opposite_[h]) ? fan_[opposite_[h]] : none; }

    // Takes the corners of a fan in turn, each behind its spoke: of a closed fan from corner c on, of an open one
    // from the end that has no spoke.
    void turn_from(Index c) {
        Index first = c;
        do {
            if (!is_spoke(first)) break;
            first = beyond(first);
        } while (first != c);
        is_closed_ = is_spoke(first);
        corners_.clear();
        for (Index at = first; at != none;) {
            corners_.push_back(at);
            const Index across = opposite_[previous(at)];
            at = across == none || across == first || fan_[across] != fan_[at] ? none : across;
        }
    }

    bool is_closed() const { return is_closed_; }
    const std::vector<Index>& corners() const { return corners_; }

private:
    std::span<const Index> opposite_, fan_;
    std::vector<Index> corners_;
    bool is_closed_ = false;
};

}  // namespace ebz
