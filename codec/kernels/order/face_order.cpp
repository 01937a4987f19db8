// The indices of the faces, predicted from the faces across their edges: by the step that was taken last
// time in the same situation, and by vertices and positions where faces are sorted by them.
#include <algorithm>
#include <array>
#include <numeric>

#include "index_coder.hpp"
#include "local_rank.hpp"
#include "permutations.hpp"

namespace ebz::order {

namespace {

// The step between the indices of two faces that was taken last in each situation, by hash.
class LastSteps {
public:
    int64_t& at(uint64_t situation) { return steps_[situation >> (64 - n_bits)]; }

    static uint64_t mix(uint64_t a, uint64_t b) {
        return (a * 0x9E3779B97F4A7C15 + b * 0xC2B2AE3D27D4EB4F) * 0xD6E8FEB86659FD93;
    }

private:
    static constexpr int n_bits = 16;
    std::vector<int64_t> steps_ = std::vector<int64_t>(size_t{1} << n_bits);
};

// The faces across the edges of a face that come before it in the output.
struct Earlier {
    static constexpr int max = 3;

    std::array<Index, max> face;
    std::array<uint8_t, max> side;  // the edge of that face
    int n = 0;
};

// One path for both sides: an encoder codes the indices that are there, a decoder fills them in.
template <class Faces, class Coder>
class FaceOrderCoder {
public:
    FaceOrderCoder(const FaceGeometry<Faces>& known, std::span<const Index> vertex_source, std::span<Index> source,
                   Coder& coder)
        : faces_(known.faces),
          opposite_(known.opposite),
          source_(source),
          n_coded_(count_coded()),
          indices_(coder, static_cast<Index>(source.size())),
          step_(source.size()),
          side_(source.size()) {
        if (!vertex_source.empty()) rank_by_vertices(vertex_source);
        for (int axis = 0; axis < 3; ++axis) rank_by_position(known.positions, axis);
    }

    void run() {
        for (Index f = 0; f < n_coded_; ++f) code(f);
        add_empty();
    }

    void run_uniform() {
        for (Index& index : source_.first(n_coded_)) index = indices_.code_uniform(index);
        add_empty();
    }

private:
    enum Kind { long_context, context, short_context, pair_context, beside, start = beside + 6, sorted };
    static constexpr int n_situations = 4;
    static constexpr Index max_side = 255;

    Index count_coded() const {
        Index n = faces_.n_faces();
        while (n > 0 && faces_.size(n - 1) == 0) --n;
        return n;
    }

    void add_empty() {
        Index latest = none;
        for (Index& index : source_.subspan(n_coded_)) latest = index = indices_.unused().above(latest);
    }

    void code(Index f) {
        const Earlier earlier = look_around(f);
        const std::array<uint64_t, n_situations> situations = situations_of(earlier);
        source_[f] = indices_.code(expect(f, earlier, situations), source_[f]);
        if (earlier.n > 0) {
            step_[f] = int64_t{source_[f]} - source_[earlier.face[0]];
            side_[f] = earlier.side[0];
            for (int i = 0; i < n_situations; ++i) steps_[i].at(situations[i]) = step_[f];
        }
        for (LocalRank& rank : ranks_) rank.learn(f, source_[f]);
    }

    Earlier look_around(Index f) const {
        Earlier earlier;
        for (Index c = faces_.first(f); c < faces_.first(f + 1) && earlier.n < Earlier::max; ++c) {
            const Index across = opposite_[c];
            if (across == none || faces_.face(across) >= f) continue;
            const Index side = across - faces_.first(faces_.face(across));
            earlier.face[earlier.n] = faces_.face(across);
            earlier.side[earlier.n++] = static_cast<uint8_t>(std::min(side, max_side));
        }
        return earlier;
    }

    // Steps and turns that led here, from many to few.
    std::array<uint64_t, n_situations> situations_of(const Earlier& earlier) const {
        if (earlier.n == 0) return {};
        const Index from = earlier.face[0], gate = opposite_[faces_.first(from)];
        const uint64_t turn = LastSteps::mix(earlier.side[0], 0);
        const uint64_t step = LastSteps::mix(static_cast<uint64_t>(step_[from]), turn);
        const bool is_led = gate != none && faces_.face(gate) < from;
        const uint64_t before = is_led ? LastSteps::mix(static_cast<uint64_t>(step_[faces_.face(gate)]), side_[from]) : 0;
        uint64_t pair = 0;
        if (earlier.n > 1) {
            const int64_t apart = int64_t{source_[from]} - source_[earlier.face[1]];
            pair = LastSteps::mix(static_cast<uint64_t>(apart), 3 * earlier.side[0] + earlier.side[1]);
        }
        return {LastSteps::mix(step, before), step, turn, pair};
    }

    Expectation expect(Index f, const Earlier& earlier, const std::array<uint64_t, n_situations>& situations) {
        Expectation expected;
        const Unused& unused = indices_.unused();
        const Index previous = f > 0 ? source_[f - 1] : none;
        const Index from = earlier.n > 0 ? source_[earlier.face[0]] : none;
        if (earlier.n > 0) {
            for (int i = 0; i < n_situations; ++i) {
                if (i == pair_context && earlier.n < 2) continue;
                expected.guess(from + steps_[i].at(situations[i]), i);
            }
        } else {
            expected.guess(unused.above(previous), start);
        }
        for (int i = 0; i < earlier.n; ++i) {
            const Index index = source_[earlier.face[i]];
            expected.guess(unused.above(index), beside + 2 * i);
            expected.guess(unused.below(index), beside + 2 * i + 1);
            if (i < 2) expected.beside[i] = index;
        }
        if (by_vertices_) expected.guess(ranks_[0].guess(f), sorted);
        expected.reference = earlier.n > 0 ? from : previous;
        expected.anchor(from);
        expected.anchor(expected.beside[1]);
        for (const LocalRank& rank : ranks_) expected.anchor(rank.guess(f));
        return expected;
    }

    // By the two greatest vertices, by the two least, by their sum.
    void rank_by_vertices(std::span<const Index> vertex_source) {
        by_vertices_ = true;
        std::array<std::vector<int64_t>, 3> keys;
        std::vector<int64_t> v;
        for (Index f = 0; f < n_coded_; ++f) {
            v.clear();
            for (Index c = faces_.first(f); c < faces_.first(f + 1); ++c) v.push_back(vertex_source[faces_[c]]);
            std::sort(v.begin(), v.end());
            const size_t last = v.size() - 1, other = std::min<size_t>(last, 1);
            keys[0].push_back(v[last] << 31 | v[last - other]);
            keys[1].push_back(v[0] << 31 | v[other]);
            keys[2].push_back(std::accumulate(v.begin(), v.end(), int64_t{0}));
        }
        for (const std::vector<int64_t>& by : keys) ranks_.emplace_back(by);
    }

    void rank_by_position(std::span<const int64_t> positions, int axis) {
        std::vector<int64_t> keys(n_coded_);
        for (Index f = 0; f < n_coded_; ++f) {
            uint64_t sum = 0;  // wraps
            for (Index c = faces_.first(f); c < faces_.first(f + 1); ++c) {
                sum += static_cast<uint64_t>(positions[3 * size_t(faces_[c]) + axis]);
            }
            keys[f] = static_cast<int64_t>(sum);
        }
        ranks_.emplace_back(keys);
    }

    const Faces& faces_;
    std::span<const Index> opposite_;
    std::span<Index> source_;
    Index n_coded_;
    IndexCoder<Coder> indices_;
    std::vector<LocalRank> ranks_;
    bool by_vertices_ = false;
    std::vector<int64_t> step_;  // from the index of the face across the gate
    std::vector<uint8_t> side_;  // the edge of that face
    std::array<LastSteps, n_situations> steps_;
};

template <class Faces, class Coder>
void run(const FaceGeometry<Faces>& known, std::span<const Index> vertex_source, bool uniform,
         std::span<Index> source, Coder& coder) {
    FaceOrderCoder<Faces, Coder> order(known, vertex_source, source, coder);
    uniform ? order.run_uniform() : order.run();
}

}  // namespace

template <class Faces>
Bytes encode_face_order(const FaceGeometry<Faces>& known, std::span<const Index> vertex_source, bool uniform,
                        std::span<const Index> source) {
    std::vector<Index> copy(source.begin(), source.end());
    RangeEncoder coder;
    run(known, vertex_source, uniform, copy, coder);
    return coder.finish();
}

template <class Faces>
std::vector<Index> decode_face_order(std::span<const uint8_t> bytes, const FaceGeometry<Faces>& known,
                                     std::span<const Index> vertex_source, bool uniform) {
    std::vector<Index> source(known.faces.n_faces());
    RangeDecoder coder(bytes);
    run(known, vertex_source, uniform, source, coder);
    return source;
}

template Bytes encode_face_order(const FaceGeometry<TriangleFaces>&, std::span<const Index>, bool,
                                 std::span<const Index>);
template Bytes encode_face_order(const FaceGeometry<PolygonFaces>&, std::span<const Index>, bool,
                                 std::span<const Index>);
template std::vector<Index> decode_face_order(std::span<const uint8_t>, const FaceGeometry<TriangleFaces>&,
                                              std::span<const Index>, bool);
template std::vector<Index> decode_face_order(std::span<const uint8_t>, const FaceGeometry<PolygonFaces>&,
                                              std::span<const Index>, bool);

}  // namespace ebz::order
