// The two failures a kernel can report; the binding turns them into Python errors.
#pragma once

#include <stdexcept>

namespace ebz {

// The stream contradicts itself.
struct Corrupt : std::runtime_error {
    using std::runtime_error::runtime_error;
};

// The input is valid but larger than the 32-bit indices inside the kernels can address.
struct TooLarge : std::runtime_error {
    using std::runtime_error::runtime_error;
};

}  // namespace ebz
