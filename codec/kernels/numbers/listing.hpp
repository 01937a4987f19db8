// Integers of which few are different.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace ebz {

// The different ones, ascending, and which of them each is.
struct Listed {
    std::vector<int64_t> found, which;
};

// Nothing where many are different, or many of those within their range, of all or of the first ones.
Listed list_different(std::span<const int64_t> values);

}  // namespace ebz
