#include "splits.hpp"

#include <algorithm>
#include <array>
#include <numeric>

#include "errors.hpp"
#include "integers.hpp"

namespace ebz {

namespace {

// Corners at one point that are joined across edges without a split.
class Runs {
public:
    explicit Runs(size_t n_corners) : parent_(n_corners) { std::iota(parent_.begin(), parent_.end(), 0); }

    // The first corner of the run.
    Index first(Index c) {
        while (parent_[c] != c) c = parent_[c] = parent_[parent_[c]];
        return c;
    }

    void join(Index a, Index b) {
        a = first(a);
        b = first(b);
        parent_[std::max(a, b)] = std::min(a, b);
    }

private:
    std::vector<Index> parent_;
};

// One path for both sides; a decoder passes the vertices to be filled in.
template <class Coder>
class SplitCoder {
public:
    SplitCoder(std::span<const Index> opposite, std::span<const Index> point, Index n_points,
               std::span<Index> vertex, Coder& coder)
        : opposite_(opposite),
          point_(point),
          vertex_(vertex),
          coder_(coder),
          several_(n_points, unknown),
          n_splits_(n_points),
          n_vertices_(n_points),
          latest_(n_points, none),
          runs_(opposite.size()) {}

    // are_told: whether it is told first which points have several vertices; else all may.
    void run(bool are_told) {
        are_told = coder_.raw(are_told, 1) != 0;
        if (are_told) code_several(Coder::encoding ? find_several() : std::vector<uint8_t>(several_.size()));
        else std::fill(several_.begin(), several_.end(), 1);
        for (Index first = 0; first < n_corners(); first += 3) {
            // Most triangles have no corner at a point of several vertices.
            if (!(has_several(first) | has_several(first + 1) | has_several(first + 2))) continue;
            for (Index h = first; h < first + 3; ++h) {
                if (opposite_[h] > h) edge(h, opposite_[h]);
            }
        }
        for (Index c = 0; c < n_corners(); ++c) vertex_[c] = several_[point_[c]] ? of_run(c) : of_point(point_[c]);
    }

    // The point of each vertex.
    std::vector<Index> points() { return std::move(points_); }

private:
    static constexpr uint8_t max_splits = 3, unknown = 2;
    static constexpr Index max_contexts = 3;

    Index n_corners() const { return static_cast<Index>(opposite_.size()); }

    std::vector<uint8_t> find_several() const {
        std::vector<uint8_t> several(several_.size());
        std::vector<Index> one(several_.size(), none);
        for (Index c = 0; c < n_corners(); ++c) {
            Index& vertex = one[point_[c]];
            several[point_[c]] |= vertex != none && vertex != vertex_[c];
            vertex = vertex_[c];
        }
        return several;
    }

    // Along seams, neighbours have several vertices too.
    void code_several(const std::vector<uint8_t>& truth) {
        bool latest = false;
        for (Index c = 0, n_known = 0; c < n_corners(); ++c) {
            const Index p = point_[c];
            // Points are numbered by first corner.
            if (p < n_known || several_[p] != unknown) continue;
            n_known = p + 1;
            const Index beyond = opposite_[next(c)];
            const bool apex = beyond != none && has_several(previous(beyond));
            const int context = has_several(next(c)) + 2 * has_several(previous(c)) + 4 * latest + 8 * apex;
            several_[p] = latest = several_bit_[context].code(coder_, truth[p] != 0);
        }
    }

    bool has_several(Index c) const { return several_[point_[c]] == 1; }

    void edge(Index h, Index g) {
        const bool split = several_[point_[h]] && end(h, next(g), 0);
        if (several_[point_[g]]) end(g, next(h), 1 + split);
    }

    // Corners a and b are at one end of an edge, on its two sides.
    bool end(Index a, Index b, int other_end) {
        uint8_t& n_splits = n_splits_[point_[a]];
        const bool split = split_[other_end][n_splits].code(coder_, vertex_[a] != vertex_[b]);
        if (split) {
            n_splits = std::min<uint8_t>(n_splits + 1, max_splits);
        } else {
            runs_.join(a, b);
        }
        return split;
    }

    Index of_point(Index p) { return latest_[p] == none ? create(p) : latest_[p]; }

    Index of_run(Index c) {
        const Index first = runs_.first(c);
        return first == c ? vertex_of_run(c) : vertex_[first];
    }

    Index create(Index p) {
        before_.push_back(latest_[p]);
        points_.push_back(p);
        ++n_vertices_[p];
        return latest_[p] = n_created() - 1;
    }

    // A new vertex of the point, or one that it already has, counted back from the latest.
    Index vertex_of_run(Index corner) {
        const Index p = point_[corner], n_known = n_vertices_[p];
        const bool is_known = vertex_[corner] < n_created();
        if (n_known > 0 && again_[std::min(n_known, max_contexts) - 1].code(coder_, is_known)) {
            return earlier(p, vertex_[corner]);
        }
        return create(p);
    }

    Index earlier(Index p, Index vertex) {
        uint64_t back = 0;
        if constexpr (Coder::encoding) {
            for (Index v = latest_[p]; v != vertex; v = before_[v]) ++back;
        }
        back = std::min<uint64_t>(back_.code(coder_, back), static_cast<uint64_t>(n_vertices_[p]) - 1);
        spend(back);
        Index v = latest_[p];
        while (back-- > 0) v = before_[v];
        return v;
    }

    // Vertices in many runs at a point of many vertices would cost quadratic time.
    void spend(uint64_t n_steps) {
        n_steps_ += n_steps;
        if (n_steps_ > 64 * opposite_.size()) throw Corrupt("the splits take too many steps");
    }

    Index n_created() const { return static_cast<Index>(before_.size()); }

    std::span<const Index> opposite_, point_;
    std::span<Index> vertex_;
    Coder& coder_;
    std::vector<uint8_t> several_;    // whether a point has several vertices
    std::vector<uint8_t> n_splits_;   // seen at each point, up to max_splits
    std::vector<Index> n_vertices_;   // of each point
    std::vector<Index> latest_;       // vertex of each point
    std::vector<Index> points_;       // of each vertex
    std::vector<Index> before_;       // the point's vertex before each vertex
    uint64_t n_steps_ = 0;
    Runs runs_;
    std::array<AdaptiveBit, 16> several_bit_;
    std::array<std::array<AdaptiveBit, max_splits + 1>, 3> split_;
    std::array<AdaptiveBit, max_contexts> again_;
    IntegerModel back_;
};

}  // namespace

std::vector<uint8_t> encode_splits(std::span<const Index> opposite, std::span<const Index> point,
                                   Index n_points, std::span<const Index> vertex) {
    const auto encoded = [&](bool are_told) {
        std::vector<Index> copy(vertex.begin(), vertex.end());
        RangeEncoder coder;
        SplitCoder<RangeEncoder>(opposite, point, n_points, copy, coder).run(are_told);
        return coder.finish();
    };
    std::vector<uint8_t> told = encoded(true), untold = encoded(false);
    return untold.size() < told.size() ? untold : told;
}

DecodedSplits decode_splits(std::span<const uint8_t> bytes, std::span<const Index> opposite,
                            std::span<const Index> point, Index n_points) {
    std::vector<Index> vertex(opposite.size());
    RangeDecoder coder(bytes);
    SplitCoder<RangeDecoder> splits(opposite, point, n_points, vertex, coder);
    splits.run(false);
    return {std::move(vertex), splits.points()};
}

}  // namespace ebz
