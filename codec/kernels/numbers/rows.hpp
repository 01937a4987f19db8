// Rows of numbers, at any distance.
#pragma once

#include <cstddef>
#include <cstdint>

namespace ebz {

template <class Integer>
struct Rows {
    const Integer* first;
    size_t n, width;
    int64_t stride;
};

}  // namespace ebz
