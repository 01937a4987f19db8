// Lists of different integers, told by magnitude: x, or -1 - x of those below zero.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "../errors.hpp"
#include "rows.hpp"

namespace ebz {

// The n integers of a list, ascending.
std::vector<int64_t> decode_list(std::span<const uint8_t> bytes, size_t n);

// The listed integers of those numbers, row after row.
template <class Number>
std::vector<int64_t> look_up(std::span<const int64_t> list, const Rows<Number>& numbers) {
    std::vector<int64_t> found;
    if (list.empty()) {
        if (numbers.n * numbers.width > 0) throw Corrupt("numbers of an empty list");
        return found;
    }
    found.resize(numbers.n * numbers.width);
    uint64_t last = 0;
    int64_t* at = found.data();
    for (size_t i = 0; i < numbers.n; ++i) {
        const Number* row = numbers.first + static_cast<int64_t>(i) * numbers.stride;
        for (size_t j = 0; j < numbers.width; ++j) {
            const auto number = static_cast<uint64_t>(int64_t{row[j]});
            last = std::max(last, number);
            *at++ = list[std::min<uint64_t>(number, list.size() - 1)];
        }
    }
    if (last >= list.size()) throw Corrupt("a number beyond the " + std::to_string(list.size()) + " listed");
    return found;
}

}  // namespace ebz
