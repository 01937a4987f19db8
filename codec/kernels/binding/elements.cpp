// Vertices of rows beside the faces <-> bytes.
#include "../elements/links.hpp"
#include "arrays.hpp"
#include "modules.hpp"

namespace ebz::binding {

namespace {

nb::bytes encode_links(const Input<int32_t>& vertex, const Input<int32_t>& face_offsets, const Input<double>& points,
                       const Input<int64_t>& offsets, const Input<int32_t>& corners) {
    const ebz::elements::Mesh mesh{view(vertex), view(face_offsets), view(points), static_cast<int32_t>(points.size() / 3)};
    return to_bytes(without_gil([&] { return ebz::elements::encode_links(mesh, view(offsets), view(corners)); }));
}

Array<int32_t> decode_links(const Stream& bytes, const Input<int32_t>& vertex, const Input<int32_t>& face_offsets,
                            const Input<double>& points, const Input<int64_t>& offsets) {
    const ebz::elements::Mesh mesh{view(vertex), view(face_offsets), view(points), static_cast<int32_t>(points.size() / 3)};
    return to_numpy(without_gil([&] { return ebz::elements::decode_links(view(bytes), mesh, view(offsets)); }));
}

}  // namespace

void bind_elements(nb::module_& m) {
    m.def("encode_links", &encode_links, "vertex"_a, "face_offsets"_a, "points"_a, "offsets"_a, "corners"_a,
          "The vertices of rows, of which many are joined by edges of the faces.");
    m.def("decode_links", &decode_links, "data"_a, "vertex"_a, "face_offsets"_a, "points"_a, "offsets"_a,
          "The vertices of all rows.");
}

}  // namespace ebz::binding
