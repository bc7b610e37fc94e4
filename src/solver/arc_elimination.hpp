// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace hjt
{
/// Elimination of the ring, which four separators of two teeth each cut into four arcs. The four lanes of a vector
/// eliminate the four arcs at once: no shuffling, and four independent chains of operations.
///
/// In arrays of lanes, the number of lane k and entry e has the index 4 e + k. The caller owns all arrays and aligns
/// them to 32 bytes.
namespace arcs
{
constexpr int COUNT = 4;
/// number of columns that couple to every tooth of an arc: those of the preceding separator, and the cup
constexpr int BORDER = 5;

// Size of the factors of an eliminated tooth, in entries of lanes.
constexpr int FACTOR_ENTRIES = 21;
// Sizes of the sums over an arc for the separators: block of the preceding one with the cup, block of the next one, and
// the block between them.
constexpr int BEFORE_ENTRIES = BORDER * (BORDER + 1) / 2;
constexpr int AFTER_ENTRIES = 10;
constexpr int BETWEEN_ENTRIES = 4 * BORDER;

constexpr int SCHUR = 4 * COUNT;  ///< number of unknowns of the separators

/// Layout of the arcs. Step t eliminates tooth first[k] + t in lane k. The separator of lane k is the two teeth before
/// its arc.
struct Layout
{
  int steps;         ///< length of the longest arc
  int first[COUNT];  ///< tooth of the first step
  /// the arc is shorter and has no tooth at the first step: first[k] is the last tooth of its separator
  bool idle[COUNT];
};

/// Entries of the ring's tangent, one array for each.
struct Tangent
{
  const double* diagonal[3];  ///< xx, xy, yy
  const double* next[4];      ///< xx, xy, yx, yy
  const double* second[4];    ///< xx, xy, yx, yy
  const double* cup;          ///< two for each tooth
};

struct Sums
{
  double* before;   ///< BEFORE_ENTRIES sums, upper triangle by columns
  double* after;    ///< AFTER_ENTRIES sums: first tooth xx, xy, yy; first with second xx, xy, yx, yy; second xx, xy, yy
  double* between;  ///< BETWEEN_ENTRIES sums: four rows of the next separator by BORDER columns
};

/// Factors of the symmetric matrix of the separators. The entries on and beyond the unit triangle's diagonal are not
/// stored and are zero.
struct alignas(32) SchurFactors
{
  double upper[SCHUR][SCHUR];
  double lower[SCHUR][SCHUR];  ///< transpose of the upper factor
  double inverse_pivots[SCHUR];
};

/// The functions, compiled for one kind of processor. All kinds give bitwise equal results.
struct Kernels
{
  void (*factor)(const Layout& layout, const Tangent& tangent, double* factors, const Sums& sums);

  /// Eliminates 1, 2 or 3 right-hand sides `b`, each with 2 rows for each tooth. `rows`: 2 entries for each step and
  /// column. `before`, `after`: sums with BORDER and 4 entries for each column.
  void (*forward[3])(const Layout& layout, const double* factors, const double* const* b, double* rows, double* before,
                     double* after);

  /// Computes the solutions of the arcs from those of the separators. `before`, `after`: solutions of the separators.
  void (*backward[3])(const Layout& layout, const double* factors, const double* rows, const double* before,
                      const double* after, double* const* x);

  /// Factors the symmetric matrix of the separators, SCHUR x SCHUR, as U^T D U. It reads and overwrites the upper
  /// triangle. There is no pivoting: @returns false if a pivot is not positive, that is, if the matrix is not positive
  /// definite.
  bool (*factor_schur)(double* matrix, SchurFactors& factors);

  /// Solves for the SCHUR unknowns in place.
  void (*solve_schur)(const SchurFactors& factors, double* b);
};

extern const Kernels BASELINE;  ///< for every processor of the architecture
#ifdef HJT_AVX2
extern const Kernels AVX2;    ///< x86-64 with AVX2
extern const Kernels AVX512;  ///< x86-64 with AVX-512 VL and DQ: vectors as in AVX2, twice as many registers
#endif

/// Kernels of the fastest kind that this processor supports.
const Kernels& fastest() noexcept;
}  // namespace arcs
}  // namespace hjt
