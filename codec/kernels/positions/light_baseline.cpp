// The light method for the baseline.
#include "light_coder.hpp"
