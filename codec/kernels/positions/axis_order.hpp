// The order in which the coordinates of a vertex are coded.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace ebz::positions {

// By the normal, the axis nearest to it last, which the tangent plane then tells of; or always the same axis last,
// which coordinates that were there before tell of.
struct AxisOrder {
    uint8_t last = by_normal;  // 0 to 2, or by_normal
    static constexpr uint8_t by_normal = 3;

    // From the low bits of any byte.
    static AxisOrder of(uint8_t byte) { return {static_cast<uint8_t>(byte & 3)}; }
    bool is_fixed() const { return last != by_normal; }

    static std::array<size_t, 3> ending_with(size_t d) { return {d == 0 ? 1u : 0u, d == 2 ? 1u : 2u, d}; }
};

// How many points, about, have the coordinates of one before on all axes but d: hashes stand for coordinates.
inline size_t n_repeats(std::span<const int64_t> values, size_t d) {
    const size_t n = values.size() / 3, i = d == 0 ? 1 : 0, j = d == 2 ? 1 : 2;
    const int n_bits = std::bit_width(n) + 1;  // twice as many entries as points, or more
    std::vector<uint64_t> latest(size_t{1} << n_bits, 0);
    size_t n_repeated = 0;
    for (size_t v = 0; v < n; ++v) {
        const uint64_t mixed = static_cast<uint64_t>(values[3 * v + i]) * 0x9E3779B97F4A7C15u ^ static_cast<uint64_t>(values[3 * v + j]);
        const uint64_t key = (mixed * 0xC2B2AE3D27D4EB4Fu) | 1;
        uint64_t& entry = latest[key >> (64 - n_bits)];
        n_repeated += entry == key ? 1 : 0;
        entry = key;
    }
    return n_repeated;
}

// The orders that may give the shortest stream.  That the coordinates of one point in 12 come again may be chance, those of
// one in 4 are not.
inline std::vector<AxisOrder> axis_orders(std::span<const int64_t> values) {
    std::array<size_t, 3> repeats{};
    for (size_t d = 0; d < 3; ++d) repeats[d] = n_repeats(values, d);
    uint8_t last = 2;
    for (const uint8_t d : {uint8_t{1}, uint8_t{0}})
        if (repeats[d] > repeats[last]) last = d;
    const size_t n = values.size() / 3, most = repeats[last];
    std::vector<AxisOrder> orders;
    if (most * 4 < n || n == 0) orders.push_back({});
    if (most * 12 >= n && n > 0) orders.push_back({last});
    return orders;
}

}  // namespace ebz::positions
