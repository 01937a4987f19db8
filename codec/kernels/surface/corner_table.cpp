#include "corner_table.hpp"

#include "faces.hpp"

namespace ebz {

namespace {

// Gives `vertex` to the corners reached from c by turning one way; false if the fan closed.
template <class Faces>
bool turn_to_boundary(std::span<const Index> opposite, const Faces& faces, std::vector<Index>& of, Index c,
                      Index vertex) {
    const Index first = c;
    for (;;) {
        of[c] = vertex;
        const Index across = opposite[faces.previous(c)];
        if (across == none) return true;
        c = across;
        if (c == first) return false;
    }
}

template <class Faces>
void turn_back(std::span<const Index> opposite, const Faces& faces, std::vector<Index>& of, Index c, Index vertex) {
    while (opposite[c] != none) {
        c = faces.next(opposite[c]);
        of[c] = vertex;
    }
}

}  // namespace

template <class Faces>
Fans number_fans(std::span<const Index> opposite, const Faces& faces) {
    Fans fans;
    fans.vertex.assign(opposite.size(), none);
    for (Index c = 0; c < static_cast<Index>(opposite.size()); ++c) {
        if (fans.vertex[c] != none) continue;
        const Index vertex = fans.n_vertices++;
        fans.first.push_back(c);
        if (turn_to_boundary(opposite, faces, fans.vertex, c, vertex)) {
            turn_back(opposite, faces, fans.vertex, c, vertex);
        }
    }
    return fans;
}

template Fans number_fans(std::span<const Index>, const TriangleFaces&);
template Fans number_fans(std::span<const Index>, const PolygonFaces&);

Fans number_fans(std::span<const Index> opposite) { return number_fans(opposite, TriangleFaces({})); }

Numbered number_by_first_use(std::span<const Index> entries, Index n_items) {
    Numbered numbered{std::vector<Index>(entries.size()), {}};
    std::vector<Index> known(static_cast<size_t>(n_items), none);
    for (size_t i = 0; i < entries.size(); ++i) {
        Index& number = known[entries[i]];
        if (number == none) {
            number = static_cast<Index>(numbered.items.size());
            numbered.items.push_back(entries[i]);
        }
        numbered.number[i] = number;
    }
    return numbered;
}

}  // namespace ebz
