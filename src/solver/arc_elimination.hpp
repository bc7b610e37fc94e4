// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace hjt
{
/// Elimination of the unknowns of the ring's teeth. Four separators of two teeth each divide the ring into four arcs.
/// Each of the four lanes of a processor vector eliminates one arc. No value moves from one lane to another.
///
/// In arrays of lanes, entry e of lane k has the index 4 e + k. The caller owns the arrays and aligns them to 32 bytes.
namespace arcs
{
constexpr int COUNT = 4;
/// number of columns that couple to every tooth of an arc: four of the preceding separator and one of the cup
constexpr int BORDER = 5;

// Number of factors of an eliminated tooth in one lane.
constexpr int FACTOR_ENTRIES = 21;
// Numbers of sums that an arc adds to the matrix of the separators: for the block of the preceding separator and the
// cup, for the block of the next separator, and for the block that couples these two blocks.
constexpr int BEFORE_ENTRIES = BORDER * (BORDER + 1) / 2;
constexpr int AFTER_ENTRIES = 10;
constexpr int BETWEEN_ENTRIES = 4 * BORDER;

constexpr int SCHUR = 4 * COUNT;  ///< number of unknowns of the separators

/// Layout of the arcs. Step t eliminates tooth first[k] + t in lane k. The two teeth before an arc are its separator.
struct Layout
{
  int steps;         ///< length of the longest arc [teeth]
  int first[COUNT];  ///< tooth of each lane at step 0
  /// whether the arc of a lane is shorter and has no tooth at step 0; first[k] is then the last tooth of its separator
  bool idle[COUNT];
};

/// Entries of the ring's tangent (RingTangent), with one array for each entry of a block.
struct Tangent
{
  const double* diagonal[3];  ///< block of each tooth with itself: xx, xy, yy
  const double* next[4];      ///< block of each tooth with the next tooth: xx, xy, yx, yy
  const double* second[4];    ///< block of each tooth with the second next tooth: xx, xy, yx, yy
  const double* cup;          ///< couplings of x and y of each tooth to the cup
};

struct Sums
{
  double* before;  ///< BEFORE_ENTRIES sums for the preceding separator and the cup: upper triangle by columns
  /// AFTER_ENTRIES sums for the next separator: xx, xy, yy of its first tooth; xx, xy, yx, yy between its teeth; xx,
  /// xy, yy of its second tooth
  double* after;
  double* between;  ///< BETWEEN_ENTRIES sums: four rows of the next separator by BORDER columns
};

/// Factors U and D of the symmetric matrix U^T D U of the separators. The diagonal of U, which is 1, is stored as 0.
struct alignas(32) SchurFactors
{
  double upper[SCHUR][SCHUR];
  double lower[SCHUR][SCHUR];  ///< transpose of `upper`
  double inverse_pivots[SCHUR];
};

/// Functions of the elimination, compiled for one kind of processor. All kinds give bitwise equal results.
struct Kernels
{
  void (*factor)(const Layout& layout, const Tangent& tangent, double* factors, const Sums& sums);

  /// Eliminates 1, 2 or 3 right-hand sides `b`, each with 2 rows for each tooth. `rows`: 2 entries for each step and
  /// column. `before`, `after`: sums for the separators, with BORDER and 4 entries for each column.
  void (*forward[3])(const Layout& layout, const double* factors, const double* const* b, double* rows, double* before,
                     double* after);

  /// Computes the solutions of the arcs from those of the separators. `before`, `after`: solutions of the separators
  /// before (with the cup) and after each arc.
  void (*backward[3])(const Layout& layout, const double* factors, const double* rows, const double* before,
                      const double* after, double* const* x);

  /// Factors the symmetric matrix of the separators, SCHUR x SCHUR, as U^T D U without pivoting. Overwrites the upper
  /// triangle. @returns false if the matrix is not positive definite.
  bool (*factor_schur)(double* matrix, SchurFactors& factors);

  /// Solves for the SCHUR unknowns of the separators. `b`: right-hand side, replaced by the solution.
  void (*solve_schur)(const SchurFactors& factors, double* b);
};

extern const Kernels BASELINE;  ///< kernels for every processor of the architecture
#ifdef HJT_AVX2
extern const Kernels AVX2;    ///< kernels for x86-64 with AVX2
extern const Kernels AVX512;  ///< for AVX-512 VL and DQ: vectors as long as with AVX2, twice as many registers
#endif

/// Kernels of the fastest kind that this processor supports.
const Kernels& fastest() noexcept;
}  // namespace arcs
}  // namespace hjt
