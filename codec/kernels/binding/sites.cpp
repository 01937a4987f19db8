// Which corners of the pieces are one site, and which vertices of the mesh a site has.
#include "../surface/gluing.hpp"
#include "../surface/splits.hpp"
#include "../surface/topology.hpp"
#include "../surface/weld.hpp"
#include "arrays.hpp"
#include "modules.hpp"

namespace ebz::binding {

namespace {

nb::bytes encode_gluing(const Input<int32_t>& opposite, const Input<int32_t>& vertex, int32_t n_copies,
                        const Input<int32_t>& site) {
    return to_bytes(without_gil([&] {
        const auto n_vertices = static_cast<int32_t>(site.size());
        return ebz::encode_gluing({view(opposite), view(vertex), n_vertices, n_copies}, view(site));
    }));
}

Array<int32_t> decode_gluing(const Stream& bytes, const Input<int32_t>& opposite,
                             const Input<int32_t>& vertex, int32_t n_vertices, int32_t n_copies) {
    return to_numpy(without_gil([&] {
        return ebz::decode_gluing(view(bytes), {view(opposite), view(vertex), n_vertices, n_copies});
    }));
}

Array<int32_t> glue(const Input<int32_t>& vertex, const Input<int32_t>& site) {
    return to_numpy(without_gil([&] { return ebz::glue(view(vertex), view(site)); }));
}

ebz::FannedPoints fanned(const Input<int32_t>& opposite, const Input<int32_t>& fan, const Input<int32_t>& point,
                         const Input<int32_t>& point_of_fan, int32_t n_points) {
    return {view(opposite), view(fan), view(point), view(point_of_fan), n_points};
}

std::tuple<nb::bytes, Array<int32_t>, Array<int32_t>, Array<int32_t>> encode_splits(
    const Input<int32_t>& opposite, const Input<int32_t>& fan, const Input<int32_t>& point,
    const Input<int32_t>& point_of_fan, int32_t n_points, const Input<int32_t>& label) {
    ebz::EncodedSplits encoded = without_gil(
        [&] { return ebz::encode_splits(fanned(opposite, fan, point, point_of_fan, n_points), view(label)); });
    return {to_bytes(encoded.bytes), to_numpy(std::move(encoded.splits.vertex)),
            to_numpy(std::move(encoded.splits.point)), to_numpy(std::move(encoded.label))};
}

std::tuple<Array<int32_t>, Array<int32_t>> decode_splits(const Stream& bytes, const Input<int32_t>& opposite,
                                                         const Input<int32_t>& fan, const Input<int32_t>& point,
                                                         const Input<int32_t>& point_of_fan, int32_t n_points) {
    ebz::Splits decoded = without_gil(
        [&] { return ebz::decode_splits(view(bytes), fanned(opposite, fan, point, point_of_fan, n_points)); });
    return {to_numpy(std::move(decoded.vertex)), to_numpy(std::move(decoded.point))};
}

std::tuple<Array<int32_t>, Array<int32_t>> fans_at_points(const Input<int32_t>& opposite, const Input<int32_t>& point) {
    ebz::FansAtPoints fans = without_gil([&] { return ebz::fans_at_points(view(opposite), view(point)); });
    return {to_numpy(std::move(fans.fan)), to_numpy(std::move(fans.point_of_fan))};
}

template <class Bits>
Array<int32_t> weld(const Input<int32_t>& faces, const Input<int32_t>& offsets, const Input<Bits>& positions) {
    require_addressable(positions.size());
    if (offsets.size() > 0) {
        return to_numpy(without_gil(
            [&] { return ebz::weld(ebz::PolygonFaces(view(faces), view(offsets)), view(positions)); }));
    }
    return to_numpy(without_gil([&] { return ebz::weld(ebz::TriangleFaces(view(faces)), view(positions)); }));
}

std::tuple<Array<int32_t>, Array<int32_t>> number_by_first_use(const Input<int32_t>& entries, int32_t n_items) {
    ebz::Numbered numbered = without_gil([&] { return ebz::number_by_first_use(view(entries), n_items); });
    return {to_numpy(std::move(numbered.number)), to_numpy(std::move(numbered.items))};
}

std::tuple<int32_t, int32_t, int32_t, int32_t> describe(const Input<int32_t>& opposite) {
    const ebz::Topology topology = without_gil([&] { return ebz::describe(view(opposite)); });
    return std::make_tuple(topology.n_components, topology.n_boundary_loops, topology.n_boundary_edges,
                          topology.n_edges);
}

}  // namespace

void bind_sites(nb::module_& m) {
    m.def("encode_gluing", &encode_gluing, "opposite"_a, "vertex"_a, "n_copies"_a, "site"_a,
          "Which vertices of the pieces are one site; site: of each, numbered by first use.");
    m.def("decode_gluing", &decode_gluing, "data"_a, "opposite"_a, "vertex"_a, "n_vertices"_a, "n_copies"_a,
          "The site of each vertex of the pieces.");
    m.def("glue", &glue, "vertex"_a, "site"_a, "The site of each corner.");
    m.def("encode_splits", &encode_splits, "opposite"_a, "fan"_a, "point"_a, "point_of_fan"_a, "n_points"_a,
          "label"_a, "Which corners at each point belong to which vertex; what decoding yields; the label of each vertex.");
    m.def("decode_splits", &decode_splits, "data"_a, "opposite"_a, "fan"_a, "point"_a, "point_of_fan"_a, "n_points"_a,
          "The vertex of each corner, and the point of each vertex beyond the first n_points.");
    m.def("fans_at_points", &fans_at_points, "opposite"_a, "point"_a,
          "The fan of each corner, and the point of each fan.");
    m.def("weld", &weld<int32_t>, "faces"_a, "offsets"_a, "positions"_a);
    m.def("weld", &weld<int64_t>, "faces"_a, "offsets"_a, "positions"_a,
          "For each vertex the first that stands for it, empty if nothing is welded; no offsets: triangles.");
    m.def("number_by_first_use", &number_by_first_use, "entries"_a, "n_items"_a,
          "The number of each entry's item, and the items by number.");
    m.def("describe", &describe, "opposite"_a,
          "Numbers of components, boundary loops, boundary edges and edges of a surface.");
}

}  // namespace ebz::binding
