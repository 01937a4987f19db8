// Rows of integers along what they belong to.
#include "../attributes/attributes.hpp"
#include "../attributes/normals.hpp"
#include "arrays.hpp"
#include "modules.hpp"

namespace ebz::binding {

namespace {

// The arrays must stay.
ebz::attributes::Items attribute_items(const Input<int32_t>& opposite, const Input<int32_t>& item, const Input<int32_t>& offsets, int32_t n,
                                       size_t n_components, const Input<double>& points,
                                       const Input<int32_t>& site, const Input<double>& guess) {
    return {view(opposite), view(item), view(offsets), n, n_components, view(points), view(site), view(guess)};
}

ebz::attributes::Coding attribute_coding(int method, int space, int relation, double total, bool heights, bool by_area) {
    return {static_cast<ebz::attributes::Method>(method), static_cast<ebz::attributes::Space>(space),
            static_cast<ebz::attributes::Relation>(relation), total, heights, by_area};
}

nb::bytes encode_attribute(const Input<int32_t>& opposite, const Input<int32_t>& item, const Input<int32_t>& offsets, int32_t n,
                           size_t n_components, const Input<double>& points, const Input<int32_t>& site,
                           const Input<double>& guess, int method, int space, int relation, double total,
                           bool heights, bool by_area, const Input<int64_t>& values) {
    const auto items = attribute_items(opposite, item, offsets, n, n_components, points, site, guess);
    const auto coding = attribute_coding(method, space, relation, total, heights, by_area);
    return to_bytes(without_gil([&] { return ebz::attributes::encode(items, coding, view(values)); }));
}

Array<int64_t> decode_attribute(const Stream& bytes, const Input<int32_t>& opposite,
                                const Input<int32_t>& item, const Input<int32_t>& offsets, int32_t n, size_t n_components,
                                const Input<double>& points, const Input<int32_t>& site,
                                const Input<double>& guess, int method, int space, int relation, double total,
                                bool heights, bool by_area) {
    const auto items = attribute_items(opposite, item, offsets, n, n_components, points, site, guess);
    const auto coding = attribute_coding(method, space, relation, total, heights, by_area);
    return to_numpy(without_gil([&] {
        std::vector<int64_t> values(static_cast<size_t>(n) * n_components);
        ebz::attributes::decode(view(bytes), items, coding, values);
        return values;
    }));
}

Array<double> normals(const Input<double>& points, const Input<int32_t>& vertex, const Input<int32_t>& offsets,
                      const Input<int32_t>& item, int32_t n, bool by_area, bool by_angle, bool as_sums, bool by_corner) {
    return to_numpy(without_gil([&] {
        return ebz::attributes::normals({view(points), view(vertex), view(offsets), view(item), n},
                                        {by_area, by_angle, as_sums, by_corner});
    }));
}

}  // namespace

void bind_attributes(nb::module_& m) {
    m.def("encode_attribute", &encode_attribute, "opposite"_a, "item"_a, "offsets"_a, "n"_a, "n_components"_a, "points"_a,
          "site"_a, "guess"_a, "method"_a, "space"_a, "relation"_a, "total"_a, "heights"_a, "by_area"_a, "values"_a,
          "The bytes of n rows of integers, of items of a surface, of its faces, or of a list.");
    m.def("decode_attribute", &decode_attribute, "data"_a, "opposite"_a, "item"_a, "offsets"_a, "n"_a, "n_components"_a,
          "points"_a, "site"_a, "guess"_a, "method"_a, "space"_a, "relation"_a, "total"_a, "heights"_a, "by_area"_a,
          "The rows, flattened.");
    m.def("normals", &normals, "points"_a, "vertex"_a, "offsets"_a, "item"_a, "n"_a, "by_area"_a, "by_angle"_a,
          "as_sums"_a, "by_corner"_a, "Normals of n items of corners, or of n faces, flattened.");
}

}  // namespace ebz::binding
