// Lattice values along a surface, and of points without one.
#include <memory>
#include <span>
#include <tuple>
#include <vector>

#include "../points/octree.hpp"
#include "../positions/fast.hpp"
#include "../positions/medium.hpp"
#include "../positions/positions.hpp"
#include "arrays.hpp"
#include "modules.hpp"

namespace ebz::binding {

namespace {

nb::bytes encode_positions(const Input<int32_t>& opposite, const Input<int32_t>& vertex, int32_t n_vertices,
                           const Input<int64_t>& values, int method) {
    const ebz::positions::Surface surface{view(opposite), view(vertex), n_vertices};
    return to_bytes(without_gil([&] {
        return ebz::positions::encode(surface, view(values), static_cast<ebz::positions::Method>(method));
    }));
}

Array<int64_t> decode_positions(const Stream& bytes, const Input<int32_t>& opposite,
                                const Input<int32_t>& vertex, int32_t n_vertices, int method) {
    const ebz::positions::Surface surface{view(opposite), view(vertex), n_vertices};
    return to_numpy(without_gil([&] {
        std::vector<int64_t> values(static_cast<size_t>(n_vertices) * 3);
        ebz::positions::decode(view(bytes), surface, static_cast<ebz::positions::Method>(method), values);
        return values;
    }));
}

// The memory of the coder itself: a position begins each of its rows.
template <class Row, void (*decode)(std::span<const uint8_t>, const ebz::positions::Surface&, std::span<Row>)>
ArrayOfRows<int32_t> decode_positions_in_place(const Stream& bytes, const Input<int32_t>& opposite,
                                               const Input<int32_t>& vertex, int32_t n_vertices) {
    const ebz::positions::Surface surface{view(opposite), view(vertex), n_vertices};
    const auto n = static_cast<size_t>(n_vertices);
    auto rows = std::make_unique_for_overwrite<Row[]>(n);
    without_gil([&] { decode(view(bytes), surface, {rows.get(), n}); });
    Row* const owned = rows.release();
    nb::capsule owner(owned, [](void* p) noexcept { delete[] static_cast<Row*>(p); });
    return {owned, {n, 3}, owner, {sizeof(Row) / sizeof(int32_t), 1}};
}

std::tuple<nb::bytes, Array<int32_t>> encode_points(const Input<int64_t>& values) {
    ebz::points::Encoded encoded = without_gil([&] { return ebz::points::encode(view(values)); });
    return {to_bytes(encoded.bytes), to_numpy(std::move(encoded.order))};
}

Array<int64_t> decode_points(const Stream& bytes, int32_t n) {
    return to_numpy(without_gil([&] { return ebz::points::decode(view(bytes), static_cast<size_t>(n)); }));
}

}  // namespace

void bind_positions(nb::module_& m) {
    m.def("encode_positions", &encode_positions, "opposite"_a, "vertex"_a, "n_vertices"_a, "values"_a,
          "method"_a, "The bytes of 3n lattice values along a surface.");
    m.def("decode_positions", &decode_positions, "data"_a, "opposite"_a, "vertex"_a, "n_vertices"_a,
          "method"_a, "The 3n lattice values of another method.");
    m.def("decode_positions_fast",
          &decode_positions_in_place<ebz::positions::FastVertex, ebz::positions::decode_positions_fast>, "data"_a,
          "opposite"_a, "vertex"_a, "n_vertices"_a, "The (n, 3) lattice values of the fast method.");
    m.def("decode_positions_medium",
          &decode_positions_in_place<ebz::positions::MediumSite, ebz::positions::decode_positions_medium>, "data"_a,
          "opposite"_a, "vertex"_a, "n_vertices"_a, "The (n, 3) lattice values of the medium method.");
    m.def("encode_points", &encode_points, "values"_a,
          "The bytes of a set of points, 3n lattice values, and where those decoded come from.");
    m.def("decode_points", &decode_points, "data"_a, "n"_a, "The 3n lattice values.");
}

}  // namespace ebz::binding
