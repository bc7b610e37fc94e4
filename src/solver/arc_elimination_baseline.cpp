// SPDX-License-Identifier: BSD-3-Clause
#include "solver/arc_elimination_kernels.hpp"

namespace hjt
{
namespace arcs
{
const Kernels BASELINE = kernels();

const Kernels& fastest() noexcept
{
#ifdef HJT_AVX2
  if (__builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512dq"))
  {
    return AVX512;
  }
  if (__builtin_cpu_supports("avx2"))
  {
    return AVX2;
  }
#endif
  return BASELINE;
}
}  // namespace arcs
}  // namespace hjt
