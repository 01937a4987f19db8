// The medium method: vertices in the order of gates, from one or two parallelograms, in integers of 32 bits.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "int_lanes.hpp"
#include "medium.hpp"
#include "medium_model.hpp"
#include "gate_order.hpp"
#include "surface.hpp"
#include "two_part_stream.hpp"

namespace ebz::positions {
inline namespace EBZ_INSTRUCTIONS {

template <class Coder>
class MediumCoder {
public:
    // sites: as many as the surface has vertices.
    MediumCoder(Coder& coder, const Surface& mesh, MediumSite* sites)
        : coder_(coder), mesh_(mesh), vertex_(mesh.vertex.data()), order_(mesh), sites_(sites) {}

    void run() {
        const auto n_faces = static_cast<int32_t>(mesh_.vertex.size() / 3);
        for (int32_t t = 0; t < n_faces; ++t)
            if (!order_.visited(t)) component(t);
        for (int32_t v = 0; v < mesh_.n_vertices; ++v)
            if (!order_.known(v)) step_to(v, 0);
    }

private:
    static constexpr size_t ahead = 8;  // sites that are prefetched

    void component(int32_t face) {
        size_t kind = 0;
        for (int32_t c = 3 * face; c < 3 * face + 3; ++c, kind = 1) {
            if (order_.known(vertex_[c])) latest_ = at(vertex_[c]);
            else step_to(vertex_[c], kind);
        }
        order_.enter(face);
        for (size_t n = batch_.size(); n == batch_.size();) {
            n = order_.next_vertices(batch_);
            for (size_t i = 0; i < n; ++i) {
                if (i + ahead < n) __builtin_prefetch(&sites_[batch_[i + ahead].vertex], 1);
                predict(batch_[i]);
            }
        }
    }

    // From the vertex before, without a parallelogram.
    void step_to(int32_t v, size_t kind) {
        const UintLanes e = model_.code_step(coder_, kind, steps_[kind], to_be_coded(v, latest_));
        latest_ += e;
        settle(v, latest_, Lanes{});
        steps_[kind] = magnitudes(as_floats(e));
        order_.learn(v);
    }

    void predict(const PredictedVertex& from) {
        const UintLanes a = at(from.a), b = at(from.b), c = at(from.c), d = at(from.d);
        const UintLanes first = a + b - at(from.o), apart = c + d - at(from.p) - first;
        const UintLanes plain = first + as_uints(as_ints(apart) >> 1);
        const Lanes off = as_floats(apart);
        const Lanes smooth = off * 0.3f + as_floats(a + b + c + d - (first << 2)) * 0.1f;  // within 31 bits
        const IntLanes is_plain = lead_ <= 0.0f;
        const UintLanes base = choose(is_plain, plain, first + as_uints(rounded(smooth)));
        const Lanes ra = residual(from.a), rb = residual(from.b), rc = residual(from.c), rd = residual(from.d);
        const Lanes size = ((magnitudes(ra) + magnitudes(rb)) + (magnitudes(rc) + magnitudes(rd))) * 0.25f;
        const Lanes spread = from.two() ? magnitudes(off) : size;
        const Lanes fraction = (smooth - as_floats(base - first)) * (is_plain ? splat<Lanes>(2.0f) : splat<Lanes>(4.0f));
        const UintLanes near = nearer(nearer(a - base, b - base), nearer(c - base, d - base));
        const Lanes drift = ((ra + rb) + (rc + rd)) * 0.25f;
        const Lanes scale = size * 0.6f + spread * 0.25f;
        const MediumModel::Circumstances known = {scale, spread, drift, fraction, near, from.two() ? 1 : 0};
        const UintLanes e = model_.code(coder_, known, to_be_coded(from.vertex, base));
        const UintLanes x = base + e;
        settle(from.vertex, x, as_floats(e));
        const Lanes from_plain = magnitudes(as_floats(x - plain)), from_smooth = magnitudes(as_floats(x - first) - smooth);
        lead_ += (bit_patterns(from_plain + 1.0f) - bit_patterns(from_smooth + 1.0f) - lead_) * 0.01f;
    }

    UintLanes at(int32_t v) const { return std::bit_cast<UintLanes>(sites_[v].position); }
    Lanes residual(int32_t v) const { return std::bit_cast<Lanes>(sites_[v].residual); }

    // Sites to be decoded hold nothing yet.
    UintLanes to_be_coded(int32_t v, UintLanes base) const {
        if constexpr (Coder::encoding) return at(v) - base;
        else return UintLanes{};
    }

    void settle(int32_t v, UintLanes position, Lanes residual) {
        sites_[v] = {std::bit_cast<std::array<uint32_t, 4>>(position), std::bit_cast<std::array<float, 4>>(residual)};
    }

    static UintLanes nearer(UintLanes x, UintLanes y) { return choose(magnitudes(as_floats(y)) < magnitudes(as_floats(x)), y, x); }

    Coder& coder_;
    const Surface& mesh_;
    const int32_t* vertex_;
    GateOrder order_;
    std::array<PredictedVertex, 256> batch_;  // found together, so that order and coding do not wait for each other
    MediumSite* sites_;
    UintLanes latest_{};
    std::array<Lanes, 2> steps_{};
    Lanes lead_{};  // of the smooth prediction over the plain one
    MediumModel model_;
};

template <class Coder>
void code_positions_medium(Coder& coder, const Surface& mesh, MediumSite* sites) {
    std::make_unique<MediumCoder<Coder>>(coder, mesh, sites)->run();
}

std::vector<uint8_t> encode_medium(const Surface& mesh, std::span<const int64_t> values) {
    const auto sites = std::make_unique_for_overwrite<MediumSite[]>(values.size() / 3);
    bool fits = true;
    for (size_t v = 0; v < values.size() / 3; ++v) {
        for (size_t d = 0; d < 3; ++d) {
            const auto value = static_cast<int32_t>(values[3 * v + d]);
            fits &= value == values[3 * v + d];
            sites[v].position[d] = static_cast<uint32_t>(value);
        }
        sites[v].position[3] = 0;
    }
    if (!fits) return {};
    TwoPartEncoder coder(values.size() + values.size() / 8);
    code_positions_medium(coder, mesh, sites.get());
    return coder.finish();
}

void decode_medium(std::span<const uint8_t> bytes, const Surface& mesh, std::span<MediumSite> sites) {
    TwoPartDecoder coder(bytes);
    code_positions_medium(coder, mesh, sites.data());
}

}  // namespace EBZ_INSTRUCTIONS
}  // namespace ebz::positions
