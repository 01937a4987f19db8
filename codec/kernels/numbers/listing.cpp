#include "listing.hpp"

#include <algorithm>
#include <bit>
#include <numeric>
#include <utility>

namespace ebz {

namespace {

constexpr size_t max_found = 1 << 16, n_tried = 1 << 11;

// The largest number of different ones that is worth a list: some thirds and 8, fewer than an eighth of the integers in
// their range, and max_found.
size_t most_different(uint64_t n, uint64_t thirds, uint64_t range) {
    return range == 0 ? 0 : static_cast<size_t>(std::min({uint64_t{max_found}, 8 + thirds * n / 3, (range - 1) / 8}));
}

uint64_t range_of(std::span<const int64_t> values) {
    if (values.empty()) return 0;
    const auto [least, greatest] = std::minmax_element(values.begin(), values.end());
    return static_cast<uint64_t>(*greatest) - static_cast<uint64_t>(*least);
}

// Numbers different integers as they appear, in an open-addressing table.
class Numbering {
public:
    explicit Numbering(size_t most) : most_(most), slots_(std::bit_ceil(2 * most + 2), none) { found_.reserve(most); }

    // False if there are more than the most.
    bool add(std::span<const int64_t> values, std::vector<int64_t>* which) {
        for (const int64_t x : values) {
            size_t slot = hash(x) & (slots_.size() - 1);
            while (slots_[slot] != none && found_[slots_[slot]] != x) slot = (slot + 1) & (slots_.size() - 1);
            if (slots_[slot] == none) {
                if (found_.size() == most_) return false;
                slots_[slot] = static_cast<uint32_t>(found_.size());
                found_.push_back(x);
            }
            if (which) which->push_back(slots_[slot]);
        }
        return true;
    }

    std::vector<int64_t>& found() { return found_; }

private:
    static constexpr uint32_t none = UINT32_MAX;

    static size_t hash(int64_t x) {
        const uint64_t h = static_cast<uint64_t>(x) * 0x9E3779B97F4A7C15u;
        return static_cast<size_t>(h ^ h >> 32);
    }

    size_t most_;
    std::vector<uint32_t> slots_;
    std::vector<int64_t> found_;
};

// Of the first ones more are different than of all.
bool may_be_few(std::span<const int64_t> values) {
    const auto first = values.first(std::min(values.size(), n_tried));
    const size_t most = most_different(first.size(), 2, range_of(first));
    return most > 0 && Numbering(most).add(first, nullptr);
}

Listed ascending(Listed listed) {
    std::vector<uint32_t> order(listed.found.size());
    std::iota(order.begin(), order.end(), 0u);
    std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) { return listed.found[a] < listed.found[b]; });
    std::vector<int64_t> rank(order.size());
    for (size_t i = 0; i < order.size(); ++i) rank[order[i]] = static_cast<int64_t>(i);
    std::sort(listed.found.begin(), listed.found.end());
    for (int64_t& number : listed.which) number = rank[static_cast<size_t>(number)];
    return listed;
}

}  // namespace

Listed list_different(std::span<const int64_t> values) {
    if (!may_be_few(values)) return {};
    const uint64_t range = range_of(values), n = values.size();
    const bool is_sparse = range / 256 >= n, is_short = n <= n_tried;
    const size_t most = most_different(n, is_sparse || is_short ? 2 : 1, range);
    Numbering numbering(most);
    Listed listed;
    listed.which.reserve(values.size());
    if (!numbering.add(values, &listed.which)) return {};
    listed.found = std::move(numbering.found());
    return ascending(std::move(listed));
}

}  // namespace ebz
