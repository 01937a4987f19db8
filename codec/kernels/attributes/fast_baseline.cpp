// Fast attributes for the baseline.
#include "fast_coder.hpp"
