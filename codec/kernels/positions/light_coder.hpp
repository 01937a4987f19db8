// The light method: vertices in the order of gates, axis by axis, one symbol each.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "axis_order.hpp"
#include "gate_order.hpp"
#include "int_lanes.hpp"
#include "light.hpp"
#include "light_model.hpp"
#include "light_predictor.hpp"
#include "light_recalls.hpp"
#include "light_steps.hpp"
#include "light_survey.hpp"
#include "surface.hpp"
#include "two_part_stream.hpp"

namespace ebz::positions {
inline namespace EBZ_INSTRUCTIONS {

// Where axes are ordered by the normal, coordinates slide along tangent planes; else they are recalled.
template <class Coder, class Unsigned>
class LightCoder {
public:
    // sites: as many as the surface has vertices.
    LightCoder(Coder& coder, const Surface& mesh, AxisOrder axes, Site<Unsigned>* sites)
        : coder_(coder), mesh_(mesh), vertex_(mesh.vertex.data()), axes_(axes), order_(mesh), surveyor_(mesh, sites),
          recalls_(axes.is_fixed() ? std::make_unique<LightRecalls<Unsigned>>(mesh, axes.last, surveyor_) : nullptr) {}

    void run() {
        const auto n_faces = static_cast<int32_t>(mesh_.vertex.size() / 3);
        for (int32_t t = 0; t < n_faces; ++t)
            if (!order_.visited(t)) component(t);
        for (int32_t v = 0; v < mesh_.n_vertices; ++v)
            if (!order_.known(v)) step_to(v, 0);
    }

private:
    using Signed = std::make_signed_t<Unsigned>;
    using Position = typename Integers<Unsigned>::Lanes;
    using Predictor = LightPredictor<Unsigned>;
    static constexpr size_t ahead = 4;  // vertices that are prefetched

    void component(int32_t face) {
        for (int32_t c = 3 * face; c < 3 * face + 3; ++c) {
            if (order_.known(vertex_[c])) latest_ = surveyor_.at(vertex_[c]);
            else step_to(vertex_[c], c == 3 * face ? 0 : 1);
        }
        order_.enter(face);
        for (size_t n = batch_.size(); n == batch_.size();) {
            n = order_.next_vertices(batch_);
            for (size_t i = 0; i < n; ++i) {
                if (i + ahead < n) surveyor_.prefetch(batch_[i + ahead]);
                code(batch_[i]);
            }
        }
    }

    // From the vertex before, without a parallelogram.
    void step_to(int32_t v, size_t kind) {
        const Position e = to_be_coded(v) - latest_;
        for (size_t d = 0; d < 3; ++d)
            latest_[d] += static_cast<Unsigned>(steps_[kind].code(coder_, d, int64_t{static_cast<Signed>(e[d])}));
        surveyor_.settle(v, latest_, Lanes{});
        order_.learn(v);
    }

    void code(const PredictedVertex& from) {
        Position wanted = to_be_coded(from.vertex);
        if (recalls_ && recalls_->tell(coder_.symbols, from, wanted)) {
            surveyor_.settle(from.vertex, wanted, surveyor_.residual(recalls_->twin()));
            return recalls_->learn(from, wanted);
        }
        surveyor_.survey(from, s_);
        predictor_.predict(s_, !axes_.is_fixed());
        predictor_.expect(x_);
        if (recalls_) recalls_->start(s_);
        const std::array<size_t, 3> axes = AxisOrder::ending_with(predictor_.last(axes_.is_fixed() ? axes_.last : 2));
        Position position{}, residuals{};
        for (size_t turn = 0; turn < 3; ++turn) {
            if (turn == 2 && predictor_.slide(position)) predictor_.expect(x_);
            const size_t d = axes[turn];
            residuals[d] = static_cast<Unsigned>(code_axis(turn, d, static_cast<Signed>(wanted[d] - x_.base[d])));
            position[d] = x_.base[d] + residuals[d];
        }
        predictor_.learn(position);
        if (recalls_) recalls_->learn(from, position);
        surveyor_.settle(from.vertex, position, as_floats(residuals));
    }

    Signed code_axis(size_t turn, size_t d, Signed e) {
        if (!recalls_) return code_symbol(turn, d, e);
        if (!recalls_->code(coder_.symbols, d, x_, e)) e = code_symbol(turn, d, e);
        recalls_->reveal(d, e, x_.base[d] + static_cast<Unsigned>(e));
        return e;
    }

    Signed code_symbol(size_t turn, size_t d, Signed e) {
        return static_cast<Signed>(model_.code(coder_, d, contexts(turn, d), 5 * turn + std::min<size_t>(s_.n_tips, 4), x_.shift[d], int64_t{e}));
    }

    LightModel::Contexts contexts(size_t turn, size_t d) const {
        constexpr size_t places = Predictor::n_places, levels = Predictor::n_levels, spreads = Predictor::n_spreads;
        const auto of = [d](const auto& all) { return static_cast<size_t>(all[d]); };
        return {(d * places + of(x_.near)) * places + of(x_.fraction), (turn * spreads + of(x_.spread)) * 5 + std::min<size_t>(s_.n_tips, 4),
                (d * levels + of(x_.level)) * spreads + of(x_.spread), (turn * levels + of(x_.level)) * places + of(x_.tip)};
    }

    // Sites to be decoded hold nothing yet.
    Position to_be_coded(int32_t v) const {
        if constexpr (Coder::encoding) return surveyor_.at(v);
        else return Position{};
    }

    Coder& coder_;
    const Surface& mesh_;
    const int32_t* vertex_;
    AxisOrder axes_;
    GateOrder order_;
    std::array<PredictedVertex, 256> batch_;  // found together, so that order and coding do not wait for each other
    LightSurveyor<Unsigned> surveyor_;
    LightSurroundings<Unsigned> s_;
    Predictor predictor_;
    LightExpectation<Unsigned> x_;
    std::unique_ptr<LightRecalls<Unsigned>> recalls_;  // none where coordinates slide
    LightModel model_;
    Position latest_{};
    std::array<LightSteps, 2> steps_;  // to components, within their first faces
};

// In the first byte, beside the order of axes: coordinates have 64 bits.
inline constexpr uint8_t is_wide = 4;

template <class Unsigned, class Coder>
void code_positions_light(Coder& coder, const Surface& mesh, AxisOrder axes, Site<Unsigned>* sites) {
    std::make_unique<LightCoder<Coder, Unsigned>>(coder, mesh, axes, sites)->run();
}

template <class Unsigned>
std::vector<uint8_t> encode_light(const Surface& mesh, std::span<const int64_t> values, AxisOrder axes) {
    const size_t n = values.size() / 3;
    const auto sites = std::make_unique_for_overwrite<Site<Unsigned>[]>(n);
    for (size_t v = 0; v < n; ++v) {
        for (size_t d = 0; d < 3; ++d) sites[v].position[d] = static_cast<Unsigned>(values[3 * v + d]);
        sites[v].position[3] = 0;
    }
    TwoPartEncoder coder(values.size() + values.size() / 2);
    code_positions_light(coder, mesh, axes, sites.get());
    const std::vector<uint8_t> coded = coder.finish();
    std::vector<uint8_t> bytes = {static_cast<uint8_t>(axes.last | (sizeof(Unsigned) == sizeof(uint64_t) ? is_wide : 0))};
    bytes.insert(bytes.end(), coded.begin(), coded.end());
    return bytes;
}

template <class Unsigned>
void decode_light(std::span<const uint8_t> bytes, const Surface& mesh, AxisOrder axes, std::span<int64_t> values) {
    const size_t n = values.size() / 3;
    const auto sites = std::make_unique_for_overwrite<Site<Unsigned>[]>(n);
    TwoPartDecoder coder(bytes);
    code_positions_light(coder, mesh, axes, sites.get());
    for (size_t v = 0; v < n; ++v)
        for (size_t d = 0; d < 3; ++d) values[3 * v + d] = int64_t{static_cast<std::make_signed_t<Unsigned>>(sites[v].position[d])};
}

std::vector<uint8_t> encode_light(const Surface& mesh, std::span<const int64_t> values) {
    const auto fits = [](int64_t x) { return x == static_cast<int32_t>(x); };
    const bool narrow = std::all_of(values.begin(), values.end(), fits);
    std::vector<uint8_t> shortest;
    for (const AxisOrder axes : axis_orders(mesh, values)) {
        std::vector<uint8_t> bytes = narrow ? encode_light<uint32_t>(mesh, values, axes) : encode_light<uint64_t>(mesh, values, axes);
        if (shortest.empty() || bytes.size() < shortest.size()) shortest = std::move(bytes);
    }
    return shortest;
}

void decode_light(std::span<const uint8_t> bytes, const Surface& mesh, std::span<int64_t> values) {
    if (bytes.empty()) return;
    const AxisOrder axes = AxisOrder::of(bytes[0]);
    const bool wide = (bytes[0] & is_wide) != 0;
    wide ? decode_light<uint64_t>(bytes.subspan(1), mesh, axes, values) : decode_light<uint32_t>(bytes.subspan(1), mesh, axes, values);
}

}  // namespace EBZ_INSTRUCTIONS
}  // namespace ebz::positions
