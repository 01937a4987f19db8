// The order in which the coordinates of a vertex are coded.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "surface.hpp"
#include "wrapping.hpp"

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

// Counts what comes again; hashes stand for what is counted.
class Repeats {
public:
    // n: how many there will be.
    explicit Repeats(size_t n) : shift_(63 - std::bit_width(n)), latest_(size_t{1} << (64 - shift_), 0) {}

    void add(uint64_t hash) {
        const uint64_t key = (hash * 0xC2B2AE3D27D4EB4Fu) | 1;
        uint64_t& entry = latest_[key >> shift_];
        n_ += entry == key ? 1 : 0;
        entry = key;
    }

    size_t n() const { return n_; }

private:
    int shift_;  // so that there are twice as many entries, or more
    std::vector<uint64_t> latest_;
    size_t n_ = 0;
};

// How many points have the coordinates of one before on all axes but d, but for so many low bits.
inline size_t n_repeated_places(std::span<const int64_t> values, size_t d, int n_low) {
    const size_t n = values.size() / 3, i = d == 0 ? 1 : 0, j = d == 2 ? 1 : 2;
    Repeats repeats(n);
    const auto high = [&](size_t at) { return static_cast<uint64_t>(values[at] >> n_low); };
    for (size_t v = 0; v < n; ++v) repeats.add(high(3 * v + i) * 0x9E3779B97F4A7C15u ^ high(3 * v + j));
    return repeats.n();
}

// How many triangles are those of before, moved or mirrored.  Those so small that this may be chance are not counted.
inline size_t n_repeated_shapes(const Surface& mesh, std::span<const int64_t> values) {
    const size_t n = mesh.vertex.size() / 3;
    const int least = 3 * (std::bit_width(n) + 6) / 2;  // digits of three sides, of which two tell the third
    Repeats repeats(n);
    for (size_t c = 0; c + 2 < mesh.vertex.size(); c += 3) {
        uint64_t hash = 0;
        int digits = 0;
        for (size_t k = 0; k < 3; ++k) {
            const size_t a = 3 * static_cast<size_t>(mesh.vertex[c + k]), b = 3 * static_cast<size_t>(mesh.vertex[c + (k + 1) % 3]);
            uint64_t edge = 0;
            for (size_t d = 0; d < 3; ++d) {
                const uint64_t step = magnitude(wrapping_difference(values[a + d], values[b + d]));
                edge = (edge ^ step) * 0x9E3779B97F4A7C15u;
                digits += std::bit_width(step);
            }
            hash += edge ^ edge >> 32;  // whichever edge is the first
        }
        if (digits >= least) repeats.add(hash);
    }
    return repeats.n();
}

// The orders that may give the shortest stream.
inline std::vector<AxisOrder> axis_orders(const Surface& mesh, std::span<const int64_t> values) {
    const size_t n = values.size() / 3;
    if (n == 0) return {AxisOrder{}};
    std::array<size_t, 3> repeats{};
    for (size_t d = 0; d < 3; ++d) repeats[d] = n_repeated_places(values, d, 0);
    uint8_t last = 2;
    for (const uint8_t d : {uint8_t{1}, uint8_t{0}})
        if (repeats[d] > repeats[last]) last = d;
    // Places that come again by chance would do so four times as often without the lowest bits; others as often.
    const size_t most = repeats[last];
    bool is_alike = false;
    if (most * 64 >= n) {
        const size_t roughly = n_repeated_places(values, last, 1);
        if (most * 12 >= n && 16 * most >= n + 4 * roughly) return {AxisOrder{last}};
        is_alike = 2 * roughly < 3 * most;
    }
    is_alike = is_alike || n_repeated_shapes(mesh, values) * 15 >= 2 * mesh.vertex.size();
    return is_alike ? std::vector{AxisOrder{}, AxisOrder{last}} : std::vector{AxisOrder{}};
}

}  // namespace ebz::positions
