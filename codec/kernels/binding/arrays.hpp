// Arrays of numpy as the kernels see them, and what the kernels give as arrays.  The GIL is released meanwhile.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/tuple.h>

#include <cstdint>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "../errors.hpp"
#include "../numbers/rows.hpp"

namespace ebz::binding {

namespace nb = nanobind;
using namespace nb::literals;

template <class T>
using Input = nb::ndarray<const T, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
template <class T>
using Array = nb::ndarray<nb::numpy, T, nb::ndim<1>>;

template <class T>
using InputRows = nb::ndarray<const T, nb::ndim<2>, nb::device::cpu>;
template <class T>
using ArrayOfRows = nb::ndarray<nb::numpy, T, nb::ndim<2>>;

// Bytes, which are seen in a fraction of the time that an array takes that is read only.
using Stream = nb::bytes;

template <class T>
std::span<const T> view(const Input<T>& array) {
    return {array.data(), array.size()};
}

inline std::span<const uint8_t> view(const Stream& bytes) {
    return {static_cast<const uint8_t*>(bytes.data()), bytes.size()};
}

template <class T>
ebz::Rows<T> view(const InputRows<T>& rows) {
    if (rows.shape(1) > 1 && rows.stride(1) != 1) throw nb::value_error("rows that are not contiguous");
    return {rows.data(), rows.shape(0), rows.shape(1), rows.stride(0)};
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

inline void require_addressable(size_t n_half_edges) {
    if (n_half_edges > static_cast<size_t>(INT32_MAX)) {
        throw TooLarge("more than 715,827,882 triangles");
    }
}

inline nb::bytes to_bytes(const std::vector<uint8_t>& bytes) { return nb::bytes(bytes.data(), bytes.size()); }

}  // namespace ebz::binding
