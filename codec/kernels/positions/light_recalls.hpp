// What coordinates may repeat: those of a twin, of neighbours and tips, what was expected, those of other places.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>

#include "gate_order.hpp"
#include "light_places.hpp"
#include "light_predictor.hpp"
#include "light_survey.hpp"
#include "light_values.hpp"
#include "twins.hpp"
#include "wrapping.hpp"

namespace ebz::positions {
inline namespace EBZ_INSTRUCTIONS {

template <class Unsigned>
class LightRecalls {
public:
    using Surroundings = LightSurroundings<Unsigned>;
    using Expectation = LightExpectation<Unsigned>;
    using Position = typename Surroundings::Position;
    using Signed = std::make_signed_t<Unsigned>;

    // last: the axis that is coded last.
    LightRecalls(const Surface& mesh, size_t last, const LightSurveyor<Unsigned>& sites)
        : sites_(sites), first_(last == 0 ? 1 : 0), places_(static_cast<size_t>(mesh.n_vertices)), twins_(mesh, last) {}

    // To be called first.  True if the vertex has been coded as its twin.
    template <class Coder>
    bool tell(Coder& coder, const PredictedVertex& from, Position& position) {
        const std::array<Gate, 2> gates = {{{from.a, from.b, from.o}, {from.c, from.d, from.p}}};
        twins_.start(from.vertex, std::span(gates).first(from.two() ? 2 : 1), *this);
        if (!twins_.tell(as_integers(position), [&](bool same, uint32_t p) { return coder.bit(0, same, p); })) return false;
        for (size_t d = 0; d < 3; ++d) position[d] = static_cast<Unsigned>(twins_.value(d));
        return true;
    }

    int32_t twin() const { return twins_.vertex(); }

    // s stays as it is until the vertex has been learnt.
    void start(const Surroundings& s) {
        s_ = &s;
        neighbour_agrees_ = {};
        tip_agrees_ = {};
        n_known_ = 0;
        for (size_t d = 0; d < 3; ++d) places_.prefetch(d, origins(d), d == first_);
    }

    // For twins.
    bool known(int32_t v) const { return sites_.known(v); }
    Twins::Position at(int32_t v) const { return as_integers(sites_.at(v)); }

    // True if the residual e of axis d has been coded as one of a value.
    template <class Coder>
    bool code(Coder& coder, size_t d, const Expectation& x, int64_t& e) {
        find(d, x);
        return values_.code(coder, d, x.level[d] + 2 * x.shift[d], e);
    }

    void reveal(size_t d, int64_t e, Unsigned coordinate) {
        const auto value = int64_t{static_cast<Signed>(coordinate)};
        values_.learn(e);
        if (!is_told_) places_.learn(d, static_cast<uint32_t>(coordinate));
        twins_.reveal(d, value);
        if (n_known_ == known_.size()) return;
        known_[n_known_++] = static_cast<uint32_t>(coordinate);
        for (size_t i = 0; i < s_->n_kept_neighbours(); ++i) neighbour_agrees_[i] += s_->neighbour_at[i][d] == coordinate ? 1 : 0;
        for (size_t i = 0; i < s_->n_kept_tips(); ++i) tip_agrees_[i] += s_->tip_at[i][d] == coordinate ? 1 : 0;
    }

    void learn(const PredictedVertex& from, Position position) {
        twins_.learn(from.vertex, previous(from.gate), as_integers(position), at(from.a), at(from.b));
    }

private:
    using Agreements = std::array<uint8_t, Surroundings::max_neighbours>;  // axes that agree with the position
    static_assert(Surroundings::max_tips == Surroundings::max_neighbours);

    static Twins::Position as_integers(Position x) { return {static_cast<Signed>(x[0]), static_cast<Signed>(x[1]), static_cast<Signed>(x[2])}; }

    void find(size_t d, const Expectation& x) {
        const size_t turn = n_known_, exact = static_cast<size_t>(std::min(-s_->exact[d], 3));
        const auto value = [d](const auto& position) { return int64_t{static_cast<Signed>(position[d])}; };
        const auto residual = [&](const auto& position) { return int64_t{static_cast<Signed>(position[d] - x.base[d])}; };
        values_.clear();
        if (twins_.exists())
            values_.add(LightValues::twin, turn, agreement(twins_.n_agree()), twins_.strength(), wrapping_difference(twins_.value(d), value(x.base)));
        is_told_ = twins_.is_strong() && twins_.n_agree() == turn;
        if (is_told_) return;
        if (x.shift[d] > 0) values_.add(x.plain[d] ? LightValues::plain_base : LightValues::expected_base, turn, 0, exact, 0);
        int64_t best = residual(s_->neighbour_at[0]);
        size_t most = neighbour_agrees_[0];
        for (size_t i = 1; i < s_->n_kept_neighbours(); ++i) {
            const int64_t other = residual(s_->neighbour_at[i]);
            const size_t agrees = neighbour_agrees_[i];
            if (agrees < most || (agrees == most && magnitude(other) >= magnitude(best))) continue;
            most = agrees;
            best = other;
        }
        values_.add(LightValues::neighbour, turn, agreement(most), exact, best);
        if (s_->n_tips > 1) {
            const size_t tip = first_largest(s_->n_kept_tips());
            values_.add(LightValues::tip, turn, agreement(tip_agrees_[tip]), exact, residual(s_->tip_at[tip]));
        }
        const std::array<uint32_t, 2> known = {turn > 0 ? known_[0] : origins(d)[0], turn > 1 ? known_[1] : 0};
        places_.add_to(values_, d, turn, known, origins(d), static_cast<uint32_t>(x.base[d]));
    }

    std::array<uint32_t, 2> origins(size_t d) const {
        return {static_cast<uint32_t>(s_->neighbour_at[0][d]), static_cast<uint32_t>(s_->neighbour_at[1][d])};
    }

    size_t first_largest(size_t n_tips) const {
        return static_cast<size_t>(std::max_element(tip_agrees_.begin(), tip_agrees_.begin() + static_cast<std::ptrdiff_t>(n_tips)) - tip_agrees_.begin());
    }

    // 0 at first, then 1, 2, 3 for none, some and all of the axes before.
    size_t agreement(size_t n_agree) const { return n_known_ == 0 ? 0 : n_agree == 0 ? 1 : n_agree < n_known_ ? 2 : 3; }

    const LightSurveyor<Unsigned>& sites_;
    size_t first_;  // axis
    const Surroundings* s_ = nullptr;
    LightValues values_;
    LightPlaces places_;
    Twins twins_;
    Agreements neighbour_agrees_{}, tip_agrees_{};
    std::array<uint32_t, 2> known_{};  // coordinates of the vertex
    size_t n_known_ = 0;
    bool is_told_ = false;  // by a twin, without further values
};

}  // namespace EBZ_INSTRUCTIONS
}  // namespace ebz::positions
