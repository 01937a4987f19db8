#include "octree.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <numeric>

#include "../errors.hpp"
#include "../entropy/integers.hpp"
#include "../entropy/range_coder.hpp"
#include "cells.hpp"
#include "octree_model.hpp"

namespace ebz::points {

namespace {

// What the encoder knows besides: the points, in the order that they will come out in.
class Source {
public:
    explicit Source(std::span<const int64_t> values) : values_(values), order_(values.size() / 3), moved_(order_.size()) {
        std::iota(order_.begin(), order_.end(), 0);
        for (size_t axis = 0; axis < 3 && !order_.empty(); ++axis) {
            lowest_[axis] = values[axis];
            for (size_t i = axis; i < values.size(); i += 3) lowest_[axis] = std::min(lowest_[axis], values[i]);
        }
    }

    const std::array<int64_t, 3>& lowest() const { return lowest_; }

    // Bits of the largest distance from the lowest corner.
    uint64_t depth() const {
        uint64_t all = 0;
        for (int32_t i : order_) {
            for (size_t axis = 0; axis < 3; ++axis) all |= distance(i, axis);
        }
        return static_cast<uint64_t>(std::bit_width(all));
    }

    // Sorts a cell's points by the child that they are in; the ends of the children.
    std::array<uint32_t, 8> partition(const Cell& cell, int level) {
        std::array<uint32_t, 8> ends{};
        for (uint32_t i = cell.begin; i < cell.end; ++i) ++ends[child_of(order_[i], level)];
        std::array<uint32_t, 8> next{};
        for (uint32_t child = 0, sum = cell.begin; child < 8; ++child) {
            next[child] = sum;
            sum += ends[child];
            ends[child] = sum;
        }
        for (uint32_t i = cell.begin; i < cell.end; ++i) moved_[next[child_of(order_[i], level)]++] = order_[i];
        std::copy(moved_.begin() + cell.begin, moved_.begin() + cell.end, order_.begin() + cell.begin);
        return ends;
    }

    std::vector<int32_t> order() && { return std::move(order_); }

private:
    uint64_t distance(int32_t i, size_t axis) const {
        return static_cast<uint64_t>(values_[3 * static_cast<size_t>(i) + axis]) - static_cast<uint64_t>(lowest_[axis]);
    }

    size_t child_of(int32_t i, int level) const {
        return (distance(i, 0) >> level & 1) << 2 | (distance(i, 1) >> level & 1) << 1 | (distance(i, 2) >> level & 1);
    }

    std::span<const int64_t> values_;
    std::vector<int32_t> order_, moved_;
    std::array<int64_t, 3> lowest_{};
};

template <class Coder>
class Octree {
public:
    Octree(Coder& coder, size_t n, Source* source) : coder_(coder), n_(n), source_(source) {}

    // Afterwards there is a cell for every position, with the number of its points.
    void run() {
        const int depth = code_frame();
        cells_ = {Cell{.end = static_cast<uint32_t>(n_)}};
        for (int level = depth - 1; level >= 0; --level) code_level(level);
        code_repeats();
    }

    std::vector<int64_t> values() const {
        std::vector<int64_t> values;
        values.reserve(3 * n_);
        for (const Cell& cell : cells_) {
            for (uint32_t i = cell.begin; i < cell.end; ++i) {
                for (size_t axis = 0; axis < 3; ++axis) {
                    values.push_back(static_cast<int64_t>(static_cast<uint64_t>(lowest_[axis]) + cell.at[axis]));
                }
            }
        }
        return values;
    }

private:
    static constexpr int max_depth = 64;

    int code_frame() {
        if constexpr (Coder::encoding) lowest_ = source_->lowest();
        for (int64_t& x : lowest_) x = unzigzag(frame_.code(coder_, zigzag(x)));
        uint64_t depth = 0;
        if constexpr (Coder::encoding) depth = source_->depth();
        depth = depths_.code(coder_, depth);
        if (depth > max_depth) throw Corrupt("an octree of more than 64 levels");
        return static_cast<int>(depth);
    }

    void code_level(int level) {
        table_.build(cells_);
        children_.assign(cells_.size(), 0);
        std::vector<Cell> below;
        below.reserve(std::min(n_, 8 * cells_.size()));
        for (uint32_t i = 0; i < cells_.size(); ++i) {
            const Cell& cell = cells_[i];
            std::array<uint32_t, 8> ends{};
            uint8_t children = 0;
            if constexpr (Coder::encoding) {
                ends = source_->partition(cell, level);
                for (uint32_t child = 0, begin = cell.begin; child < 8; begin = ends[child++]) {
                    children |= static_cast<uint8_t>((ends[child] > begin) << child);
                }
            }
            const Surroundings beside = cell.is_remote ? Surroundings{} : surroundings(cell.at, i);
            children = children_[i] = model_.code(coder_, children, cell, beside, level);
            append_children(below, cell, children, ends, beside.is_alone());
            if (below.size() > n_) throw Corrupt("more points than there are");
        }
        cells_ = std::move(below);
    }

    Surroundings surroundings(const Position& at, uint32_t self) const {
        Surroundings beside;
        for (int place = 0; place < n_around; ++place) {
            if (place == centre) continue;
            Position other = at;  // modulo 2^64: what is beyond an end is not found
            for (size_t axis = 0; axis < 3; ++axis) other[axis] += static_cast<uint64_t>(axes_of(place)[axis]) - 1;
            const uint32_t cell = table_.find(other);
            if (cell == CellTable::none) continue;
            beside.present |= 1u << place;
            if (cell < self) beside.children[static_cast<size_t>(place)] = children_[cell];
        }
        return beside;
    }

    static void append_children(std::vector<Cell>& below, const Cell& cell, uint8_t children,
                                const std::array<uint32_t, 8>& ends, bool is_alone) {
        const int n = std::popcount(children);
        for (uint32_t child = 0; child < 8; ++child) {
            if (!(children >> child & 1)) continue;
            below.push_back({
                .at = {2 * cell.at[0] + (child >> 2), 2 * cell.at[1] + (child >> 1 & 1), 2 * cell.at[2] + (child & 1)},
                .begin = child ? ends[child - 1] : cell.begin,
                .end = ends[child],
                .chain = static_cast<uint8_t>(n == 1 ? std::min(cell.chain + 1, 255) : 0),
                .siblings = static_cast<uint8_t>(n - 1),
                .child = static_cast<uint8_t>(child),
                .is_remote = n == 1 && is_alone,
            });
        }
    }

    // A bit after every point tells whether the next one is at the same position.
    void code_repeats() {
        uint32_t total = 0;
        bool repeated = false;
        for (Cell& cell : cells_) {
            const uint32_t n = cell.end - cell.begin;
            uint32_t seen = 1;
            while (again_[repeated][std::min<uint32_t>(seen, 3) - 1].code(coder_, seen < n)) {
                if (total + ++seen > n_) throw Corrupt("more points than there are");
            }
            repeated = seen > 1;
            cell.begin = total;
            cell.end = total += seen;
        }
        if (total != n_) throw Corrupt("fewer points than there are");
    }

    Coder& coder_;
    size_t n_;
    Source* source_;
    std::array<int64_t, 3> lowest_{};
    std::vector<Cell> cells_;
    std::vector<uint8_t> children_;
    CellTable table_;
    OctreeModel model_;
    IntegerModel frame_, depths_;
    std::array<std::array<AdaptiveBit, 3>, 2> again_;
};

}  // namespace

Encoded encode(std::span<const int64_t> values) {
    Source source(values);
    RangeEncoder coder;
    Octree(coder, values.size() / 3, &source).run();
    return {coder.finish(), std::move(source).order()};
}

std::vector<int64_t> decode(std::span<const uint8_t> bytes, size_t n) {
    RangeDecoder coder(bytes);
    Octree tree(coder, n, nullptr);
    tree.run();
    return tree.values();
}

}  // namespace ebz::points
