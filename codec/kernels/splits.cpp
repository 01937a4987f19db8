#include "splits.hpp"

#include <algorithm>
#include <array>
#include <memory>
#include <numeric>
#include <utility>

#include "fan_spokes.hpp"
#include "integers.hpp"
#include "split_truth.hpp"

namespace ebz {

namespace {

// One path for both sides.
template <class Coder>
class SplitCoder {
public:
    SplitCoder(const FannedPoints& points, SplitTruth truth, Coder& coder)
        : points_(points),
          truth_(std::move(truth)),
          coder_(coder),
          spokes_(points.opposite, points.fan),
          first_corner_(points.fan.begin()),
          vertex_(points.point.begin(), points.point.end()),
          n_vertices_(static_cast<size_t>(points.n_points)) {}

    Splits run() {
        if (coder_.raw(known([&] { return truth_.is_apart(); }), 1) != 0) {
            take_apart();
        } else {
            fans();
            resolve();
        }
        return {std::move(vertex_), std::move(more_)};
    }

private:
    static constexpr uint8_t max_told = 3;

    // What is known of an edge at its other end.
    enum OtherEnd : uint8_t { unknown, unknown_beside_cut, whole, cut };

    // A vertex at a point, by the order in which they are told; its number is none where it is to be found.
    struct Run {
        Index rank, vertex;
    };

    template <class Ask>
    static auto known(Ask ask) {
        if constexpr (Coder::encoding) return ask();
        else return decltype(ask()){};
    }

    // Without branches: which corners are the first at a point is hard to foresee.
    void take_apart() {
        std::vector<uint8_t> is_taken(n_vertices_.size());
        more_.resize(vertex_.size() + 1);
        Index n = 0;
        for (size_t c = 0; c < vertex_.size(); ++c) {
            const Index p = points_.point[c], is_more = is_taken[p];
            is_taken[p] = true;
            more_[n] = p;
            vertex_[c] = is_more ? points_.n_points + n : p;
            n += is_more;
        }
        more_.resize(n);
    }

    void fans() {
        const auto n_fans = static_cast<Index>(points_.point_of_fan.size());
        entry_ = std::make_unique_for_overwrite<Index[]>(points_.point_of_fan.size());
        n_told_.assign(points_.point_of_fan.size(), 0);
        is_cut_.assign(vertex_.size(), false);
        const bool any_shared = n_fans > points_.n_points;
        gap_ = code_gap();
        for (Index f = 0; f < n_fans; ++f) {
            // Most points have one fan, which is whole.
            while (!any_shared && f < n_fans && gap_ > 0 && n_told_[f] == 0) ++f, --gap_;
            if (f == n_fans) return;
            if (code_is_cut(f)) cut_fan(f);
            else if (n_vertices_[points_.point_of_fan[f]] > 0) whole_fan(f);
            else first_fan(f);
        }
    }

    // Of fans that no cut has reached, few are cut: how many are whole is told.
    bool code_is_cut(Index f) {
        if (n_told_[f] > 0) {
            const bool truth = known([&] { return truth_.is_cut(f); });
            return latest_cut_ = fan_bit_[n_told_[f] - 1][latest_cut_].code(coder_, truth);
        }
        if (gap_-- > 0) return false;
        gap_ = code_gap();
        return true;
    }

    uint64_t code_gap() {
        return gap_length_.code(coder_, known([&] { return truth_.gap(n_gaps_++); }));
    }

    // A whole one, at a point that has no vertex yet.
    void first_fan(Index f) {
        n_vertices_[points_.point_of_fan[f]] = 1;
        if constexpr (Coder::encoding) truth_.rank_of_fan(f) = 0;
    }

    // Of the fans asked for, ascending.
    Index first_corner(Index f) {
        first_corner_ = std::find(first_corner_, points_.fan.end(), f);
        return static_cast<Index>(first_corner_ - points_.fan.begin());
    }

    void whole_fan(Index f) {
        const Index c = first_corner(f);
        const Run run = code_run(c, none, true);
        if (run.rank == 0) return;
        spokes_.turn_from(c);
        give(run, 0, spokes_.corners().size());
    }

    void cut_fan(Index f) {
        spokes_.turn_from(n_told_[f] == 0 ? first_corner(f) : entry_[f]);
        code_cuts(f);
        const size_t n = spokes_.corners().size();
        Run run{none, none};
        for (size_t i = 0; i < cuts_.size(); ++i) {
            const size_t end = i + 1 < cuts_.size() ? cuts_[i + 1] : spokes_.is_closed() ? n + cuts_[0] : n;
            run = code_run(spokes_.corners()[cuts_[i]], run.rank, false);
            if (run.rank > 0) give(run, cuts_[i], end);
        }
    }

    // The corners that runs begin with.
    void code_cuts(Index f) {
        const auto& corners = spokes_.corners();
        const size_t first = spokes_.is_closed() ? 0 : 1, n_least = spokes_.is_closed() ? 2 : 1;
        find_other_ends(f, first);
        cuts_.assign(first, 0);
        for (size_t i = first; i < corners.size(); ++i) {
            n_cuts_ahead_ -= ends_[i] == cut;
            const bool is_last_chance = cuts_.size() - first + corners.size() - i == n_least;
            if (!is_last_chance && !code_cut(i, first)) continue;
            cuts_.push_back(i);
            tell(f, corners[i]);
        }
        const size_t n_cuts = cuts_.size() - first;
        is_latest_apart_ = n_cuts > 1 && n_cuts == corners.size() - first;
    }

    bool code_cut(size_t i, size_t first) {
        const auto& corners = spokes_.corners();
        const size_t n = cuts_.size() - first;
        const size_t so_far = is_latest_apart_ && n == i - first ? 3 : std::min<size_t>(n, 2);
        const size_t turned = n == 0 || so_far == 3 || !spokes_.is_closed() ? 0 : turned_from_first_cut(i);
        const OtherEnd end = ends_[i] == unknown && n_cuts_ahead_ > 0 ? unknown_beside_cut : ends_[i];
        const bool truth = known([&] { return truth_.differ(corners[i], spokes_.beyond(corners[i])); });
        return cut_bit_[end][so_far][turned].code(coder_, truth);
    }

    // Less than half a turn (1), about half (2), or more (3): seams are mostly straight.
    size_t turned_from_first_cut(size_t i) const {
        const size_t twice = 2 * (i - cuts_[0]), n = spokes_.corners().size();
        return twice + 1 < n ? 1 : twice > n + 1 ? 3 : 2;
    }

    void find_other_ends(Index f, size_t first) {
        const auto& corners = spokes_.corners();
        ends_.resize(corners.size());
        n_cuts_ahead_ = 0;
        for (size_t i = first; i < corners.size(); ++i) {
            const bool is_known = spokes_.other_fan(corners[i]) < f;
            ends_[i] = !is_known ? unknown : is_cut_[points_.opposite[corners[i]]] ? cut : whole;
            n_cuts_ahead_ += ends_[i] == cut;
        }
    }

    void tell(Index f, Index spoke) {
        is_cut_[spoke] = true;
        const Index other = spokes_.other_fan(spoke);
        if (other <= f) return;
        if (n_told_[other] == 0) entry_[other] = points_.opposite[spoke];
        n_told_[other] = std::min<uint8_t>(n_told_[other] + 1, max_told);
    }

    // rank_before: of the run before it in the fan, whose vertex is another one.
    Run code_run(Index corner, Index rank_before, bool is_whole) {
        const Index p = points_.point[corner], n = n_vertices_[p], n_others = n - (rank_before != none);
        const Index truth = known([&] { return truth_.rank(corner); });
        const bool is_known = n_others > 0 && code_is_known(n_others, is_whole, truth != none);
        if (is_known) return {n_others == 1 ? Index{rank_before == 0} : code_rank(n, rank_before, truth), none};
        if constexpr (Coder::encoding) truth_.rank(corner) = n;
        return add(p);
    }

    bool code_is_known(Index n_others, bool is_whole, bool truth) {
        const auto some = static_cast<size_t>(std::min<Index>(n_others, 3) - 1);
        const bool is_known = again_[latest_whole_][is_whole][some].code(coder_, truth);
        if (is_whole) latest_whole_ = is_known;
        return is_known;
    }

    // Counted back from the latest, without that before.
    Index code_rank(Index n, Index before, Index truth) {
        const bool is_below = known([&] { return before != none && truth < before; });
        const uint64_t steps = back_.code(coder_, static_cast<uint64_t>(n - 1 - truth - is_below));
        const auto most = static_cast<uint64_t>(n - 1 - (before != none));
        const Index rank = n - 1 - static_cast<Index>(std::min(steps, most));
        return rank - (before != none && rank <= before);
    }

    Run add(Index p) {
        const Index rank = n_vertices_[p]++;
        if (rank == 0) return {0, p};
        more_.push_back(p);
        return {rank, points_.n_points + static_cast<Index>(more_.size()) - 1};
    }

    // To the corners of the fan from begin to end, which may be beyond the last.
    void give(const Run& run, size_t begin, size_t end) {
        const auto& corners = spokes_.corners();
        for (size_t i = begin; i < end; ++i) {
            const Index c = corners[i < corners.size() ? i : i - corners.size()];
            vertex_[c] = run.vertex;
            if (run.vertex == none) unresolved_.emplace_back(c, run.rank);
        }
    }

    // Finds vertices by rank, in linear time also where a point has many.
    void resolve() {
        if (unresolved_.empty()) return;
        std::vector<Index> start(static_cast<size_t>(points_.n_points) + 1), sorted(more_.size());
        for (const Index p : more_) ++start[p + 1];
        std::partial_sum(start.begin(), start.end(), start.begin());
        std::vector<Index> at(start.begin(), start.end());
        for (size_t i = 0; i < more_.size(); ++i) sorted[at[more_[i]]++] = points_.n_points + static_cast<Index>(i);
        for (const auto& [c, rank] : unresolved_) vertex_[c] = sorted[start[points_.point[c]] + rank - 1];
    }

    const FannedPoints& points_;
    SplitTruth truth_;
    Coder& coder_;
    FanSpokes spokes_;
    std::span<const Index>::iterator first_corner_;  // of the latest fan asked for
    std::vector<Index> vertex_;       // of each corner
    std::vector<Index> n_vertices_;   // so far, of each point
    std::vector<Index> more_;         // the point of each vertex that is not the first there
    std::unique_ptr<Index[]> entry_;  // the first spoke of each fan that was told to be cut at its other end
    std::vector<uint8_t> n_told_;     // such spokes of each fan, up to max_told
    std::vector<bool> is_cut_;        // spokes
    std::vector<std::pair<Index, Index>> unresolved_;  // a corner, and the rank of its vertex
    // Of the fan under way.
    std::vector<OtherEnd> ends_;  // of each spoke
    std::vector<size_t> cuts_;
    size_t n_cuts_ahead_ = 0;

    uint64_t gap_ = 0;
    size_t n_gaps_ = 0;
    bool latest_cut_ = false, latest_whole_ = false, is_latest_apart_ = false;
    IntegerModel gap_length_, back_;
    std::array<std::array<AdaptiveBit, 2>, max_told> fan_bit_;
    std::array<std::array<std::array<AdaptiveBit, 4>, 4>, 4> cut_bit_;
    std::array<std::array<std::array<AdaptiveBit, 3>, 2>, 2> again_;
};

}  // namespace

FansAtPoints fans_at_points(std::span<const Index> opposite, std::span<const Index> point) {
    FansAtPoints fans{std::vector<Index>(point.size(), none), {}};
    FanSpokes spokes(opposite, point);
    for (Index c = 0; c < static_cast<Index>(point.size()); ++c) {
        if (fans.fan[c] != none) continue;
        spokes.turn_from(c);
        for (const Index other : spokes.corners()) fans.fan[other] = static_cast<Index>(fans.point_of_fan.size());
        fans.point_of_fan.push_back(point[c]);
    }
    return fans;
}

EncodedSplits encode_splits(const FannedPoints& points, std::span<const Index> label) {
    RangeEncoder coder;
    SplitTruth truth(points.opposite, points.fan, static_cast<Index>(points.point_of_fan.size()), label);
    Splits splits = SplitCoder<RangeEncoder>(points, std::move(truth), coder).run();
    std::vector<Index> label_of(static_cast<size_t>(points.n_points) + splits.point.size());
    for (size_t c = 0; c < label.size(); ++c) label_of[splits.vertex[c]] = label[c];
    return {coder.finish(), std::move(splits), std::move(label_of)};
}

Splits decode_splits(std::span<const uint8_t> bytes, const FannedPoints& points) {
    RangeDecoder coder(bytes);
    return SplitCoder<RangeDecoder>(points, {}, coder).run();
}

}  // namespace ebz
