// The order of the source: permutations along what has been decoded.
#include "../order/permutations.hpp"
#include "arrays.hpp"
#include "modules.hpp"

namespace ebz::binding {

namespace {

// What the order of the source is predicted from; the arrays must stay.
ebz::order::Geometry geometry(const Input<int32_t>& opposite, const Input<int32_t>& vertex,
                       const Input<int64_t>& positions) {
    return {{view(opposite), view(vertex), static_cast<int32_t>(positions.size() / 3)}, view(positions)};
}

nb::bytes encode_vertex_order(const Input<int32_t>& opposite, const Input<int32_t>& vertex,
                              const Input<int64_t>& positions, const Input<int32_t>& visits, bool uniform,
                              const Input<int32_t>& source) {
    const ebz::order::Geometry known = geometry(opposite, vertex, positions);
    return to_bytes(
        without_gil([&] { return ebz::order::encode_vertex_order(known, {view(visits)}, uniform, view(source)); }));
}

Array<int32_t> decode_vertex_order(const Stream& bytes, const Input<int32_t>& opposite,
                                   const Input<int32_t>& vertex, const Input<int64_t>& positions,
                                   const Input<int32_t>& visits, bool uniform) {
    const ebz::order::Geometry known = geometry(opposite, vertex, positions);
    return to_numpy(
        without_gil([&] { return ebz::order::decode_vertex_order(view(bytes), known, {view(visits)}, uniform); }));
}

// Runs `code` with the faces that the order of the source is about; no offsets: triangles.
template <class Code>
auto with_faces(const Input<int32_t>& offsets, const Input<int32_t>& opposite, const Input<int32_t>& vertex,
                const Input<int64_t>& positions, Code code) {
    return without_gil([&] {
        const auto run = [&](const auto& faces) {
            return code(ebz::order::FaceGeometry<std::decay_t<decltype(faces)>>{faces, view(opposite), view(positions)});
        };
        return offsets.size() == 0 ? run(ebz::TriangleFaces(view(vertex)))
                                   : run(ebz::PolygonFaces(view(vertex), view(offsets)));
    });
}

nb::bytes encode_face_order(const Input<int32_t>& offsets, const Input<int32_t>& opposite,
                            const Input<int32_t>& vertex, const Input<int64_t>& positions,
                            const Input<int32_t>& vertex_source, bool uniform, const Input<int32_t>& source) {
    return to_bytes(with_faces(offsets, opposite, vertex, positions, [&](const auto& known) {
        return ebz::order::encode_face_order(known, view(vertex_source), uniform, view(source));
    }));
}

Array<int32_t> decode_face_order(const Stream& bytes, const Input<int32_t>& offsets,
                                 const Input<int32_t>& opposite, const Input<int32_t>& vertex,
                                 const Input<int64_t>& positions, const Input<int32_t>& vertex_source,
                                 bool uniform) {
    return to_numpy(with_faces(offsets, opposite, vertex, positions, [&](const auto& known) {
        return ebz::order::decode_face_order(view(bytes), known, view(vertex_source), uniform);
    }));
}

nb::bytes encode_rotations(const Input<int32_t>& offsets, const Input<int32_t>& opposite,
                           const Input<int32_t>& vertex, const Input<int64_t>& positions,
                           const Input<int32_t>& face_source, const Input<int32_t>& vertex_source, bool uniform,
                           const Input<int32_t>& rotations) {
    return to_bytes(with_faces(offsets, opposite, vertex, positions, [&](const auto& known) {
        return ebz::order::encode_rotations(known, view(face_source), view(vertex_source), uniform, view(rotations));
    }));
}

Array<int32_t> decode_rotations(const Stream& bytes, const Input<int32_t>& offsets,
                                const Input<int32_t>& opposite, const Input<int32_t>& vertex,
                                const Input<int64_t>& positions, const Input<int32_t>& face_source,
                                const Input<int32_t>& vertex_source, bool uniform) {
    return to_numpy(with_faces(offsets, opposite, vertex, positions, [&](const auto& known) {
        return ebz::order::decode_rotations(view(bytes), known, view(face_source), view(vertex_source), uniform);
    }));
}

}  // namespace

void bind_orders(nb::module_& m) {
    m.def("encode_vertex_order", &encode_vertex_order, "opposite"_a, "vertex"_a, "positions"_a, "visits"_a,
          "uniform"_a, "source"_a, "The bytes of each vertex's index in the source.");
    m.def("decode_vertex_order", &decode_vertex_order, "data"_a, "opposite"_a, "vertex"_a, "positions"_a,
          "visits"_a, "uniform"_a, "The indices, a permutation.");
    m.def("encode_face_order", &encode_face_order, "offsets"_a, "opposite"_a, "vertex"_a, "positions"_a,
          "vertex_source"_a, "uniform"_a, "source"_a, "The bytes of each face's index in the source.");
    m.def("decode_face_order", &decode_face_order, "data"_a, "offsets"_a, "opposite"_a, "vertex"_a, "positions"_a,
          "vertex_source"_a, "uniform"_a, "The indices, a permutation.");
    m.def("encode_rotations", &encode_rotations, "offsets"_a, "opposite"_a, "vertex"_a, "positions"_a, "face_source"_a,
          "vertex_source"_a, "uniform"_a, "rotations"_a,
          "The bytes of which corner of each face is first in the source.");
    m.def("decode_rotations", &decode_rotations, "data"_a, "offsets"_a, "opposite"_a, "vertex"_a, "positions"_a,
          "face_source"_a, "vertex_source"_a, "uniform"_a, "The corners, from 0 on.");
}

}  // namespace ebz::binding
