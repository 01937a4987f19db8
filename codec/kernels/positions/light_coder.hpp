// The light method: vertices in the order of gates, axis by axis, one symbol each.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "../ans.hpp"
#include "light.hpp"
#include "light_model.hpp"
#include "light_places.hpp"
#include "light_predictor.hpp"
#include "light_survey.hpp"
#include "light_values.hpp"
#include "recall.hpp"
#include "surface.hpp"
#include "gate_order.hpp"
#include "wrapping.hpp"

namespace ebz::positions {
inline namespace EBZ_INSTRUCTIONS {

template <class Coder>
class LightCoder {
public:
    LightCoder(Coder& coder, const Surface& mesh, std::span<int64_t> xyz)
        : coder_(coder), mesh_(mesh), order_(mesh), surveyor_(mesh), places_(static_cast<size_t>(mesh.n_vertices)), xyz_(xyz.data()) {}

    void run() {
        const auto n_faces = static_cast<int32_t>(mesh_.vertex.size() / 3);
        for (int32_t t = 0; t < n_faces; ++t)
            if (!order_.visited(t)) component(t);
        for (int32_t v = 0; v < mesh_.n_vertices; ++v)
            if (!order_.known(v)) code(v);
    }

private:
    static constexpr size_t n_contexts = 4, ahead = 3;  // vertices that are prefetched
    using Model = LightModel<n_contexts>;

    void component(int32_t face) {
        for (int32_t c = 3 * face; c < 3 * face + 3; ++c) {
            const int32_t v = mesh_.vertex[static_cast<size_t>(c)];
            if (order_.known(v)) continue;
            order_.learn(v);
            code(v);
        }
        order_.enter(face);
        for (size_t n = batch_.size(); n == batch_.size();) {
            n = order_.next_vertices(batch_);
            for (size_t i = 0; i < n; ++i) {
                if (i + ahead < n) surveyor_.prefetch(batch_[i + ahead]);
                code(batch_[i].vertex);
            }
        }
    }

    void code(int32_t v) {
        int64_t* position = xyz_ + 3 * static_cast<size_t>(v);
        surveyor_.survey(v, s_);
        if (s_.n_neighbours == 0) {
            seeds_.code(coder_, position);
            surveyor_.settle(v, position, {});
            return;
        }
        predictor_.predict(s_);
        neighbour_agrees_ = {};
        tip_agrees_ = {};
        for (size_t turn = 0; turn < 3; ++turn) code_axis(turn, position);
        surveyor_.settle(v, position, predictor_.learn());
    }

    void code_axis(size_t turn, int64_t* position) {
        predictor_.expect(turn);
        const size_t d = predictor_.axis(turn);
        const int64_t base = predictor_.base();
        const int shift = std::max(0, (predictor_.level() - 12) / 2);
        const int64_t nearest = find_values(turn, d, base, shift);
        int64_t e = wrapping_difference(position[d], base);
        if (!values_.code(coder_, d, predictor_.level(), e))
            e = model_.code(coder_, d, contexts(turn, d, base, shift, nearest), predictor_.set(turn), shift, e);
        position[d] = wrapping_sum(base, e);
        const bool exact = values_.learn(e);
        residual_recall_.learn(key_, e);
        places_.learn(d, position[d]);
        (turn == 0 ? first_residual_ : second_residual_) = e;
        predictor_.reveal(turn, position[d], e, exact);
        if (turn < 2) count_agreements(d);
    }

    // Which points agree with the value on this axis.
    void count_agreements(size_t d) {
        const double value = predictor_.value(d);
        for (size_t i = 0; i < s_.n_kept(); ++i) neighbour_agrees_[i] += s_.neighbours[i][d] == value ? 1 : 0;
        for (size_t i = 0; i < s_.n_tips(); ++i) tip_agrees_[i] += s_.tips[i][d] == value ? 1 : 0;
    }

    // The least residual that would repeat a neighbour's value.
    int64_t find_values(size_t turn, size_t d, int64_t base, int shift) {
        const auto from = static_cast<double>(base);
        double nearest = s_.neighbours[0][d] - from, best = nearest;
        size_t most = neighbour_agrees_[0];
        for (size_t i = 1; i < s_.n_kept(); ++i) {
            const double off = s_.neighbours[i][d] - from;
            if (std::fabs(off) < std::fabs(nearest)) nearest = off;
            const size_t agrees = neighbour_agrees_[i];
            if (agrees > most || (agrees == most && std::fabs(off) < std::fabs(best))) {
                most = agrees;
                best = off;
            }
        }
        const size_t exact = std::min<size_t>(s_.exact >> (8 * d) & 255, 3);
        values_.clear();
        if (shift > 0) values_.add(predictor_.is_plain() ? LightValues::plain_base : LightValues::expected_base, turn, 0, exact, 0);
        values_.add(LightValues::neighbour, turn, agreement(turn, most), exact, static_cast<int64_t>(best));
        add_tip(turn, d, from, exact);
        add_recalled(turn, d, exact);
        places_.add_to(values_, turn, s_, predictor_);
        return static_cast<int64_t>(nearest);
    }

    // 0 at first, then 1, 2, 3 for none, some and all of the axes before.
    static size_t agreement(size_t turn, size_t n_agree) { return turn == 0 ? 0 : n_agree == 0 ? 1 : n_agree < turn ? 2 : 3; }

    void add_tip(size_t turn, size_t d, double from, size_t exact) {
        if (s_.n_parallelograms < 2) return;
        size_t best = 0;
        for (size_t i = 1; i < s_.n_tips(); ++i)
            if (tip_agrees_[i] > tip_agrees_[best]) best = i;
        values_.add(LightValues::tip, turn, agreement(turn, tip_agrees_[best]), exact, static_cast<int64_t>(s_.tips[best][d] - from));
    }

    void add_recalled(size_t turn, size_t d, size_t exact) {
        const auto low = [](int64_t x) { return static_cast<uint32_t>(x); };
        uint32_t h = s_.codes[0] * 0x9E3779B1u ^ s_.codes[1] * 0x85EBCA6Bu ^ static_cast<uint32_t>(4 * d + turn) * 0xC2B2AE35u;
        if (turn > 0) h += low(first_residual_) * 0x27D4EB2Fu;
        if (turn > 1) h += low(second_residual_) * 0x165667B1u;
        h = (h ^ h >> 15) * 0x85EBCA6Bu;
        key_ = h ^ h >> 13;
        const Recall::Entry* entry = residual_recall_.find(key_);
        if (entry != nullptr)
            values_.add(LightValues::recalled, turn, std::min<size_t>(entry->hits - 1, 3), exact, entry->value);
    }

    Model::Contexts contexts(size_t turn, size_t d, int64_t base, int shift, int64_t nearest) const {
        const double cell = std::bit_cast<double>(static_cast<uint64_t>(1023 - shift) << 52);  // 2^-shift
        const auto in_cells = [&](double x, float scale) {
            const auto off = static_cast<float>((x - static_cast<double>(base)) * cell);
            return static_cast<size_t>(clamp(off * scale + 7.5f, 0.0f, 14.0f));
        };
        const auto near = static_cast<size_t>(std::clamp<int64_t>(nearest >> shift, -7, 7) + 7);
        const size_t fraction = in_cells(predictor_.expected(), predictor_.is_plain() ? 2.0f : 4.0f);
        const auto wide = static_cast<size_t>(predictor_.wide(shift));
        const auto level = static_cast<size_t>(predictor_.level() - 2 * shift);  // <= 13
        const auto n = static_cast<size_t>(std::min(s_.n_parallelograms, 4));
        return {(d * 15 + near) * 15 + fraction, (turn * 18 + wide) * 5 + n, (d * 18 + level) * 18 + wide,
                (turn * 18 + level) * 15 + (predictor_.is_plain() ? 7 : in_cells(predictor_.plain(), 2.0f))};
    }

    Coder& coder_;
    const Surface& mesh_;
    GateOrder order_;
    std::array<PredictedVertex, 256> batch_;
    LightSurveyor surveyor_;
    LightSurroundings s_;
    LightPredictor predictor_;
    LightValues values_;
    Model model_;
    LightSeeds seeds_;
    LightPlaces places_;
    Recall residual_recall_{12};
    std::array<uint8_t, LightSurroundings::max_neighbours> neighbour_agrees_{};
    std::array<uint8_t, LightSurroundings::max_tips> tip_agrees_{};
    uint32_t key_ = 0;
    int64_t first_residual_ = 0, second_residual_ = 0;
    int64_t* xyz_;
};

template <class Coder>
void code_positions_light(Coder& coder, const Surface& mesh, std::span<int64_t> xyz) {
    std::make_unique<LightCoder<Coder>>(coder, mesh, xyz)->run();
}

std::vector<uint8_t> encode_light(const Surface& mesh, std::span<const int64_t> values) {
    // The shared path writes to each vertex what it read from it.
    std::vector<int64_t> copy(values.begin(), values.end());
    ans::Encoder<3> coder;
    code_positions_light(coder, mesh, copy);
    return coder.finish();
}

void decode_light(std::span<const uint8_t> bytes, const Surface& mesh, std::span<int64_t> values) {
    ans::Decoder<3> coder(bytes);
    code_positions_light(coder, mesh, values);
}

}  // namespace EBZ_INSTRUCTIONS
}  // namespace ebz::positions
