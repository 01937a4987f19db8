// The two variants of the light method, and which of them may suit.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace ebz::positions {

// Either coordinates slide along tangent planes, the axis nearest to the normal last, or they are recalled, the given axis last.
struct LightVariant {
    bool recalls;
    uint8_t last;

    // The first byte of a stream; wide: coordinates of 64 bits.
    uint8_t byte(bool wide) const { return static_cast<uint8_t>((recalls ? last : 3) | (wide ? 4 : 0)); }
    static LightVariant of(uint8_t byte) { return {(byte & 3) < 3, static_cast<uint8_t>(byte & 3)}; }
};

// How many points have the coordinates of one before on all axes but d, at least.
inline size_t n_repeats(std::span<const int64_t> values, size_t d) {
    const size_t n = values.size() / 3, i = d == 0 ? 1 : 0, j = d == 2 ? 1 : 2;
    const int shift = 63 - std::bit_width(n);  // twice as many entries as points, or more
    std::vector<std::pair<int64_t, int64_t>> latest(size_t{1} << (64 - shift), {INT64_MIN, 0});
    size_t n_repeated = 0;
    for (size_t v = 0; v < n; ++v) {
        const std::pair<int64_t, int64_t> at = {values[3 * v + i], values[3 * v + j]};
        const uint64_t key = (static_cast<uint64_t>(at.first) * 0x9E3779B97F4A7C15u ^ static_cast<uint64_t>(at.second)) * 0xC2B2AE3D27D4EB4Fu;
        auto& entry = latest[key >> shift];
        n_repeated += entry == at ? 1 : 0;
        entry = at;
    }
    return n_repeated;
}

// The variants that may give the shortest stream: repeats of one point in 16 are hardly chance.
inline std::vector<LightVariant> light_variants(std::span<const int64_t> values) {
    std::array<size_t, 3> repeats{};
    for (size_t d = 0; d < 3; ++d) repeats[d] = n_repeats(values, d);
    uint8_t last = 2;
    for (const uint8_t d : {uint8_t{1}, uint8_t{0}})
        if (repeats[d] > repeats[last]) last = d;
    std::vector<LightVariant> variants = {{false, 3}};
    if (repeats[last] * 16 >= values.size() / 3) variants.push_back({true, last});
    return variants;
}

}  // namespace ebz::positions
