// SPDX-License-Identifier: BSD-3-Clause
// Number type of the elimination, and the matrix that it leaves. Included as arc_elimination_kernels.hpp is.
#pragma once

#include "solver/arc_elimination.hpp"

namespace hjt
{
namespace arcs
{
namespace
{
/// One number for each arc; the compiler takes as many instructions as the processor's vectors need.
typedef double Lanes __attribute__((vector_size(32), may_alias));

typedef long long Choice __attribute__((vector_size(32)));

inline Lanes* lanes(double* values)
{
  return reinterpret_cast<Lanes*>(values);
}

inline const Lanes* lanes(const double* values)
{
  return reinterpret_cast<const Lanes*>(values);
}

inline bool factorSchur(double* matrix, SchurFactors& factors)
{
  constexpr int LANES = SCHUR / COUNT;  // a row
  bool positive = true;
#pragma GCC unroll 16
  for (int k = 0; k < SCHUR; ++k)
  {
    const double* row = matrix + SCHUR * k;
    const double pivot = row[k];
    const double inverse = 1.0 / pivot;
    positive = positive && pivot > 0.0 && inverse > 0.0;  // and not infinite
    factors.inverse_pivots[k] = inverse;
    for (int i = 0; i < SCHUR; ++i)
    {
      const double share = i > k ? row[i] * inverse : 0.0;
      factors.upper[k][i] = share;
      factors.lower[i][k] = share;
    }
    for (int i = k + 1; i < SCHUR; ++i)
    {
      const double share = factors.upper[k][i];
#pragma GCC unroll 16
      for (int v = i / COUNT; v < LANES; ++v)
      {
        lanes(matrix + SCHUR * i)[v] -= share * lanes(row)[v];
      }
    }
  }
  return positive;
}

inline void solveSchur(const SchurFactors& factors, double* b)
{
  constexpr int LANES = SCHUR / COUNT;
#pragma GCC unroll 16
  for (int k = 0; k < SCHUR; ++k)
  {
    const double value = b[k];
#pragma GCC unroll 16
    for (int v = k / COUNT; v < LANES; ++v)
    {
      lanes(b)[v] -= value * lanes(factors.upper[k])[v];
    }
  }
#pragma GCC unroll 16
  for (int v = 0; v < LANES; ++v)
  {
    lanes(b)[v] *= lanes(factors.inverse_pivots)[v];
  }
#pragma GCC unroll 16
  for (int k = SCHUR - 1; k > 0; --k)
  {
    const double value = b[k];
#pragma GCC unroll 16
    for (int v = 0; v <= k / COUNT; ++v)
    {
      lanes(b)[v] -= value * lanes(factors.lower[k])[v];
    }
  }
}
}  // namespace
}  // namespace arcs
}  // namespace hjt
