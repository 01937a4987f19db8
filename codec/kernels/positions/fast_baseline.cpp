// The fast method for the baseline.
#include "fast_coder.hpp"
