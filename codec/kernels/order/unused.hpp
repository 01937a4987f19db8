// The indices 0 .. n - 1 that are not used yet, counted by the nodes of a complete binary tree.
#pragma once

#include <cstdint>
#include <vector>

#include "../surface/corner_table.hpp"

namespace ebz::order {

// Node 1 is the root, 2k and 2k + 1 are below k; index i is the leaf first_leaf + i.
class Unused {
public:
    explicit Unused(Index n) : n_(n) {
        while (int64_t{1} << height_ < n) ++height_;
        count_.resize(2 * first_leaf());
        for (Index i = 0; i < n; ++i) count_[first_leaf() + i] = 1;
        for (size_t k = first_leaf() - 1; k > 0; --k) count_[k] = count_[2 * k] + count_[2 * k + 1];
    }

    int height() const { return height_; }
    uint32_t count(size_t node) const { return count_[node]; }
    bool has(int64_t i) const { return 0 <= i && i < n_ && count_[first_leaf() + i]; }

    void take(Index i) {
        for (size_t k = first_leaf() + i; k > 0; k /= 2) --count_[k];
    }

    // The least unused index above i, i >= -1; none if there is none.
    Index above(Index i) const {
        size_t k = 1;
        if (i >= 0) {
            k = first_leaf() + i;
            while (k > 1 && (k % 2 == 1 || !count_[k + 1])) k /= 2;
            if (k == 1) return none;
            ++k;
        }
        if (!count_[k]) return none;
        while (k < first_leaf()) k = 2 * k + !count_[2 * k];
        return static_cast<Index>(k - first_leaf());
    }

    // The greatest unused index below i, 0 <= i < n; none if there is none.
    Index below(Index i) const {
        size_t k = first_leaf() + i;
        while (k > 1 && (k % 2 == 0 || !count_[k - 1])) k /= 2;
        if (k <= 1) return none;
        for (--k; k < first_leaf();) k = 2 * k + (count_[2 * k + 1] > 0);
        return static_cast<Index>(k - first_leaf());
    }

private:
    size_t first_leaf() const { return size_t{1} << height_; }

    Index n_;
    int height_ = 0;
    std::vector<uint32_t> count_;
};

}  // namespace ebz::order
