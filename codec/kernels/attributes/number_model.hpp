// A difference as binary decisions: side, class, digits; the tree of positions/residual_model.hpp.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "../positions/float_logistic.hpp"
#include "decision.hpp"

namespace ebz::attributes {

// What is expected of one component.
struct Expectation {
    Hashes context{};
    std::array<int64_t, n_candidates> offset{};  // of each candidate from the base
    std::array<float, n_candidates> mean{};      // the same before rounding
    std::array<float, n_candidates> scale{};     // of the logistic distribution around it
    unsigned candidates = 0;                     // which there are
    std::array<uint8_t, n_candidates> value_context{};
    int expected_class = 0;
    size_t turn = 0, level = 0;
};

class NumberModel {
public:
    explicit NumberModel(size_t n_values) : decision_(n_values, initial_weights_of_number) {}

    template <class Coder>
    int64_t code(Coder& coder, const Expectation& x, int64_t e) {
        start(x);
        const bool negative = split(coder, x, 0, side_node, side_slot, -1 - e);
        take_side(x, negative);
        const int64_t a = negative ? -1 - e : e;
        const int k = code_class(coder, x, a);
        const int64_t decoded = k < 2 ? k : code_digits(coder, x, k - 1, a);
        const int64_t difference = negative ? -1 - decoded : decoded;
        unsigned right = 0;
        for (size_t i = 0; i < n_candidates; ++i) right |= (x.offset[i] == difference ? 1u : 0u) << i;
        decision_.settle(right);
        return difference;
    }

private:
    static constexpr int max_class = 63;
    static constexpr int n_mixed_digits = 3;
    static constexpr size_t side_node = 0, class_node = 1, digit_node = 8;
    static constexpr size_t side_slot = 0, class_slot = 1, digit_slot = 15;
    static constexpr float max_logit = 11.0f, log2_e = 1.442695f;

    void start(const Expectation& x) {
        decision_.enter(x.context);
        decision_.consider(x.candidates, x.value_context);
        there_ = positions::lanes_of(x.candidates);
        for (size_t i = 0; i < n_candidates; ++i) {
            const bool is_there = (x.candidates >> i & 1) != 0;
            sharpness_[i] = is_there ? log2_e / x.scale[i] : 0.0f;
        }
        // Among distances of the negative side, e < 0 is "at least 0".
        mirror(x, true);
        from_low_ = all(1.0f);
        from_high_ = WideLanes{};
    }

    void mirror(const Expectation& x, bool negative) {
        negative_ = negative;
        for (size_t i = 0; i < n_candidates; ++i) {
            value_[i] = negative ? -1 - x.offset[i] : x.offset[i];
            mean_[i] = negative ? -1.0f - x.mean[i] : x.mean[i];
        }
    }

    void take_side(const Expectation& x, bool negative) {
        low_ = 0;
        if (negative) return;
        mirror(x, false);
        from_high_ = WideLanes{};
        from_low_ = tails(0);
    }

    static WideLanes all(float x) { return positions::splat<WideLanes>(x); }
    static WideLanes limited(WideLanes x, float limit) {
        return positions::max(positions::min(x, all(limit)), all(-limit));
    }

    WideLanes tails(int64_t at) const {
        const float edge = static_cast<float>(at) - 0.5f;
        return positions::squash(limited((mean_ - edge) * sharpness_, 80.0f));
    }

    // Whether a >= at, a being in [low_, ...).
    template <class Coder>
    bool split(Coder& coder, const Expectation& x, int64_t at, size_t node, size_t slot, int64_t a) {
        const WideLanes from_at = tails(at), tiny = all(1e-30f);
        const WideLanes above = positions::max(from_at - from_high_, tiny);
        const WideLanes below = positions::max(from_low_ - from_at, tiny);
        const WideLanes odds = positions::log2_approx(above) - positions::log2_approx(below);
        decision_.distributions = positions::only(there_, limited(odds, max_logit));
        unsigned upper = 0;
        for (unsigned rest = decision_.alive(); rest != 0; rest &= rest - 1) {
            const auto i = static_cast<size_t>(std::countr_zero(rest));
            if (value_[i] >= at) upper |= 1u << i;
        }
        const bool is_upper = decision_.code(coder, node, slot, x.turn, x.level, upper, a >= at);
        decision_.keep(is_upper ? upper : ~upper);
        if (is_upper) {
            low_ = at;
            from_low_ = from_at;
        } else {
            from_high_ = from_at;
        }
        return is_upper;
    }

    template <class Coder>
    int code_class(Coder& coder, const Expectation& x, int64_t a) {
        const int shift = x.expected_class - 3;
        const auto above = [&](int k) {  // a >= 2^k, that is class > k
            const auto j = static_cast<size_t>(std::clamp(k - shift, 0, 6));
            return split(coder, x, int64_t{1} << k, class_node + j, class_slot + j + (negative_ ? 7 : 0), a);
        };
        int k = x.expected_class;
        if (above(k)) {
            while (++k < max_class && above(k)) {}
            return k;
        }
        while (k > 0 && !above(k - 1)) --k;
        return k;
    }

    template <class Coder>
    int64_t code_digits(Coder& coder, const Expectation& x, int n_digits, int64_t a) {
        low_ = int64_t{1} << n_digits;
        const int shift = x.expected_class - 3;
        const auto group = static_cast<size_t>(std::clamp(n_digits - 1 - shift, 0, 3));
        bool first = false;
        for (int left = n_digits; left > 0; --left) {
            const int depth = n_digits - left;
            if (depth >= n_mixed_digits && decision_.alive() == 0) return code_raw(coder, left, a);
            const size_t node = digit_node + static_cast<size_t>(std::min(depth, 5)) * 4 + group;
            const size_t slot = depth == 0   ? digit_slot + group * 2 + (negative_ ? 1 : 0)
                                : depth == 1 ? digit_slot + 8 + group * 2 + (first ? 1 : 0)
                                             : Decision::n_slots;
            const bool upper = split(coder, x, low_ + (int64_t{1} << (left - 1)), node, slot, a);
            if (depth == 0) first = upper;
        }
        return low_;
    }

    template <class Coder>
    int64_t code_raw(Coder& coder, int n_digits, int64_t a) {
        uint64_t digits = 0;
        for (int left = n_digits; left > 0;) {
            const int n_raw = std::min(left, 16);
            left -= n_raw;
            const auto bits = static_cast<uint32_t>(static_cast<uint64_t>(a) >> left) & ((1u << n_raw) - 1);
            digits = digits << n_raw | coder.raw(bits, n_raw);
        }
        return low_ + static_cast<int64_t>(digits);
    }

    Decision decision_;
    // The difference under way: distances still possible begin at low_.
    WideLanes mean_{}, sharpness_{}, from_low_{}, from_high_{};  // P(a >= bound) of each distribution
    WideIntLanes there_{};
    std::array<int64_t, n_candidates> value_{};
    int64_t low_ = 0;
    bool negative_ = false;
};

}  // namespace ebz::attributes
