// The medium method: vertices in order of traversal, axis by axis, one symbol each.
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
#include "medium.hpp"
#include "light_model.hpp"
#include "medium_predictor.hpp"
#include "medium_survey.hpp"
#include "light_values.hpp"
#include "surface.hpp"
#include "traversal.hpp"
#include "wrapping.hpp"

namespace ebz::positions {
inline namespace EBZ_INSTRUCTIONS {

template <class Coder>
class MediumCoder {
public:
    MediumCoder(Coder& coder, const Surface& mesh, std::span<int64_t> xyz)
        : coder_(coder), corners_(mesh), traversal_(mesh, corners_), surveyor_(mesh, corners_, traversal_), xyz_(xyz.data()) {}

    void run() {
        for (int32_t v; (v = traversal_.next_vertex()) >= 0;) {
            int64_t* position = xyz_ + 3 * static_cast<size_t>(v);
            surveyor_.survey(v, s_);
            if (s_.n_neighbours == 0) {
                seeds_.code(coder_, position);
                surveyor_.settle(v, position, {});
                continue;
            }
            predictor_.predict(s_);
            neighbour_agrees_ = {};
            for (size_t turn = 0; turn < 3; ++turn) code_axis(turn, position);
            surveyor_.settle(v, position, predictor_.learn());
        }
    }

private:
    static constexpr size_t n_contexts = 3;
    using Model = LightModel<n_contexts>;

    void code_axis(size_t turn, int64_t* position) {
        predictor_.expect(turn);
        const size_t d = predictor_.axis(turn);
        const int64_t base = predictor_.base();
        const int shift = std::max(0, (predictor_.level() - 12) / 2);
        const int64_t nearest = find_values(turn, d, base, shift);
        int64_t e = wrapping_difference(position[d], base);
        if (!values_.code(coder_, d, shift == 0, e))
            e = model_.code(coder_, d, contexts(turn, d, base, shift, nearest), predictor_.set(turn), shift, e);
        position[d] = wrapping_sum(base, e);
        const bool exact = values_.learn(e);
        predictor_.reveal(turn, position[d], e, exact);
        if (turn < 2) count_agreements(d);
    }

    // Which points agree with the value on this axis.
    void count_agreements(size_t d) {
        const double value = predictor_.value(d);
        for (size_t i = 0; i < s_.n_kept(); ++i) neighbour_agrees_[i] += s_.neighbours[i][d] == value ? 1 : 0;
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
        values_.clear();
        if (shift > 0) values_.add(predictor_.is_plain() ? LightValues::plain_base : LightValues::expected_base, turn, 0, 0, 0);
        values_.add(LightValues::neighbour, turn, agreement(turn, most), 0, static_cast<int64_t>(best));
        return static_cast<int64_t>(nearest);
    }

    // 0 at first, then 1, 2, 3 for none, some and all of the axes before.
    static size_t agreement(size_t turn, size_t n_agree) { return turn == 0 ? 0 : n_agree == 0 ? 1 : n_agree < turn ? 2 : 3; }

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
        typename Model::Contexts x{(d * 15 + near) * 15 + fraction, (turn * 18 + wide) * 5 + n, (d * 18 + level) * 18 + wide};
        return x;
    }

    Coder& coder_;
    const CornersOfVertices corners_;
    Traversal traversal_;
    MediumSurveyor surveyor_;
    MediumSurroundings s_;
    MediumPredictor predictor_;
    LightValues values_;
    Model model_;
    LightSeeds seeds_;
    std::array<uint8_t, MediumSurroundings::max_neighbours> neighbour_agrees_{};
    int64_t* xyz_;
};

template <class Coder>
void code_positions_medium(Coder& coder, const Surface& mesh, std::span<int64_t> xyz) {
    std::make_unique<MediumCoder<Coder>>(coder, mesh, xyz)->run();
}

std::vector<uint8_t> encode_medium(const Surface& mesh, std::span<const int64_t> values) {
    // The shared path writes to each vertex what it read from it.
    std::vector<int64_t> copy(values.begin(), values.end());
    ans::Encoder<3> coder;
    code_positions_medium(coder, mesh, copy);
    return coder.finish();
}

void decode_medium(std::span<const uint8_t> bytes, const Surface& mesh, std::span<int64_t> values) {
    ans::Decoder<3> coder(bytes);
    code_positions_medium(coder, mesh, values);
}

}  // namespace EBZ_INSTRUCTIONS
}  // namespace ebz::positions
