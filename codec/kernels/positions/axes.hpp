// From the prediction of a vertex to what is expected of each coordinate, given those coded before it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "expectation.hpp"
#include "prediction.hpp"
#include "recall.hpp"
#include "surroundings.hpp"
#include "twins.hpp"
#include "wrapping.hpp"

namespace ebz::positions {

// The three axes of one vertex, in the order p.axes.
class Axes {
public:
    // twin: of the vertex, null where none are looked for.
    void begin(const Surroundings& s, const Prediction& p, const Twins* twin);
    void find_contexts(size_t turn, Expectation& x);
    void expect(size_t turn, Expectation& x);  // after find_contexts
    void reveal(size_t turn, int64_t residual);

    int64_t value(size_t d) const { return wrapping_sum(s_->origin[d], value_[d]); }  // once revealed
    int64_t base(size_t d) const { return wrapping_sum(s_->origin[d], base_[d]); }
    const Offset& residuals() const { return residual_; }

private:
    // Offsets from the base at which the value would equal a neighbour's: the nearest two.
    struct Nearest {
        int64_t first, second;
        bool has_second;
    };

    // Sums of a coordinate and its mirror image, by the latest pair, modulo 2^32.
    struct Mirror {
        uint32_t sum = 0;
        uint32_t hits = 0;  // times in a row that the sum came again
    };

    void set_distributions(size_t d, Expectation& x) const;
    void set_sizes(size_t d, Expectation& x);
    Nearest nearest(size_t d) const;
    void set_values(size_t turn, Expectation& x);
    void set_keys(size_t turn);
    void set_recalled(size_t turn, Expectation& x);
    int64_t from_base(size_t d, uint32_t coordinate) const;
    void learn_mirror(size_t d);
    void set_contexts(size_t turn, Expectation& x) const;
    uint32_t agreement(size_t turn, const Offset& at) const;
    uint32_t exactness(size_t d) const;
    uint32_t neighbour_value(size_t i, size_t d) const;

    static constexpr size_t n_recalls = 3;
    const Surroundings* s_ = nullptr;
    const Prediction* p_ = nullptr;
    const Twins* twin_ = nullptr;
    using Coordinates = Recall<uint32_t>;  // their lower bits
    std::array<Coordinates, n_recalls> recalls_{Coordinates(14), Coordinates(14), Coordinates(14)};
    std::array<uint32_t, n_recalls> keys_{};
    std::array<Mirror, 3> mirrors_;  // by axis
    const Coordinates::Entry* along_axes_ = nullptr;  // what the first recall found

    Point plain_mean_{}, refined_mean_{};  // shifted by what earlier axes revealed
    std::array<std::array<double, 3>, 3> covariance_{};
    Nearest nearest_{};
    double sigma_ = 0;  // deviation of the axis under way
    Offset base_{}, residual_{}, value_{};  // base and value are relative to the surroundings' origin
    int64_t first_residual_ = 0, last_residual_ = 0;
};

}  // namespace ebz::positions
