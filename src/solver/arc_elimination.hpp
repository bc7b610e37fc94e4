// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace hjt
{
/// The ring cut into four arcs by four separators of two teeth each. All four arcs are eliminated at once, one in each
/// lane of a vector of four numbers: no shuffling, and four chains of dependent operations side by side.
///
/// Rows and arrays of lanes: number of lane k of entry e at [4 e + k]. All arrays are the caller's, aligned to 32
/// bytes.
namespace arcs
{
constexpr int COUNT = 4;
constexpr int BORDER = 5;  ///< columns every tooth of an arc couples to: the separator before the arc, and the cup

// Factors of an eliminated tooth for the substitutions, in entries of lanes.
constexpr int FACTOR_ENTRIES = 21;
// Sums over an arc for the separators: their own block with the cup's, the one after the arc, and between the two.
constexpr int BEFORE_ENTRIES = BORDER * (BORDER + 1) / 2;
constexpr int AFTER_ENTRIES = 10;
constexpr int BETWEEN_ENTRIES = 4 * BORDER;

constexpr int SCHUR = 4 * COUNT;  ///< unknowns of the separators

/// Layout of the arcs. Lane k eliminates tooth first[k] + t at step t; its separator is the two teeth before its arc.
struct Layout
{
  int steps;         ///< length of the longest arc
  int first[COUNT];  ///< at the first step
  bool idle[COUNT];  ///< a shorter arc has nothing to eliminate at the first step: first[k] is its separator's end
};

/// Entries of the ring's tangent, one array each.
struct Tangent
{
  const double* diagonal[3];  ///< xx, xy, yy
  const double* next[4];      ///< xx, xy, yx, yy
  const double* second[4];    ///< xx, xy, yx, yy
  const double* cup;          ///< 2 a tooth
};

struct Sums
{
  double* before;  ///< BEFORE_ENTRIES: upper triangle by columns, to add
  double*
      after;  ///< AFTER_ENTRIES: first tooth xx, xy, yy; first with second xx, xy, yx, yy; second xx, xy, yy; to add
  double* between;  ///< BETWEEN_ENTRIES: four rows of the separator after the arc by BORDER columns
};

/// Of the symmetric matrix of the separators; the unit triangle's diagonal and what is beyond it are left out, as
/// zeros.
struct alignas(32) SchurFactors
{
  double upper[SCHUR][SCHUR];
  double lower[SCHUR][SCHUR];  ///< its transpose
  double inverse_pivots[SCHUR];
};

/// Code for one kind of processor. What is solved has the same bits by each.
struct Kernels
{
  void (*factor)(const Layout& layout, const Tangent& tangent, double* factors, const Sums& sums);

  /// Eliminates right-hand sides `b` (a pointer each to 2 rows a tooth; [0], [1], [2] for 1, 2, 3 of them).
  /// `rows`: 2 entries a step and column. `before`: BORDER entries a column, `after`: 4 entries a column; to add.
  void (*forward[3])(const Layout& layout, const double* factors, const double* const* b, double* rows, double* before,
                     double* after);

  /// Solutions of the arcs from those of the separators. `before`, `after`: as above, the values themselves.
  void (*backward[3])(const Layout& layout, const double* factors, const double* rows, const double* before,
                      const double* after, double* const* x);

  /// U^T D U of the symmetric matrix of the separators, SCHUR x SCHUR, of which the upper triangle is read and
  /// destroyed. Without pivoting: false if a pivot is not positive, which it is while the matrix is positive definite.
  bool (*factor_schur)(double* matrix, SchurFactors& factors);

  /// Solves for SCHUR unknowns, in place.
  void (*solve_schur)(const SchurFactors& factors, double* b);
};

extern const Kernels BASELINE;  ///< for every processor of the architecture
#ifdef HJT_AVX2
extern const Kernels AVX2;    ///< x86-64 with AVX2
extern const Kernels AVX512;  ///< with AVX-512 VL and DQ: the same vectors, twice the registers
#endif

/// The fastest that this processor can run.
const Kernels& fastest() noexcept;
}  // namespace arcs
}  // namespace hjt
