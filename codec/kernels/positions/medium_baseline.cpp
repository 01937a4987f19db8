// The medium method for the baseline.
#include "medium_coder.hpp"
