// Faces of triangles <-> words, under tables and adaptive models.
#include "word.hpp"
#include "modules.hpp"

namespace ebz::binding {

namespace {

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

ebz::AutomatonModel automaton(const Input<uint32_t>& frequencies, const Input<uint16_t>& successors) {
    return {view(frequencies), view(successors)};
}

ebz::StackModel stack(const Input<uint32_t>& frequencies, const Input<uint8_t>& top, uint32_t n_conflicts,
                      const Input<uint8_t>& step, uint32_t n_lengths, uint8_t bottom) {
    return {view(frequencies), view(top), n_conflicts, view(step), n_lengths, bottom};
}

template <class Model>
nb::bytes encode_symbols(const Input<uint8_t>& symbols, const Input<int64_t>& specials, const Model& model) {
    return to_bytes(
        without_gil([&] { return ebz::encode_symbols(view(symbols), specials_from(specials), model); }));
}

template <class Model>
WordArrays decode_connectivity(const Stream& bytes, int64_t n_symbols, int64_t n_closed,
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

std::tuple<WordArrays, Array<int64_t>> decode_adaptive(const Stream& bytes, int64_t n_symbols,
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

}  // namespace

void bind_word(nb::module_& m) {
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
}

}  // namespace ebz::binding
