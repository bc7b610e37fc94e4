// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>

/// Before a function whose loops over the teeth vectorise: compiled for every x86-64 and for AVX2; the processor
/// decides when the library is loaded, before the thread sanitizer could watch it. Elsewhere it says nothing. Not for
/// AVX-512, which brings FMA: GCC 12 makes vfmaddsub of a product's sum beside its difference, whatever -ffp-contract
/// says.
#if defined(HJT_AVX2) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_THREAD__)
#define HJT_VECTOR_CLONES __attribute__((target_clones("avx2", "default")))
#else
#define HJT_VECTOR_CLONES
#endif

namespace hjt
{
/// Sums over teeth or terms of friction, whose bits do not depend on the width of the processor's vectors. A simd
/// reduction adds in an order that the width decides; here the terms are computed in vectors, put down, and added in an
/// order of their own. `terms(i, rows, k)` writes N terms of place i to rows[0 ... N-1][k]; what else it writes, it
/// writes at no place of another i. A local array of them, and GCC makes no vectors of the loop.
namespace block_sums
{
constexpr int BLOCK = 32;
constexpr int LANES = 8;  // partial sums: as many as the widest vector has numbers

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

/// N sums of `count` terms each, from place `first` on.
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

/// The same of one term a place, which `term(i)` returns.
template <class Term>
inline __attribute__((always_inline)) double blockSum(int first, int count, const Term& term) noexcept
{
  return blockSums<1>(first, count, [&](int i, auto& rows, int k) { rows[0][k] = term(i); })[0];
}

/// The same of a few terms, a dozen or so: added one after the other.
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
