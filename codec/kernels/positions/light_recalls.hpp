// What coordinates may repeat: those of a twin, of neighbours, of a tip, of other places.
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
        tip_agrees_ = 0;
        n_known_ = 0;
        places_.start(low(s.neighbour_at[0]), low(s.neighbour_at[1]), first_);
    }

    // For twins.
    bool known(int32_t v) const { return sites_.known(v); }
    Twins::Position at(int32_t v) const { return as_integers(sites_.at(v)); }

    // True if the residual e of axis d has been coded as one of a value.
    template <class Coder>
    bool code(Coder& coder, size_t d, const Expectation& x, Signed& e) {
        find(d, x);
        return values_.code(coder, d, x.level[d] + 2 * x.shift[d], e);
    }

    void reveal(size_t d, Signed e, Unsigned coordinate) {
        values_.learn(e);
        if (!is_told_) places_.learn(static_cast<uint32_t>(coordinate));
        twins_.reveal(d, int64_t{static_cast<Signed>(coordinate)});
        if (n_known_ == known_.size()) return;
        known_[n_known_++] = static_cast<uint32_t>(coordinate);
        for (size_t i = 0; i < neighbour_agrees_.size(); ++i) neighbour_agrees_[i] += s_->neighbour_at[i][d] == coordinate ? 1 : 0;
        tip_agrees_ += s_->second[d] == coordinate ? 1 : 0;
    }

    void learn(const PredictedVertex& from, Position position) {
        twins_.learn(from.vertex, previous(from.gate), as_integers(position), at(from.a), at(from.b));
    }

private:
    using Values = LightValues<Signed>;

    static Twins::Position as_integers(Position x) { return {static_cast<Signed>(x[0]), static_cast<Signed>(x[1]), static_cast<Signed>(x[2])}; }

    void find(size_t d, const Expectation& x) {
        const size_t turn = n_known_;
        const auto residual = [&](Unsigned coordinate) { return static_cast<Signed>(coordinate - x.base[d]); };
        values_.clear();
        if (twins_.exists())
            values_.add(Values::twin, turn, agreement(twins_.n_agree()), residual(static_cast<Unsigned>(twins_.value(d))), twins_.strength());
        is_told_ = twins_.is_strong() && twins_.n_agree() == turn;
        if (is_told_) return;
        const size_t which = nearest(residual(s_->neighbour_at[0][d]), residual(s_->neighbour_at[1][d]));
        values_.add(Values::neighbour, turn, agreement(neighbour_agrees_[which]), residual(s_->neighbour_at[which][d]));
        if (s_->n_tips > 1) values_.add(Values::tip, turn, agreement(tip_agrees_), residual(s_->second[d]));
        places_.add_to(values_, d, turn, known_, static_cast<uint32_t>(x.base[d]));
    }

    // Of the first two neighbours the one that agrees more, else the nearer one, else the first.
    size_t nearest(Signed first, Signed second) const {
        if (neighbour_agrees_[0] != neighbour_agrees_[1]) return neighbour_agrees_[1] > neighbour_agrees_[0] ? 1 : 0;
        return magnitude(int64_t{second}) < magnitude(int64_t{first}) ? 1 : 0;
    }

    static UintLanes low(Position x) {
        if constexpr (sizeof(Unsigned) == sizeof(uint32_t)) return x;
        else return __builtin_convertvector(x, UintLanes);
    }

    // 0 at first, then 1, 2, 3 for none, some and all of the axes before.
    size_t agreement(size_t n_agree) const { return n_known_ == 0 ? 0 : n_agree == 0 ? 1 : n_agree < n_known_ ? 2 : 3; }

    const LightSurveyor<Unsigned>& sites_;
    size_t first_;  // axis
    const Surroundings* s_ = nullptr;
    Values values_;
    LightPlaces places_;
    Twins twins_;
    std::array<uint8_t, 2> neighbour_agrees_{};  // axes on which the first two agree with the position
    size_t tip_agrees_ = 0;                      // the same of the second tip
    std::array<uint32_t, 2> known_{};  // coordinates of the vertex
    size_t n_known_ = 0;
    bool is_told_ = false;  // by a twin, without further values
};

}  // namespace EBZ_INSTRUCTIONS
}  // namespace ebz::positions
