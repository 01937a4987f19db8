// code_strong for the baseline.
#include "strong_coder.hpp"
