// Where the weights for a new mesh start: means of where those of fourteen meshes ended.
//
// Half of these meshes give the other half 0.3 % (and conversely), so little is specific to them.
#pragma once

#include <array>

namespace ebz::positions {

// Contexts, distributions and a constant, exact values, in the order of Expectation.
inline constexpr std::array<std::array<float, 24>, 5> initial_weights = {{
    {0.09f, 0.07f, 0.18f, 0.09f, 0.19f, 0.17f, 0.07f, 0.04f,  // side
     -0.06f, 0.33f, 0.40f, 0.13f, 0.00f, 0.00f, 0.00f, 0.00f,
     0.19f, 0.12f, 0.17f, 0.30f, 0.24f, 0.15f, 0.20f, 0.39f},
    {0.02f, 0.23f, 0.11f, 0.14f, 0.10f, 0.18f, 0.06f, 0.13f,  // class
     0.08f, 0.03f, 0.29f, 0.12f, 0.00f, 0.00f, 0.00f, 0.00f,
     0.22f, 0.15f, 0.15f, 0.23f, 0.17f, 0.07f, 0.14f, 0.46f},
    {0.05f, 0.19f, 0.12f, 0.11f, 0.07f, 0.31f, 0.04f, 0.06f,  // first digit
     0.11f, 0.08f, 0.26f, 0.07f, 0.00f, 0.00f, 0.00f, 0.00f,
     0.28f, 0.21f, 0.27f, 0.36f, 0.10f, 0.08f, 0.09f, 0.45f},
    {0.06f, 0.19f, 0.12f, 0.11f, 0.08f, 0.31f, 0.05f, 0.08f,  // second digit
     0.11f, 0.07f, 0.22f, 0.06f, 0.00f, 0.00f, 0.00f, 0.00f,
     0.32f, 0.23f, 0.29f, 0.42f, 0.10f, 0.06f, 0.06f, 0.44f},
    {0.08f, 0.08f, 0.08f, 0.08f, 0.08f, 0.08f, 0.08f, 0.08f,  // deeper digits
     0.11f, 0.16f, 0.12f, 0.03f, 0.00f, 0.00f, 0.00f, 0.00f,
     0.46f, 0.37f, 0.33f, 0.45f, 0.14f, 0.10f, 0.08f, 0.51f},
}};

}  // namespace ebz::positions
