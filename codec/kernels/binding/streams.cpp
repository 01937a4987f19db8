// Streams of integers and of text.
#include <new>
#include <vector>

#include "../entropy/integers.hpp"
#include "../numbers/lists.hpp"
#include "../entropy/text.hpp"
#include "arrays.hpp"
#include "modules.hpp"

namespace ebz::binding {

namespace {

nb::bytes encode_integers(const Input<uint64_t>& values, size_t n_columns) {
    return to_bytes(without_gil([&] { return ebz::encode_integers(view(values), n_columns); }));
}

Array<uint64_t> decode_integers(const Stream& bytes, size_t n_rows, size_t n_columns) {
    return to_numpy(without_gil([&] { return ebz::decode_integers(view(bytes), n_rows, n_columns); }));
}

Array<int64_t> decode_list(const Stream& bytes, size_t n) {
    return to_numpy(without_gil([&] { return ebz::decode_list(view(bytes), n); }));
}

template <class Number>
Array<int64_t> look_up(const Input<int64_t>& list, const InputRows<Number>& numbers) {
    return to_numpy(without_gil([&] { return ebz::look_up(view(list), view(numbers)); }));
}

nb::bytes encode_text(const ebz::TextCoder& coder, const Stream& text) {
    return to_bytes(without_gil([&] { return coder.encode(view(text)); }));
}

Array<uint8_t> decode_text(const ebz::TextCoder& coder, const Stream& bytes, size_t n_bytes) {
    return to_numpy(without_gil([&] {
        std::vector<uint8_t> text(n_bytes);
        coder.decode(view(bytes), text);
        return text;
    }));
}

}  // namespace

void bind_streams(nb::module_& m) {
    m.def("encode_integers", &encode_integers, "values"_a, "n_columns"_a,
          "Rows of unsigned integers, a model per column.");
    m.def("decode_integers", &decode_integers, "data"_a, "n_rows"_a, "n_columns"_a,
          "The rows, flattened.");
    m.def("decode_list", &decode_list, "data"_a, "n"_a, "The n integers of a list, ascending.");
    m.def("look_up", &look_up<int32_t>, "list"_a, "numbers"_a);
    m.def("look_up", &look_up<int64_t>, "list"_a, "numbers"_a, "The listed integers of rows of numbers, flattened.");
    nb::class_<ebz::TextCoder>(m, "TextCoder", "Of text like a prior.")
        .def("__init__",
             [](ebz::TextCoder* self, const Stream& prior) { new (self) ebz::TextCoder(view(prior)); }, "prior"_a)
        .def("encode", &encode_text, "text"_a, "The coded text.")
        .def("decode", &decode_text, "data"_a, "n_bytes"_a, "The text.");
}

}  // namespace ebz::binding
