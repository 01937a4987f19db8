// What is known around a vertex before its position is coded by the light method.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "gate_order.hpp"
#include "int_lanes.hpp"
#include "site.hpp"
#include "surface.hpp"

namespace ebz::positions {
inline namespace EBZ_INSTRUCTIONS {

// Sums over the neighbours and the tips, which are the fourth corners of parallelograms.
template <class Unsigned>
struct LightSurroundings {
    using Position = typename Integers<Unsigned>::Lanes;
    static constexpr size_t max_neighbours = 8;

    Position first;           // the first tip, which the sums of positions are relative to
    Position second, latest;  // further tips, the first one if there is no other
    Lanes tips, neighbours;
    Lanes spread;             // from tip to tip
    Lanes ahead, normal;      // of the faces that predict
    Lanes drift, size;        // of the residuals, and of their magnitudes
    std::array<Position, max_neighbours> neighbour_at;
    size_t n_neighbours, n_tips;

    LightSurroundings() : neighbour_at{} {}  // GCC fails on an implicit one without optimisation

    size_t n_kept_neighbours() const { return std::min(n_neighbours, max_neighbours); }
};

template <class Unsigned>
class LightSurveyor {
public:
    using Surroundings = LightSurroundings<Unsigned>;
    using Position = typename Surroundings::Position;

    // sites: as many as the surface has vertices.
    LightSurveyor(const Surface& mesh, Site<Unsigned>* sites)
        : opposite_(mesh.opposite.data()), vertex_(mesh.vertex.data()), known_(static_cast<size_t>(mesh.n_vertices)), sites_(sites) {}

    bool known(int32_t v) const { return known_[static_cast<size_t>(v)] != 0; }
    Lanes residual(int32_t v) const { return std::bit_cast<Lanes>(sites_[v].residual); }
    Position at(int32_t v) const { return std::bit_cast<Position>(sites_[v].position); }

    void prefetch(const PredictedVertex& v) const {
        for (const int32_t u : {v.vertex, v.a, v.b, v.o, v.c, v.d, v.p}) __builtin_prefetch(&sites_[u]);
    }

    void settle(int32_t v, Position position, Lanes residual) {
        sites_[v] = {std::bit_cast<std::array<Unsigned, 4>>(position), std::bit_cast<std::array<float, 4>>(residual)};
        known_[static_cast<size_t>(v)] = 1;
    }

    // Both gates, and from the first one around the vertex as far as vertices are known.
    void survey(const PredictedVertex& from, Surroundings& s) const {
        s.first = s.second = s.latest = at(from.a) + at(from.b) - at(from.o);
        s.tips = s.neighbours = s.spread = s.ahead = s.normal = s.drift = s.size = Lanes{};
        s.n_neighbours = s.n_tips = 0;
        add_neighbour(s, from.a);
        add_neighbour(s, from.b);
        add_tip(s, from.a, from.b, from.o);
        bool met_second = from.gate == from.second;
        if (!turn<true>(s, from, met_second)) return;
        turn<false>(s, from, met_second);
        if (met_second) return;
        add_neighbour(s, from.c);
        add_neighbour(s, from.d);
        add_tip(s, from.c, from.d, from.p);
    }

private:
    static constexpr size_t max_turns = 6;  // to either side

    // From gate to gate of the vertex, to one side.  False if that went all around.
    template <bool left>
    bool turn(Surroundings& s, const PredictedVertex& from, bool& met_second) const {
        int32_t gate = from.gate;
        for (size_t n = 0; n < max_turns; ++n) {
            const int32_t across = opposite_[left ? next(gate) : previous(gate)];
            if (across < 0) break;
            gate = left ? next(across) : previous(across);
            if (gate == from.gate) return false;
            const int32_t a = vertex_[gate], b = vertex_[next(gate)], u = left ? b : a;
            if (!known(u)) break;
            met_second |= gate == from.second;
            add_neighbour(s, u);
            if (opposite_[gate] < 0) continue;
            const int32_t o = vertex_[previous(opposite_[gate])];
            if (known(o)) add_tip(s, a, b, o);
        }
        return true;
    }

    void add_neighbour(Surroundings& s, int32_t u) const {
        const Position position = at(u);
        const Lanes r = residual(u);
        s.neighbours += as_floats(position - s.first);
        s.drift += r;
        s.size += magnitudes(r);
        s.neighbour_at[s.n_neighbours++ % s.max_neighbours] = position;
    }

    void add_tip(Surroundings& s, int32_t a, int32_t b, int32_t o) const {
        constexpr float scale = 0x1p-20f;  // so that fourth powers are within floats
        const Position origin = at(o), u = at(a) - origin, w = at(b) - origin, tip = origin + u + w;
        s.spread += magnitudes(as_floats(tip - s.latest));
        s.tips += as_floats(tip - s.first);
        s.ahead += as_floats(u + w);
        s.normal += cross(as_floats(u) * scale, as_floats(w) * scale);
        s.latest = tip;
        if (++s.n_tips == 2) s.second = tip;
    }

    const int32_t *opposite_, *vertex_;
    std::vector<uint8_t> known_;
    Site<Unsigned>* sites_;
};

}  // namespace EBZ_INSTRUCTIONS
}  // namespace ebz::positions
