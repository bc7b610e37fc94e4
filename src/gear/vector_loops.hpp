// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>

/// Attribute of a function with loops over the teeth. The compiler makes one version for any x86-64 processor and one
/// for AVX2, and the library's loader selects a version. The attribute is empty on other platforms, and with the thread
/// sanitizer, which cannot watch this selection. There is no version for AVX-512, because AVX-512 implies FMA, and GCC
/// 12 then fuses a product with a sum even with -ffp-contract=off.
#if defined(HJT_AVX2) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_THREAD__)
#define HJT_VECTOR_CLONES __attribute__((target_clones("avx2", "default")))
#else
#define HJT_VECTOR_CLONES
#endif

namespace hjt
{
/// Sums over teeth or friction terms whose bits do not depend on the width of the processor's vectors. A SIMD reduction
/// would add in an order that depends on this width. These sums store the vectorised terms and add them in a fixed
/// order. `terms(i, rows, k)` writes the N terms of index i to rows[0 ... N-1][k] and must not write to data of another
/// i. In `terms`, a local array would prevent GCC from vectorising the loop.
namespace block_sums
{
constexpr int BLOCK = 32;
constexpr int LANES = 8;  // number of partial sums, equal to the largest vector width

template <int N, int SIZE, class Terms>
inline __attribute__((always_inline)) void fill(int first, int count, const Terms& terms, double (&block)[N][SIZE])
{
#pragma omp simd
  for (int k = 0; k < count; ++k)
  {
    terms(first + k, block, k);
  }
}

template <int N>
inline __attribute__((always_inline)) void add(const double (&block)[N][BLOCK], double (&parts)[N][LANES])
{
  for (int m = 0; m < N; ++m)
  {
#pragma omp simd
    for (int k = 0; k < LANES; ++k)
    {
      parts[m][k] += (block[m][k] + block[m][k + LANES]) + (block[m][k + 2 * LANES] + block[m][k + 3 * LANES]);
    }
  }
}
}  // namespace block_sums

/// N sums of `terms` over the indices first ... first + count - 1.
template <int N, class Terms>
inline __attribute__((always_inline)) std::array<double, N> blockSums(int first, int count, const Terms& terms) noexcept
{
  using namespace block_sums;
  alignas(64) double block[N][BLOCK];
  alignas(64) double parts[N][LANES] = {};
  int done = 0;
  for (; done + BLOCK <= count; done += BLOCK)
  {
    fill<N>(first + done, BLOCK, terms, block);
    add<N>(block, parts);
  }
  if (done < count)
  {
    for (int m = 0; m < N; ++m)
    {
      std::fill(block[m], block[m] + BLOCK, 0.0);
    }
    fill<N>(first + done, count - done, terms, block);
    add<N>(block, parts);
  }
  std::array<double, N> sums;
  for (std::size_t m = 0; m < N; ++m)
  {
    const double* p = parts[m];
    sums[m] = ((p[0] + p[4]) + (p[2] + p[6])) + ((p[1] + p[5]) + (p[3] + p[7]));
  }
  return sums;
}

/// Sum of `term(i)` over the indices i = first ... first + count - 1.
template <class Term>
inline __attribute__((always_inline)) double blockSum(int first, int count, const Term& term) noexcept
{
  return blockSums<1>(first, count, [&](int i, auto& rows, int k) { rows[0][k] = term(i); })[0];
}

/// N sums over `count` indices from 0, meant for a dozen indices or fewer. The terms are added one after the other.
template <int N, class Terms>
inline __attribute__((always_inline)) std::array<double, N> fewSums(int count, const Terms& terms) noexcept
{
  constexpr int FEW = 16;
  alignas(64) double block[N][FEW];
  std::array<double, N> sums{};
  for (int done = 0; done < count; done += FEW)
  {
    const int here = std::min(FEW, count - done);
    block_sums::fill<N>(done, here, terms, block);
    for (int k = 0; k < here; ++k)
    {
      for (std::size_t m = 0; m < N; ++m)
      {
        sums[m] += block[m][k];
      }
    }
  }
  return sums;
}
}  // namespace hjt
