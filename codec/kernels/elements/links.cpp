#include "links.hpp"

#include <array>

#include "../errors.hpp"
#include "../entropy/integers.hpp"
#include "neighbours.hpp"

namespace ebz::elements {

namespace {

// One path for both sides: an encoder codes the corners that are there, a decoder fills them in.
template <class Coder>
class LinkCoder {
public:
    LinkCoder(Coder& coder, const Mesh& mesh) : coder_(coder), n_vertices_(mesh.n_vertices), neighbours_(mesh) {}

    void run(std::span<const int64_t> offsets, std::span<int32_t> corners) {
        for (size_t row = 0; row + 1 < offsets.size(); ++row) {
            const auto begin = static_cast<size_t>(offsets[row]), end = static_cast<size_t>(offsets[row + 1]);
            for (size_t c = begin; c < end; ++c) corners[c] = c == begin ? start(corners[c]) : go_on(corners[c]);
        }
    }

private:
    enum Kind : size_t { between_rows, within_row };

    // The first corner: where the row before ended or began, or near where it began.
    int32_t start(int32_t v) {
        const int32_t before = before_, latest = latest_, first = first_;
        before_ = -1;
        if (latest < 0) v = far(between_rows, 0, v);
        else if (is_latest_.code(coder_, v == latest)) v = latest, before_ = before;
        else if (first != latest && is_first_.code(coder_, v == first)) v = first;
        else v = near(between_rows, first, v);
        return first_ = latest_ = v;
    }

    int32_t go_on(int32_t v) {
        const int32_t from = latest_;
        latest_ = near(within_row, from, v);
        before_ = from;
        return latest_;
    }

    // A neighbour, or any vertex.
    int32_t near(Kind kind, int32_t from, int32_t v) {
        std::array<int32_t, Neighbours::max_candidates> candidates;
        const size_t n = neighbours_.rank(from, before_, candidates);
        const auto end = candidates.begin() + static_cast<ptrdiff_t>(n), found = std::find(candidates.begin(), end, v);
        bool& was_near = was_near_[kind];
        was_near = n > 0 && is_near_[kind][was_near].code(coder_, found != end);
        if (!was_near) return far(kind, from, v);
        v = candidates[code_rank(n, static_cast<size_t>(found - candidates.begin()))];
        if (kind == within_row) neighbours_.tell(from, v);
        return v;
    }

    size_t code_rank(size_t n, size_t rank) {
        auto& stops = stops_[before_ >= 0][std::min<size_t>(n, n_contexts - 1)];
        size_t r = 0;
        while (r + 1 < n && !stops[std::min<size_t>(r, n_contexts - 1)].code(coder_, r == rank)) ++r;
        return r;
    }

    int32_t far(Kind kind, int32_t from, int32_t v) {
        const uint64_t step = steps_[kind].code(coder_, zigzag(static_cast<int64_t>(v) - from));
        const uint64_t found = static_cast<uint64_t>(unzigzag(step)) + static_cast<uint64_t>(from);
        if (found >= static_cast<uint64_t>(n_vertices_)) throw Corrupt("a row has a vertex that is none");
        return static_cast<int32_t>(found);
    }

    static constexpr size_t n_contexts = 16;

    Coder& coder_;
    int32_t n_vertices_;
    Neighbours neighbours_;
    int32_t first_ = -1, latest_ = -1;  // of the row under way, at its start of the row before
    int32_t before_ = -1;               // the corner before the latest, -1 for none
    std::array<bool, 2> was_near_{};
    AdaptiveBit is_latest_, is_first_;
    std::array<std::array<AdaptiveBit, 2>, 2> is_near_;
    std::array<std::array<std::array<AdaptiveBit, n_contexts>, n_contexts>, 2> stops_;
    std::array<IntegerModel, 2> steps_;
};

}  // namespace

std::vector<uint8_t> encode_links(const Mesh& mesh, std::span<const int64_t> offsets, std::span<const int32_t> corners) {
    std::vector<int32_t> copy(corners.begin(), corners.end());
    RangeEncoder coder;
    LinkCoder(coder, mesh).run(offsets, copy);
    return coder.finish();
}

std::vector<int32_t> decode_links(std::span<const uint8_t> bytes, const Mesh& mesh, std::span<const int64_t> offsets) {
    std::vector<int32_t> corners(static_cast<size_t>(offsets.back()));
    RangeDecoder coder(bytes);
    LinkCoder(coder, mesh).run(offsets, corners);
    return corners;
}

}  // namespace ebz::elements
