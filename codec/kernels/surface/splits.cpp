#include "splits.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

#include "fan_cuts.hpp"

namespace ebz {

namespace {

// One path for both sides.
template <class Coder>
class SplitCoder {
public:
    SplitCoder(const FannedPoints& points, SplitTruth& truth, Coder& coder)
        : points_(points),
          truth_(truth),
          coder_(coder),
          vertex_(points.point.begin(), points.point.end()),
          n_vertices_(static_cast<size_t>(points.n_points)) {}

    Splits run() {
        if (coder_.raw(known<Coder>([&] { return truth_.is_apart(); }), 1) != 0) {
            take_apart();
        } else {
            fans();
            resolve();
        }
        return {std::move(vertex_), std::move(more_)};
    }

private:
    using Cuts = FanCuts<Coder>;

    // A vertex at a point, by the order in which they are told; its number is none where it is to be found.
    struct Run {
        Index rank, vertex;
    };

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
        Cuts cuts(points_, truth_, coder_);
        const auto n_fans = static_cast<Index>(points_.point_of_fan.size());
        const bool any_shared = n_fans > points_.n_points;
        for (Index f = 0; f < n_fans; ++f) {
            // Most points have one fan, which is whole.
            if (!any_shared) f = cuts.next_open(f);
            if (f == n_fans) return;
            if (cuts.is_cut(f)) cut_fan(cuts, f);
            else if (n_vertices_[points_.point_of_fan[f]] > 0) whole_fan(cuts, f);
            else first_fan(f);
        }
    }

    // A whole one, at a point that has no vertex yet.
    void first_fan(Index f) {
        n_vertices_[points_.point_of_fan[f]] = 1;
        if constexpr (Coder::encoding) truth_.rank_of_fan(f) = 0;
    }

    void whole_fan(Cuts& cuts, Index f) {
        const Run run = code_run(cuts.first_corner(f), none, true);
        if (run.rank == 0) return;
        cuts.turn(f);
        give(run, cuts.corners(), 0, cuts.corners().size());
    }

    void cut_fan(Cuts& cuts, Index f) {
        cuts.cut(f);
        const auto& corners = cuts.corners();
        const auto& starts = cuts.runs();
        Run run{none, none};
        for (size_t i = 0; i < starts.size(); ++i) {
            run = code_run(corners[starts[i]], run.rank, false);
            if (run.rank > 0) give(run, corners, starts[i], i + 1 < starts.size() ? starts[i + 1] : cuts.end_of_last());
        }
    }

    // rank_before: of the run before it in the fan, whose vertex is another one.
    Run code_run(Index corner, Index rank_before, bool is_whole) {
        const Index p = points_.point[corner], n = n_vertices_[p], n_others = n - (rank_before != none);
        const Index truth = known<Coder>([&] { return truth_.rank(corner); });
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
        const bool is_below = known<Coder>([&] { return before != none && truth < before; });
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

    // To the corners from begin to end, which may be beyond the last.
    void give(const Run& run, const std::vector<Index>& corners, size_t begin, size_t end) {
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
    SplitTruth& truth_;
    Coder& coder_;
    std::vector<Index> vertex_;      // of each corner
    std::vector<Index> n_vertices_;  // so far, of each point
    std::vector<Index> more_;        // the point of each vertex that is not the first there
    std::vector<std::pair<Index, Index>> unresolved_;  // a corner, and the rank of its vertex
    bool latest_whole_ = false;
    IntegerModel back_;
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
    Splits splits = SplitCoder<RangeEncoder>(points, truth, coder).run();
    std::vector<Index> label_of(static_cast<size_t>(points.n_points) + splits.point.size());
    for (size_t c = 0; c < label.size(); ++c) label_of[splits.vertex[c]] = label[c];
    return {coder.finish(), std::move(splits), std::move(label_of)};
}

Splits decode_splits(std::span<const uint8_t> bytes, const FannedPoints& points) {
    RangeDecoder coder(bytes);
    SplitTruth unknown;
    return SplitCoder<RangeDecoder>(points, unknown, coder).run();
}

}  // namespace ebz
