// Powers of two, logarithms and the logistic function out of exact operations.
//
// Only IEEE single additions, multiplications, divisions and bit patterns occur, so that every machine
// computes the same bits (compile with -ffp-contract=off).  All logits are to base 2.
#pragma once

#include <array>
#include <bit>
#include <cfloat>
#include <cstddef>
#include <cstdint>

#include "../instruction_set.hpp"

namespace ebz::positions {
inline namespace EBZ_INSTRUCTIONS {

static_assert(FLT_EVAL_METHOD == 0, "excess precision would change the stream");

// 2^x for |x| <= 126, relative error below 0.3 %.
constexpr float exp2_approx(float x) {
    const int32_t whole = static_cast<int32_t>(x + 128.0f) - 128;
    const float part = x - static_cast<float>(whole);
    const float power = std::bit_cast<float>((whole + 127) << 23);
    return power * (1.0f + part * (0.6565f + 0.3435f * part));
}

// log2 x for normal x > 0, absolute error below 0.01.
constexpr float log2_approx(float x) {
    const int32_t bits = std::bit_cast<int32_t>(x);
    const float part = std::bit_cast<float>((bits & 0x7fffff) | 0x3f800000) - 1.0f;
    return static_cast<float>((bits >> 23) - 127) + part * (1.343f - 0.343f * part);
}

constexpr float clamp(float x, float low, float high) { return x > low ? (x < high ? x : high) : low; }

// 1 / (1 + 2^-x) for |x| <= 120.
constexpr float squash(float x) { return 1.0f / (1.0f + exp2_approx(-x)); }

constexpr float logit(float p) { return log2_approx(p) - log2_approx(1.0f - p); }

// logit of a 16-bit probability, by its upper 12 bits.
inline constexpr auto logits = [] {
    std::array<float, 4096> table{};
    for (size_t i = 0; i < table.size(); ++i) table[i] = logit((static_cast<float>(i) + 0.5f) / 4096.0f);
    return table;
}();

}  // namespace EBZ_INSTRUCTIONS
}  // namespace ebz::positions
