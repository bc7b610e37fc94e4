// SPDX-License-Identifier: BSD-3-Clause
#include "solver/arc_elimination_kernels.hpp"

namespace hjt
{
namespace arcs
{
const Kernels AVX2 = kernels();
}  // namespace arcs
}  // namespace hjt
