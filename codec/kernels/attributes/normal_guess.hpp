// The guess of each item: as it was told, or of normals corrected by what is known of the surface.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "../positions/surface.hpp"
#include "attributes.hpp"
#include "direction.hpp"
#include "normal_errors.hpp"

namespace ebz::attributes {

template <class S>
class NormalGuess {
public:
    // corners: none where items are no vertices.
    NormalGuess(const Items& items, const Coding& coding, std::span<const int64_t> values,
                const positions::CornersOfVertices* corners)
        : n_components_(items.n_components),
          coding_(coding),
          values_(values),
          guess_(items.guess.begin(), items.guess.end()),
          are_directions_(!guess_.empty() && (is_octahedral() || coding.relation == Relation::unit)) {
        if (coding.heights && are_directions_ && corners != nullptr) errors_.emplace(items, coding.by_area, *corners);
    }

    bool is_there() const { return !guess_.empty(); }
    bool are_directions() const { return are_directions_; }

    double operator()(int32_t item, size_t c) const { return guess_[at(item) + c]; }

    void begin(int32_t item) {
        if (!are_directions_) return;
        double* guess = &guess_[at(item)];
        normal_ = normal(guess[0], guess[1], is_octahedral() ? 0 : guess[2]);
        variation_ = grain(guess);
        if (!errors_) return;
        const Vector3 corrected = unit(sum(normal_, errors_->change(item, normal_, variation_)));
        variation_ = errors_->variation();
        if (is_octahedral()) {
            const auto place = to_octahedron(corrected, coding_.total);
            guess[0] = place[0], guess[1] = place[1];
        } else {
            for (size_t d = 0; d < 3; ++d) guess[d] = corrected[d] * coding_.total;
        }
    }

    // All of the item is known.
    void end(int32_t item) {
        if (!errors_) return;
        const auto value = [&](size_t c) { return S::value(values_[at(item) + c]); };
        errors_->learn(normal_, normal(value(0), value(1), is_octahedral() ? 0 : value(2)));
    }

    // How errors at the item under way spread over the components that are coded first and second.
    Direction direction(int32_t item, size_t first, size_t second) const {
        if (!is_octahedral()) return Direction::of_vector(variation_, first, second, coding_.total);
        const double* guess = &guess_[at(item)];
        return Direction::of_octahedron(variation_, OctahedronRows({guess[0], guess[1]}, coding_.total));
    }

private:
    bool is_octahedral() const { return coding_.relation == Relation::octahedral; }
    size_t at(int32_t item) const { return static_cast<size_t>(item) * n_components_; }

    Vector3 normal(double x, double y, double z) const {
        return is_octahedral() ? from_octahedron(x, y, coding_.total) : unit({x, y, z});
    }

    // What rounding to the lattice of the normals adds to their errors.
    Variation grain(const double* guess) const {
        if (is_octahedral()) {
            const OctahedronRows rows({guess[0], guess[1]}, coding_.total);
            return Variation::of_lattice(normal_, rows.u, rows.v);
        }
        Variation result = Variation::about(normal_);
        const double step = S::unit(coding_.total) / coding_.total;
        result.xx = result.yy = step * step / 12;
        return result;
    }

    size_t n_components_;
    const Coding& coding_;
    std::span<const int64_t> values_;
    std::vector<double> guess_;
    bool are_directions_;
    std::optional<NormalErrors> errors_;

    // The item under way.
    Vector3 normal_{};
    Variation variation_;
};

}  // namespace ebz::attributes
