// Faces of polygons <-> words with marks.
#include "../polygons/cut.hpp"
#include "../polygons/polygons.hpp"
#include "word.hpp"
#include "modules.hpp"

namespace ebz::binding {

namespace {

std::tuple<Array<uint8_t>, Array<int64_t>, int32_t, int32_t, Array<uint8_t>, Array<int32_t>, Array<int32_t>,
           int32_t, Array<int32_t>>
encode_polygons(const Input<int32_t>& corners, const Input<int32_t>& offsets, int32_t n_vertices) {
    require_addressable(3 * (corners.size() - 2 * (offsets.size() - 1)));
    ebz::polygons::EncodedPolygons encoded =
        without_gil([&] { return ebz::polygons::encode_polygons(view(corners), view(offsets), n_vertices); });
    return std::make_tuple(to_numpy(std::move(encoded.word.symbols)), to_numpy(to_pairs(encoded.word.specials)),
                           encoded.word.n_closed, encoded.word.n_single, to_numpy(std::move(encoded.marks)),
                           to_numpy(std::move(encoded.connectivity.opposite)),
                           to_numpy(std::move(encoded.connectivity.fans.vertex)),
                           encoded.connectivity.fans.n_vertices, to_numpy(std::move(encoded.source_corner)));
}

nb::bytes encode_polygon_word(const Input<uint8_t>& symbols, const Input<uint8_t>& marks, int64_t n_closed,
                              int64_t n_single, const Input<int64_t>& specials, int effort) {
    const ebz::WordHeader header = word_header(static_cast<int64_t>(symbols.size()), n_closed, n_single);
    return to_bytes(without_gil([&] {
        return ebz::polygons::encode_adaptive(view(symbols), view(marks), header, specials_from(specials),
                                              static_cast<ebz::Effort>(effort));
    }));
}

std::tuple<WordArrays, Array<int64_t>, Array<uint8_t>> decode_polygon_word(const Stream& bytes,
                                                                           int64_t n_symbols, int64_t n_closed,
                                                                           int64_t n_single, int64_t n_specials,
                                                                           int effort) {
    const ebz::WordHeader header = word_header(n_symbols, n_closed, n_single);
    ebz::polygons::DecodedPolygons decoded = without_gil([&] {
        return ebz::polygons::decode_adaptive(view(bytes), header, static_cast<ebz::Index>(n_specials),
                                              static_cast<ebz::Effort>(effort));
    });
    return {word_arrays(std::move(decoded.triangles.word)), to_numpy(to_pairs(decoded.triangles.specials)),
            to_numpy(std::move(decoded.marks))};
}

std::tuple<Array<int32_t>, Array<int32_t>> corners_of_polygons(const Input<int32_t>& opposite,
                                                               const Input<uint8_t>& marks) {
    ebz::polygons::Corners corners =
        without_gil([&] { return ebz::polygons::corners_of_polygons(view(opposite), view(marks)); });
    return {to_numpy(std::move(corners.offsets)), to_numpy(std::move(corners.corner))};
}

std::tuple<Array<int32_t>, Array<int32_t>> cut_polygons(const Input<int32_t>& vertex, const Input<int32_t>& offsets,
                                                        const Input<int32_t>& across, int32_t n_vertices, int way) {
    ebz::polygons::Triangles triangles = without_gil([&] {
        return ebz::polygons::cut(ebz::PolygonFaces(view(vertex), view(offsets)), view(across), n_vertices,
                                  static_cast<ebz::polygons::Cut>(way));
    });
    return {to_numpy(std::move(triangles.opposite)), to_numpy(std::move(triangles.corner))};
}

}  // namespace

void bind_polygons(nb::module_& m) {
    m.def("encode_polygons", &encode_polygons, "corners"_a, "offsets"_a, "n_vertices"_a,
          "symbols, specials (position, meets), n_closed, n_single, marks, opposite, piece_vertex, "
          "n_piece_vertices, source_corner of faces of three corners at least.");
    m.def("encode_polygon_word", &encode_polygon_word, "symbols"_a, "marks"_a, "n_closed"_a, "n_single"_a,
          "specials"_a, "effort"_a, "The word and its marks in reverse order under an adaptive model.");
    m.def("decode_polygon_word", &decode_polygon_word, "data"_a, "n_symbols"_a, "n_closed"_a, "n_single"_a,
          "n_specials"_a, "effort"_a, "What decode_adaptive gives, and the marks.");
    m.def("corners_of_polygons", &corners_of_polygons, "opposite"_a, "marks"_a,
          "offsets, and the corner of a triangle that each corner of the polygons is.");
    m.def("cut_polygons", &cut_polygons, "vertex"_a, "offsets"_a, "across"_a, "n_vertices"_a, "way"_a,
          "The half-edge across each of the triangles that predict positions, and the polygons' corner of each corner.");
}

}  // namespace ebz::binding
