// The light and medium methods for the baseline.
#include "light_coder.hpp"
