// The kernels as a Python module: the one file that knows of Python.  All of them release the GIL.
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/tuple.h>

#include <memory>
#include <tuple>
#include <utility>

#include "attributes/attributes.hpp"
#include "connectivity.hpp"
#include "errors.hpp"
#include "instructions.hpp"
#include "gluing.hpp"
#include "integers.hpp"
#include "lattices.hpp"
#include "order/permutations.hpp"
#include "points/octree.hpp"
#include "polygons/polygons.hpp"
#include "positions/fast.hpp"
#include "positions/medium.hpp"
#include "positions/positions.hpp"
#include "splits.hpp"
#include "text.hpp"
#include "topology.hpp"
#include "weld.hpp"

namespace nb = nanobind;
using namespace nb::literals;

namespace {

template <class T>
using Input = nb::ndarray<const T, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
template <class T>
using Array = nb::ndarray<nb::numpy, T, nb::ndim<1>>;

template <class T>
std::span<const T> view(const Input<T>& array) {
    return {array.data(), array.size()};
}

// Hands the memory of a vector over to numpy.
template <class T>
Array<T> to_numpy(std::vector<T>&& values) {
    auto* owned = new std::vector<T>(std::move(values));
    nb::capsule owner(owned, [](void* p) noexcept { delete static_cast<std::vector<T>*>(p); });
    return Array<T>(owned->data(), {owned->size()}, owner);
}

template <class Work>
auto without_gil(Work work) {
    nb::gil_scoped_release release;
    return work();
}

void require_addressable(size_t n_half_edges) {
    if (n_half_edges > static_cast<size_t>(INT32_MAX)) {
        throw ebz::TooLarge("more than 715,827,882 triangles");
    }
}

std::vector<ebz::SpecialS> specials_from(const Input<int64_t>& pairs) {
    std::vector<ebz::SpecialS> specials;
    for (size_t i = 0; i + 1 < pairs.size(); i += 2) specials.push_back({pairs.data()[i], pairs.data()[i + 1]});
    return specials;
}

std::vector<int64_t> to_pairs(const std::vector<ebz::SpecialS>& specials) {
    std::vector<int64_t> pairs;
    for (const ebz::SpecialS& s : specials) pairs.insert(pairs.end(), {s.position, s.meets});
    return pairs;
}

std::tuple<Array<uint8_t>, Array<int64_t>, int32_t, int32_t, Array<int32_t>, Array<int32_t>, Array<int32_t>,
           Array<int32_t>>
encode_connectivity(const Input<int32_t>& faces, int32_t n_vertices) {
    require_addressable(faces.size());
    ebz::EncodedConnectivity encoded =
        without_gil([&] { return ebz::encode_connectivity(view(faces), n_vertices); });
    return std::make_tuple(to_numpy(std::move(encoded.word.symbols)),
                          to_numpy(to_pairs(encoded.word.specials)),
                          encoded.word.n_closed, encoded.word.n_single,
                          to_numpy(std::move(encoded.word.gates)),
                          to_numpy(std::move(encoded.connectivity.opposite)),
                          to_numpy(std::move(encoded.connectivity.fans.vertex)),
                          to_numpy(std::move(encoded.source_vertex)));
}

nb::bytes to_bytes(const std::vector<uint8_t>& bytes) { return nb::bytes(bytes.data(), bytes.size()); }

ebz::AutomatonModel automaton(const Input<uint32_t>& frequencies, const Input<uint16_t>& successors) {
    return {view(frequencies), view(successors)};
}

ebz::StackModel stack(const Input<uint32_t>& frequencies, const Input<uint8_t>& top, uint32_t n_conflicts,
                      const Input<uint8_t>& step, uint32_t n_lengths, uint8_t bottom) {
    return {view(frequencies), view(top), n_conflicts, view(step), n_lengths, bottom};
}

ebz::WordHeader word_header(int64_t n_symbols, int64_t n_closed, int64_t n_single) {
    require_addressable(3 * static_cast<size_t>(n_symbols + n_closed));
    return {static_cast<ebz::Index>(n_symbols), static_cast<ebz::Index>(n_closed),
            static_cast<ebz::Index>(n_single)};
}

using WordArrays = std::tuple<Array<uint8_t>, Array<int32_t>, Array<int32_t>, int32_t>;

WordArrays word_arrays(ebz::DecodedConnectivity&& decoded) {
    return {to_numpy(std::move(decoded.symbols)), to_numpy(std::move(decoded.connectivity.opposite)),
            to_numpy(std::move(decoded.connectivity.fans.vertex)), decoded.connectivity.fans.n_vertices};
}

template <class Model>
nb::bytes encode_symbols(const Input<uint8_t>& symbols, const Input<int64_t>& specials, const Model& model) {
    return to_bytes(
        without_gil([&] { return ebz::encode_symbols(view(symbols), specials_from(specials), model); }));
}

template <class Model>
WordArrays decode_connectivity(const Input<uint8_t>& bytes, int64_t n_symbols, int64_t n_closed,
                               int64_t n_single, const Input<int64_t>& specials, const Model& model) {
    const ebz::WordHeader header = word_header(n_symbols, n_closed, n_single);
    return word_arrays(without_gil(
        [&] { return ebz::decode_connectivity(view(bytes), header, specials_from(specials), model); }));
}

nb::bytes encode_adaptive(const Input<uint8_t>& symbols, int64_t n_closed, int64_t n_single,
                          const Input<int64_t>& specials, int effort) {
    const ebz::WordHeader header = word_header(static_cast<int64_t>(symbols.size()), n_closed, n_single);
    return to_bytes(without_gil([&] {
        return ebz::encode_adaptive(view(symbols), header, specials_from(specials),
                                    static_cast<ebz::Effort>(effort));
    }));
}

std::tuple<WordArrays, Array<int64_t>> decode_adaptive(const Input<uint8_t>& bytes, int64_t n_symbols,
                                                       int64_t n_closed, int64_t n_single, int64_t n_specials,
                                                       int effort) {
    const ebz::WordHeader header = word_header(n_symbols, n_closed, n_single);
    ebz::AdaptivelyDecoded decoded = without_gil([&] {
        return ebz::decode_adaptive(view(bytes), header, static_cast<ebz::Index>(n_specials),
                                    static_cast<ebz::Effort>(effort));
    });
    return {word_arrays(std::move(decoded.word)), to_numpy(to_pairs(decoded.specials))};
}

template <class Model>
void bind_word_coder(nb::module_& m) {
    m.def("encode_symbols", &encode_symbols<Model>, "symbols"_a, "specials"_a, "model"_a,
          "The word in reverse order under a model.");
    m.def("decode_connectivity", &decode_connectivity<Model>, "data"_a, "n_symbols"_a, "n_closed"_a,
          "n_single"_a, "specials"_a, "model"_a,
          "symbols, opposite, piece_vertex, n_piece_vertices of an encoded word.");
}

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

std::tuple<WordArrays, Array<int64_t>, Array<uint8_t>> decode_polygon_word(const Input<uint8_t>& bytes,
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
}

nb::bytes encode_positions(const Input<int32_t>& opposite, const Input<int32_t>& vertex, int32_t n_vertices,
                           const Input<int64_t>& values, int method) {
    const ebz::positions::Surface surface{view(opposite), view(vertex), n_vertices};
    return to_bytes(without_gil([&] {
        return ebz::positions::encode(surface, view(values), static_cast<ebz::positions::Method>(method));
    }));
}

Array<int64_t> decode_positions(const Input<uint8_t>& bytes, const Input<int32_t>& opposite,
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
nb::ndarray<nb::numpy, int32_t, nb::ndim<2>> decode_positions_in_place(const Input<uint8_t>& bytes,
                                                                       const Input<int32_t>& opposite,
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

Array<int64_t> decode_points(const Input<uint8_t>& bytes, int32_t n) {
    return to_numpy(without_gil([&] { return ebz::points::decode(view(bytes), static_cast<size_t>(n)); }));
}

nb::bytes encode_gluing(const Input<int32_t>& opposite, const Input<int32_t>& vertex, int32_t n_copies,
                        const Input<int32_t>& site) {
    return to_bytes(without_gil([&] {
        const auto n_vertices = static_cast<int32_t>(site.size());
        return ebz::encode_gluing({view(opposite), view(vertex), n_vertices, n_copies}, view(site));
    }));
}

Array<int32_t> decode_gluing(const Input<uint8_t>& bytes, const Input<int32_t>& opposite,
                             const Input<int32_t>& vertex, int32_t n_vertices, int32_t n_copies) {
    return to_numpy(without_gil([&] {
        return ebz::decode_gluing(view(bytes), {view(opposite), view(vertex), n_vertices, n_copies});
    }));
}

Array<int32_t> glue(const Input<int32_t>& vertex, const Input<int32_t>& site) {
    return to_numpy(without_gil([&] { return ebz::glue(view(vertex), view(site)); }));
}

nb::bytes encode_splits(const Input<int32_t>& opposite, const Input<int32_t>& point, int32_t n_points,
                        const Input<int32_t>& vertex) {
    return to_bytes(
        without_gil([&] { return ebz::encode_splits(view(opposite), view(point), n_points, view(vertex)); }));
}

std::tuple<Array<int32_t>, Array<int32_t>> decode_splits(const Input<uint8_t>& bytes, const Input<int32_t>& opposite,
                                                         const Input<int32_t>& point, int32_t n_points) {
    ebz::DecodedSplits decoded =
        without_gil([&] { return ebz::decode_splits(view(bytes), view(opposite), view(point), n_points); });
    return {to_numpy(std::move(decoded.vertex)), to_numpy(std::move(decoded.point))};
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

Array<int32_t> decode_vertex_order(const Input<uint8_t>& bytes, const Input<int32_t>& opposite,
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

Array<int32_t> decode_face_order(const Input<uint8_t>& bytes, const Input<int32_t>& offsets,
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

Array<int32_t> decode_rotations(const Input<uint8_t>& bytes, const Input<int32_t>& offsets,
                                const Input<int32_t>& opposite, const Input<int32_t>& vertex,
                                const Input<int64_t>& positions, const Input<int32_t>& face_source,
                                const Input<int32_t>& vertex_source, bool uniform) {
    return to_numpy(with_faces(offsets, opposite, vertex, positions, [&](const auto& known) {
        return ebz::order::decode_rotations(view(bytes), known, view(face_source), view(vertex_source), uniform);
    }));
}

template <class Float>
int decimal_digits(const Input<Float>& values, int max_digits, size_t max_misses) {
    return without_gil([&] { return ebz::decimal_digits(view(values), max_digits, max_misses); });
}

template <class T>
using Output = nb::ndarray<T, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
using Numbers3 = std::tuple<double, double, double>;

ebz::Steps steps(const Numbers3& origin, double step) {
    return {{std::get<0>(origin), std::get<1>(origin), std::get<2>(origin)}, step};
}

template <class Float>
std::tuple<Numbers3, Numbers3> bounds(const Input<Float>& coordinates) {
    const auto b = without_gil([&] { return ebz::bounds(view(coordinates)); });
    return {{b[0], b[1], b[2]}, {b[3], b[4], b[5]}};
}

template <class Float>
Array<int64_t> to_multiples(const Input<Float>& coordinates, const Numbers3& origin, double step) {
    return to_numpy(without_gil([&] {
        std::vector<int64_t> multiples(coordinates.size());
        ebz::to_multiples(view(coordinates), steps(origin, step), multiples);
        return multiples;
    }));
}

template <class Integer>
using InputRows = nb::ndarray<const Integer, nb::shape<-1, 3>, nb::device::cpu>;

template <class Integer, class Float>
void from_multiples(const InputRows<Integer>& multiples, const Numbers3& origin, double step,
                    const Output<Float>& coordinates) {
    if (multiples.stride(1) != 1) throw nb::value_error("the rows of multiples are not contiguous");
    without_gil([&] {
        const std::span<Float> filled(coordinates.data(), coordinates.size());
        const size_t n = std::min(multiples.shape(0), filled.size() / 3);
        const ebz::Rows<Integer> rows{multiples.data(), n, multiples.stride(0)};
        ebz::from_multiples(rows, steps(origin, step), filled);
    });
}

template <class Float>
void bind_lattices(nb::module_& m) {
    m.def("bounds", &bounds<Float>, "coordinates"_a,
          "The least and the greatest of each axis, infinite where some are not finite.");
    m.def("to_multiples", &to_multiples<Float>, "coordinates"_a, "origin"_a, "step"_a,
          "The nearest integers to (x - origin) / step.");
    m.def("from_multiples", &from_multiples<int32_t, Float>, "multiples"_a, "origin"_a, "step"_a, "coordinates"_a);
    m.def("from_multiples", &from_multiples<int64_t, Float>, "multiples"_a, "origin"_a, "step"_a, "coordinates"_a,
          "Fills coordinates with origin + step * integer.");
}

std::tuple<Array<int32_t>, Array<int32_t>> number_by_first_use(const Input<int32_t>& entries, int32_t n_items) {
    ebz::Numbered numbered = without_gil([&] { return ebz::number_by_first_use(view(entries), n_items); });
    return {to_numpy(std::move(numbered.number)), to_numpy(std::move(numbered.items))};
}

nb::bytes encode_integers(const Input<uint64_t>& values, size_t n_columns) {
    return to_bytes(without_gil([&] { return ebz::encode_integers(view(values), n_columns); }));
}

Array<uint64_t> decode_integers(const Input<uint8_t>& bytes, size_t n_rows, size_t n_columns) {
    return to_numpy(without_gil([&] { return ebz::decode_integers(view(bytes), n_rows, n_columns); }));
}

nb::bytes encode_text(const ebz::TextCoder& coder, const Input<uint8_t>& text) {
    return to_bytes(without_gil([&] { return coder.encode(view(text)); }));
}

Array<uint8_t> decode_text(const ebz::TextCoder& coder, const Input<uint8_t>& bytes, size_t n_bytes) {
    return to_numpy(without_gil([&] {
        std::vector<uint8_t> text(n_bytes);
        coder.decode(view(bytes), text);
        return text;
    }));
}

std::tuple<int32_t, int32_t, int32_t, int32_t> describe(const Input<int32_t>& opposite) {
    const ebz::Topology topology = without_gil([&] { return ebz::describe(view(opposite)); });
    return std::make_tuple(topology.n_components, topology.n_boundary_loops, topology.n_boundary_edges,
                          topology.n_edges);
}

// The arrays must stay.
ebz::attributes::Items attribute_items(const Input<int32_t>& opposite, const Input<int32_t>& item, int32_t n,
                                       size_t n_components, const Input<double>& points,
                                       const Input<int32_t>& site, const Input<double>& guess) {
    return {view(opposite), view(item), n, n_components, view(points), view(site), view(guess)};
}

ebz::attributes::Coding attribute_coding(int method, int space, int relation, double total, bool heights, bool by_area) {
    return {static_cast<ebz::attributes::Method>(method), static_cast<ebz::attributes::Space>(space),
            static_cast<ebz::attributes::Relation>(relation), total, heights, by_area};
}

nb::bytes encode_attribute(const Input<int32_t>& opposite, const Input<int32_t>& item, int32_t n,
                           size_t n_components, const Input<double>& points, const Input<int32_t>& site,
                           const Input<double>& guess, int method, int space, int relation, double total,
                           bool heights, bool by_area, const Input<int64_t>& values) {
    const auto items = attribute_items(opposite, item, n, n_components, points, site, guess);
    const auto coding = attribute_coding(method, space, relation, total, heights, by_area);
    return to_bytes(without_gil([&] { return ebz::attributes::encode(items, coding, view(values)); }));
}

Array<int64_t> decode_attribute(const Input<uint8_t>& bytes, const Input<int32_t>& opposite,
                                const Input<int32_t>& item, int32_t n, size_t n_components,
                                const Input<double>& points, const Input<int32_t>& site,
                                const Input<double>& guess, int method, int space, int relation, double total,
                                bool heights, bool by_area) {
    const auto items = attribute_items(opposite, item, n, n_components, points, site, guess);
    const auto coding = attribute_coding(method, space, relation, total, heights, by_area);
    return to_numpy(without_gil([&] {
        std::vector<int64_t> values(static_cast<size_t>(n) * n_components);
        ebz::attributes::decode(view(bytes), items, coding, values);
        return values;
    }));
}

void bind_attributes(nb::module_& m) {
    m.def("encode_attribute", &encode_attribute, "opposite"_a, "item"_a, "n"_a, "n_components"_a, "points"_a,
          "site"_a, "guess"_a, "method"_a, "space"_a, "relation"_a, "total"_a, "heights"_a, "by_area"_a, "values"_a,
          "The bytes of n rows of integers, of items of a surface, of its faces, or of a list.");
    m.def("decode_attribute", &decode_attribute, "data"_a, "opposite"_a, "item"_a, "n"_a, "n_components"_a,
          "points"_a, "site"_a, "guess"_a, "method"_a, "space"_a, "relation"_a, "total"_a, "heights"_a, "by_area"_a,
          "The rows, flattened.");
}

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

void translate_errors(const std::exception_ptr& error, void*) {
    const auto raise = [](const char* name, const char* message) {
        const nb::object type = nb::module_::import_("ebz.codec.errors").attr(name);
        PyErr_SetString(type.ptr(), message);
    };
    try {
        std::rethrow_exception(error);
    } catch (const ebz::Corrupt& e) {
        raise("CorruptError", e.what());
    } catch (const ebz::TooLarge& e) {
        raise("MeshError", e.what());
    }
}

}  // namespace

NB_MODULE(_kernels, m) {
    m.doc() = "The loops of ebz, in C++; arguments are checked by the modules that call them.";
    nb::register_exception_translator(translate_errors);
    m.def("encode_connectivity", &encode_connectivity, "faces"_a, "n_vertices"_a,
          "symbols, specials (position, meets), n_closed, n_single, gates, opposite, piece_vertex, "
          "source_vertex of 3m vertex indices.");
    nb::class_<ebz::AutomatonModel>(m, "AutomatonModel", "Frozen frequencies per state.");
    nb::class_<ebz::StackModel>(m, "StackModel", "Frozen frequencies per class of stacks.");
    m.def("automaton", &automaton, "frequencies"_a, "successors"_a,
          "A model from checked tables, flattened: 5 entries per state.");
    m.def("stack", &stack, "frequencies"_a, "top"_a, "n_conflicts"_a, "step"_a, "n_lengths"_a, "bottom"_a,
          "A model from checked tables, flattened: 5 frequencies per row.");
    bind_word_coder<ebz::AutomatonModel>(m);
    bind_word_coder<ebz::StackModel>(m);
    m.def("encode_adaptive", &encode_adaptive, "symbols"_a, "n_closed"_a, "n_single"_a, "specials"_a,
          "effort"_a, "The word in reverse order under an adaptive model.");
    m.def("decode_adaptive", &decode_adaptive, "data"_a, "n_symbols"_a, "n_closed"_a, "n_single"_a,
          "n_specials"_a, "effort"_a,
          "What decode_connectivity gives and the specials, of a word under an adaptive model.");
    m.def("forbid_extensions", &ebz::forbid_extensions, "forbidden"_a,
          "Take the baseline instructions on every machine, or no more; for tests.");
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
    m.def("encode_gluing", &encode_gluing, "opposite"_a, "vertex"_a, "n_copies"_a, "site"_a,
          "Which vertices of the pieces are one site; site: of each, numbered by first use.");
    m.def("decode_gluing", &decode_gluing, "data"_a, "opposite"_a, "vertex"_a, "n_vertices"_a, "n_copies"_a,
          "The site of each vertex of the pieces.");
    m.def("glue", &glue, "vertex"_a, "site"_a, "The site of each corner.");
    m.def("encode_splits", &encode_splits, "opposite"_a, "point"_a, "n_points"_a, "vertex"_a,
          "Which corners at each point belong to which vertex.");
    m.def("decode_splits", &decode_splits, "data"_a, "opposite"_a, "point"_a, "n_points"_a,
          "The vertex of each corner, numbered by first use, and the point of each vertex.");
    m.def("weld", &weld<int32_t>, "faces"_a, "offsets"_a, "positions"_a);
    m.def("weld", &weld<int64_t>, "faces"_a, "offsets"_a, "positions"_a,
          "For each vertex the first that stands for it, empty if nothing is welded; no offsets: triangles.");
    bind_attributes(m);
    bind_polygons(m);
    bind_orders(m);
    m.def("decimal_digits", &decimal_digits<float>, "values"_a, "max_digits"_a, "max_misses"_a);
    m.def("decimal_digits", &decimal_digits<double>, "values"_a, "max_digits"_a, "max_misses"_a,
          "The fewest decimals that all values but max_misses have, -1 if there are too many.");
    bind_lattices<float>(m);
    bind_lattices<double>(m);
    m.def("number_by_first_use", &number_by_first_use, "entries"_a, "n_items"_a,
          "The number of each entry's item, and the items by number.");
    m.def("encode_integers", &encode_integers, "values"_a, "n_columns"_a,
          "Rows of unsigned integers, a model per column.");
    m.def("decode_integers", &decode_integers, "data"_a, "n_rows"_a, "n_columns"_a,
          "The rows, flattened.");
    nb::class_<ebz::TextCoder>(m, "TextCoder", "Of text like a prior.")
        .def("__init__",
             [](ebz::TextCoder* self, const Input<uint8_t>& prior) { new (self) ebz::TextCoder(view(prior)); }, "prior"_a)
        .def("encode", &encode_text, "text"_a, "The coded text.")
        .def("decode", &decode_text, "data"_a, "n_bytes"_a, "The text.");
    m.def("describe", &describe, "opposite"_a,
          "Numbers of components, boundary loops, boundary edges and edges of a surface.");
}
