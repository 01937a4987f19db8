// Which fans of a surface hold corners of several vertices, and between which corners they are cut.
//
// Seams go on from point to point: what is told at one end of an edge foretells the other.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "fan_spokes.hpp"
#include "../entropy/integers.hpp"
#include "split_truth.hpp"
#include "splits.hpp"

namespace ebz {

// Fans are asked for in order.  One path for both sides.
template <class Coder>
class FanCuts {
public:
    FanCuts(const FannedPoints& points, const SplitTruth& truth, Coder& coder)
        : opposite_(points.opposite),
          fan_(points.fan),
          truth_(truth),
          coder_(coder),
          spokes_(points.opposite, points.fan),
          first_corner_(fan_.begin()),
          entry_(std::make_unique_for_overwrite<Index[]>(points.point_of_fan.size())),
          n_told_(points.point_of_fan.size()),
          is_cut_(points.fan.size()),
          gap_(code_gap()) {}

    // The first fan from f on that may be cut; those before are whole.
    Index next_open(Index f) {
        const auto n_fans = static_cast<Index>(n_told_.size());
        for (; f < n_fans && gap_ > 0 && n_told_[f] == 0; ++f) --gap_;
        return f;
    }

    // Of fans that no cut has reached, few are cut: how many are whole is told.
    bool is_cut(Index f) {
        if (n_told_[f] > 0) {
            const bool truth = known<Coder>([&] { return truth_.is_cut(f); });
            return latest_cut_ = fan_bit_[n_told_[f] - 1][latest_cut_].code(coder_, truth);
        }
        if (gap_-- > 0) return false;
        gap_ = code_gap();
        return true;
    }

    Index first_corner(Index f) {
        first_corner_ = std::find(first_corner_, fan_.end(), f);
        return static_cast<Index>(first_corner_ - fan_.begin());
    }

    // Takes the corners of a whole fan.
    void turn(Index f) { spokes_.turn_from(first_corner(f)); }

    // Takes those of one that is cut, and tells where.
    void cut(Index f) {
        spokes_.turn_from(n_told_[f] == 0 ? first_corner(f) : entry_[f]);
        const size_t n = corners().size(), first = spokes_.is_closed() ? 0 : 1, n_least = spokes_.is_closed() ? 2 : 1;
        find_other_ends(f, first);
        runs_.assign(first, 0);
        for (size_t i = first; i < n; ++i) {
            n_cuts_ahead_ -= ends_[i] == cut_there;
            const bool is_last_chance = runs_.size() - first + n - i == n_least;
            if (!is_last_chance && !code_cut(i, first)) continue;
            runs_.push_back(i);
            tell(f, corners()[i]);
        }
        const size_t n_cuts = runs_.size() - first;
        is_latest_apart_ = n_cuts > 1 && n_cuts == n - first;
    }

    // In turn; runs begin with those of these indices, and go on to the next, that of a closed fan's last one
    // around to the first.
    const std::vector<Index>& corners() const { return spokes_.corners(); }
    const std::vector<size_t>& runs() const { return runs_; }
    size_t end_of_last() const { return corners().size() + (spokes_.is_closed() && !runs_.empty() ? runs_[0] : 0); }

private:
    static constexpr uint8_t max_told = 3;

    // What is known of an edge at its other end.
    enum OtherEnd : uint8_t { unknown, unknown_beside_cut, whole_there, cut_there };

    uint64_t code_gap() {
        return gap_length_.code(coder_, known<Coder>([&] { return truth_.gap(n_gaps_++); }));
    }

    bool code_cut(size_t i, size_t first) {
        const size_t n = runs_.size() - first;
        const size_t so_far = is_latest_apart_ && n == i - first ? 3 : std::min<size_t>(n, 2);
        const size_t turned = n == 0 || so_far == 3 || !spokes_.is_closed() ? 0 : turned_from_first_cut(i);
        const OtherEnd end = ends_[i] == unknown && n_cuts_ahead_ > 0 ? unknown_beside_cut : ends_[i];
        const Index c = corners()[i];
        const bool truth = known<Coder>([&] { return truth_.differ(c, spokes_.beyond(c)); });
        return cut_bit_[end][so_far][turned].code(coder_, truth);
    }

    // Less than half a turn (1), about half (2), or more (3): seams are mostly straight.
    size_t turned_from_first_cut(size_t i) const {
        const size_t twice = 2 * (i - runs_[0]), n = corners().size();
        return twice + 1 < n ? 1 : twice > n + 1 ? 3 : 2;
    }

    void find_other_ends(Index f, size_t first) {
        ends_.resize(corners().size());
        n_cuts_ahead_ = 0;
        for (size_t i = first; i < ends_.size(); ++i) {
            const Index h = corners()[i];
            ends_[i] = spokes_.other_fan(h) >= f ? unknown : is_cut_[opposite_[h]] ? cut_there : whole_there;
            n_cuts_ahead_ += ends_[i] == cut_there;
        }
    }

    void tell(Index f, Index spoke) {
        is_cut_[spoke] = true;
        const Index other = spokes_.other_fan(spoke);
        if (other <= f) return;
        if (n_told_[other] == 0) entry_[other] = opposite_[spoke];
        n_told_[other] = std::min<uint8_t>(n_told_[other] + 1, max_told);
    }

    std::span<const Index> opposite_, fan_;
    const SplitTruth& truth_;
    Coder& coder_;
    FanSpokes spokes_;
    std::span<const Index>::iterator first_corner_;  // of the latest fan asked for
    std::unique_ptr<Index[]> entry_;  // the first spoke of each fan that was told to be cut at its other end
    std::vector<uint8_t> n_told_;     // such spokes of each fan, up to max_told
    std::vector<bool> is_cut_;        // spokes
    // Of the fan under way.
    std::vector<OtherEnd> ends_;  // of each spoke
    std::vector<size_t> runs_;
    size_t n_cuts_ahead_ = 0;

    size_t n_gaps_ = 0;
    bool latest_cut_ = false, is_latest_apart_ = false;
    IntegerModel gap_length_;
    uint64_t gap_;  // whole fans to come
    std::array<std::array<AdaptiveBit, 2>, max_told> fan_bit_;
    std::array<std::array<std::array<AdaptiveBit, 4>, 4>, 4> cut_bit_;
};

}  // namespace ebz
