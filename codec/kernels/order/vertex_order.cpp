// The indices of the vertices, predicted like positions: parallelograms, neighbours, sorted coordinates.
#include <algorithm>
#include <array>

#include "../errors.hpp"
#include "index_coder.hpp"
#include "local_rank.hpp"
#include "permutations.hpp"

namespace ebz::order {

namespace {

// Indices of the source around a vertex.
struct Around {
    static constexpr int max_parallelograms = 4, max_neighbours = 3, max_corners = 24;

    void add_parallelogram(int64_t index) {
        if (n_parallelograms < max_parallelograms) parallelograms[n_parallelograms++] = index;
    }

    void add_neighbour(Index index) {
        const auto end = neighbours.begin() + n_neighbours;
        if (n_neighbours < max_neighbours && std::find(neighbours.begin(), end, index) == end) {
            neighbours[n_neighbours++] = index;
        }
    }

    // The value given most often, the first of several.
    int64_t commonest() const {
        const auto end = parallelograms.begin() + n_parallelograms;
        return *std::max_element(parallelograms.begin(), end, [&](int64_t a, int64_t b) {
            return std::count(parallelograms.begin(), end, a) < std::count(parallelograms.begin(), end, b);
        });
    }

    std::array<int64_t, max_parallelograms> parallelograms;
    std::array<Index, max_neighbours> neighbours;
    int n_parallelograms = 0, n_neighbours = 0;
};

// One path for both sides: an encoder codes the indices that are there, a decoder fills them in.
template <class Coder>
class VertexOrderCoder {
public:
    VertexOrderCoder(const Geometry& known, std::span<Index> source, Coder& coder)
        : surface_(known.surface),
          corners_(surface_),
          source_(source),
          is_coded_(source.size()),
          indices_(coder, surface_.n_vertices),
          n_used_(count_used(surface_)) {
        std::vector<int64_t> keys(n_used_);
        for (int axis = 0; axis < 3; ++axis) {
            for (Index v = 0; v < n_used_; ++v) keys[v] = known.positions[3 * size_t(v) + axis];
            ranks_.emplace_back(keys);
        }
    }

    void run(Visits visits) {
        by_first_use_ = !visits.vertices.empty();
        // Polygons of a damaged file may leave out vertices of their triangles.
        if (by_first_use_ && visits.vertices.size() < static_cast<size_t>(n_used_)) throw Corrupt("vertices that no face visits");
        for (Index i = 0; i < n_used_; ++i) code(by_first_use_ ? visits.vertices[i] : i);
        add_isolated();
    }

    void run_uniform() {
        for (Index v = 0; v < n_used_; ++v) source_[v] = indices_.code_uniform(source_[v]);
        add_isolated();
    }

private:
    enum Kind { common, other, beside, after_previous = beside + 2 * Around::max_neighbours };

    static Index count_used(const Surface& surface) {
        Index last = none;
        for (const Index v : surface.vertex) last = std::max(last, v);
        return last + 1;
    }

    void code(Index v) {
        const Around around = look_around(v);
        source_[v] = indices_.code(expect(v, around), source_[v]);
        is_coded_[v] = true;
        previous_ = source_[v];
        for (LocalRank& rank : ranks_) rank.learn(v, source_[v]);
    }

    Expectation expect(Index v, const Around& around) const {
        Expectation expected;
        const Unused& unused = indices_.unused();
        if (by_first_use_) expected.guess(unused.above(previous_), after_previous);
        const bool grows = around.n_parallelograms > 0;
        const int64_t common_index = grows ? around.commonest() : none;
        if (grows) expected.guess(common_index, common);
        for (int i = 0; i < around.n_parallelograms; ++i) expected.guess(around.parallelograms[i], other);
        for (int i = 0; i < around.n_neighbours; ++i) {
            expected.guess(unused.above(around.neighbours[i]), beside + 2 * i);
            expected.guess(unused.below(around.neighbours[i]), beside + 2 * i + 1);
            if (i < 2) expected.beside[i] = around.neighbours[i];
        }
        if (!by_first_use_) expected.guess(unused.above(previous_), after_previous);
        expected.reference = around.n_neighbours > 0 ? around.neighbours[0] : previous_;
        expected.anchor(common_index);
        expected.anchor(expected.beside[0]);
        expected.anchor(expected.beside[1]);
        expected.anchor(previous_);
        for (const LocalRank& rank : ranks_) expected.anchor(rank.guess(v));
        return expected;
    }

    Around look_around(Index v) const {
        Around around;
        const std::span<const Index> corners = corners_[v];
        for (const Index c : corners.first(std::min<size_t>(corners.size(), Around::max_corners))) {
            const Index a = surface_.vertex[next(c)], b = surface_.vertex[previous(c)];
            const Index across = surface_.opposite[next(c)];
            if (is_coded_[a] && is_coded_[b] && across != none) {
                const Index tip = surface_.vertex[previous(across)];
                if (is_coded_[tip]) around.add_parallelogram(int64_t{source_[a]} + source_[b] - source_[tip]);
            }
            if (is_coded_[a]) around.add_neighbour(source_[a]);
            if (is_coded_[b]) around.add_neighbour(source_[b]);
        }
        return around;
    }

    void add_isolated() {
        Index last = none;
        for (Index v = n_used_; v < surface_.n_vertices; ++v) {
            last = source_[v] = indices_.unused().above(last);
        }
    }

    const Surface& surface_;
    positions::CornersOfVertices corners_;
    std::span<Index> source_;
    std::vector<bool> is_coded_;
    IndexCoder<Coder> indices_;
    std::vector<LocalRank> ranks_;
    Index n_used_;
    Index previous_ = none;
    bool by_first_use_ = false;
};

template <class Coder>
void run(const Geometry& known, Visits visits, bool uniform, std::span<Index> source, Coder& coder) {
    VertexOrderCoder<Coder> order(known, source, coder);
    uniform ? order.run_uniform() : order.run(visits);
}

}  // namespace

Bytes encode_vertex_order(const Geometry& known, Visits visits, bool uniform, std::span<const Index> source) {
    std::vector<Index> copy(source.begin(), source.end());
    RangeEncoder coder;
    run(known, visits, uniform, copy, coder);
    return coder.finish();
}

std::vector<Index> decode_vertex_order(std::span<const uint8_t> bytes, const Geometry& known, Visits visits,
                                       bool uniform) {
    std::vector<Index> source(known.surface.n_vertices);
    RangeDecoder coder(bytes);
    run(known, visits, uniform, source, coder);
    return source;
}

}  // namespace ebz::order
