// Coordinates <-> integers on a lattice, and those of which few are different.
#include <algorithm>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "../numbers/lattices.hpp"
#include "../numbers/listing.hpp"
#include "../numbers/singles.hpp"
#include "arrays.hpp"
#include "modules.hpp"

namespace ebz::binding {

namespace {

template <class Float>
int decimal_digits(const Input<Float>& values, int max_digits, size_t max_misses) {
    return without_gil([&] { return ebz::decimal_digits(view(values), max_digits, max_misses); });
}

int single_digits(const Input<double>& values, size_t max_misses) {
    return without_gil([&] { return ebz::single_digits(view(values), max_misses); });
}

Array<double> write_singles(const Input<float>& singles, int digits) {
    if (digits < 0 || digits > ebz::max_single_digits) throw nb::value_error("more digits than a decimal has");
    return to_numpy(without_gil([&] {
        std::vector<double> values(singles.size());
        ebz::write_singles(view(singles), digits, values);
        return values;
    }));
}

std::tuple<Array<int64_t>, Array<int64_t>> list_different(const Input<int64_t>& values) {
    ebz::Listed listed = without_gil([&] { return ebz::list_different(view(values)); });
    return {to_numpy(std::move(listed.found)), to_numpy(std::move(listed.which))};
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

template <class Integer, class Float>
void from_multiples(const InputRows<Integer>& multiples, const Numbers3& origin, double step,
                    const Output<Float>& coordinates) {
    if (multiples.shape(1) != 3 || coordinates.size() != multiples.size()) throw nb::value_error("other than 3 axes");
    without_gil([&] {
        ebz::from_multiples(view(multiples), steps(origin, step), std::span(coordinates.data(), coordinates.size()));
    });
}

template <class Float>
void bind_lattices_of(nb::module_& m) {
    m.def("bounds", &bounds<Float>, "coordinates"_a,
          "The least and the greatest of each axis, infinite where some are not finite.");
    m.def("to_multiples", &to_multiples<Float>, "coordinates"_a, "origin"_a, "step"_a,
          "The nearest integers to (x - origin) / step.");
    m.def("from_multiples", &from_multiples<int32_t, Float>, "multiples"_a, "origin"_a, "step"_a, "coordinates"_a);
    m.def("from_multiples", &from_multiples<int64_t, Float>, "multiples"_a, "origin"_a, "step"_a, "coordinates"_a,
          "Fills coordinates with origin + step * integer.");
}

}  // namespace

void bind_lattices(nb::module_& m) {
    m.def("decimal_digits", &decimal_digits<float>, "values"_a, "max_digits"_a, "max_misses"_a);
    m.def("decimal_digits", &decimal_digits<double>, "values"_a, "max_digits"_a, "max_misses"_a,
          "The fewest decimals that all values but max_misses have, -1 if there are too many.");
    m.def("single_digits", &single_digits, "values"_a, "max_misses"_a,
          "The significant digits of float32 that all values but max_misses are, 0 if all of them, -1 if they are none.");
    m.def("write_singles", &write_singles, "singles"_a, "digits"_a,
          "The float64 nearest to each rounded to significant digits, 0 for all of them.");
    m.def("list_different", &list_different, "values"_a,
          "The different ones, ascending, and which each is; nothing where many are.");
    bind_lattices_of<float>(m);
    bind_lattices_of<double>(m);
}

}  // namespace ebz::binding
