// The indices of the faces, predicted from the faces across their edges: by the step that was taken last
// time in the same situation, and by vertices and positions where faces are sorted by them.
#include <algorithm>
#include <array>

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
    std::array<Index, 3> face;
    std::array<uint8_t, 3> side;  // the edge of that face
    int n = 0;
};

// One path for both sides: an encoder codes the indices that are there, a decoder fills them in.
template <class Coder>
class FaceOrderCoder {
public:
    FaceOrderCoder(const Geometry& known, std::span<const Index> vertex_source, std::span<Index> source,
                   Coder& coder)
        : surface_(known.surface),
          source_(source),
          indices_(coder, static_cast<Index>(source.size())),
          step_(source.size()),
          side_(source.size()) {
        if (!vertex_source.empty()) rank_by_vertices(vertex_source);
        for (int axis = 0; axis < 3; ++axis) rank_by_position(known.positions, axis);
    }

    void run() {
        for (Index f = 0; f < static_cast<Index>(source_.size()); ++f) code(f);
    }

    void run_uniform() {
        for (Index& index : source_) index = indices_.code_uniform(index);
    }

private:
    enum Kind { long_context, context, short_context, pair_context, beside, start = beside + 6, sorted };
    static constexpr int n_situations = 4;

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
        for (int side = 0; side < 3; ++side) {
            const Index across = surface_.opposite[3 * f + side];
            if (across == none || across / 3 >= f) continue;
            earlier.face[earlier.n] = across / 3;
            earlier.side[earlier.n++] = static_cast<uint8_t>(across % 3);
        }
        return earlier;
    }

    // Steps and turns that led here, from many to few.
    std::array<uint64_t, n_situations> situations_of(const Earlier& earlier) const {
        if (earlier.n == 0) return {};
        const Index from = earlier.face[0], gate = surface_.opposite[3 * from];
        const uint64_t turn = LastSteps::mix(earlier.side[0], 0);
        const uint64_t step = LastSteps::mix(static_cast<uint64_t>(step_[from]), turn);
        const bool is_led = gate != none && gate / 3 < from;
        const uint64_t before = is_led ? LastSteps::mix(static_cast<uint64_t>(step_[gate / 3]), side_[from]) : 0;
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

    // By the greatest vertex, by the least, by their sum.
    void rank_by_vertices(std::span<const Index> vertex_source) {
        by_vertices_ = true;
        std::vector<int64_t> keys(source_.size());
        for (int by = 0; by < 3; ++by) {
            for (size_t f = 0; f < keys.size(); ++f) {
                std::array<int64_t, 3> v;
                for (int i = 0; i < 3; ++i) v[i] = vertex_source[surface_.vertex[3 * f + i]];
                std::sort(v.begin(), v.end());
                keys[f] = by == 0 ? v[2] << 31 | v[1] : by == 1 ? v[0] << 31 | v[1] : v[0] + v[1] + v[2];
            }
            ranks_.emplace_back(keys);
        }
    }

    void rank_by_position(std::span<const int64_t> positions, int axis) {
        std::vector<int64_t> keys(source_.size());
        for (size_t f = 0; f < source_.size(); ++f) {
            uint64_t sum = 0;  // wraps
            for (int i = 0; i < 3; ++i) sum += static_cast<uint64_t>(positions[3 * size_t(surface_.vertex[3 * f + i]) + axis]);
            keys[f] = static_cast<int64_t>(sum);
        }
        ranks_.emplace_back(keys);
    }

    const Surface& surface_;
    std::span<Index> source_;
    IndexCoder<Coder> indices_;
    std::vector<LocalRank> ranks_;
    bool by_vertices_ = false;
    std::vector<int64_t> step_;  // from the index of the face across the gate
    std::vector<uint8_t> side_;  // the edge of that face
    std::array<LastSteps, n_situations> steps_;
};

template <class Coder>
void run(const Geometry& known, std::span<const Index> vertex_source, bool uniform, std::span<Index> source,
         Coder& coder) {
    FaceOrderCoder<Coder> order(known, vertex_source, source, coder);
    uniform ? order.run_uniform() : order.run();
}

}  // namespace

Bytes encode_face_order(const Geometry& known, std::span<const Index> vertex_source, bool uniform,
                        std::span<const Index> source) {
    std::vector<Index> copy(source.begin(), source.end());
    RangeEncoder coder;
    run(known, vertex_source, uniform, copy, coder);
    return coder.finish();
}

std::vector<Index> decode_face_order(std::span<const uint8_t> bytes, const Geometry& known,
                                     std::span<const Index> vertex_source, bool uniform) {
    std::vector<Index> source(known.surface.vertex.size() / 3);
    RangeDecoder coder(bytes);
    run(known, vertex_source, uniform, source, coder);
    return source;
}

}  // namespace ebz::order
