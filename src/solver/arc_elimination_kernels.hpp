// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// This file holds the elimination, its number type and its matrix. Each file for a kind of processor includes it and is
// compiled for that kind. The linker must not mix functions of different kinds. Therefore all names are in an unnamed
// namespace, and the file uses no library functions.

#include "solver/arc_elimination.hpp"

namespace hjt
{
namespace arcs
{
namespace
{
/// One number for each arc. The compiler uses as many instructions as the processor's vectors need.
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
  constexpr int LANES = SCHUR / COUNT;  // vectors in a row of the matrix
  bool positive = true;
#pragma GCC unroll 16
  for (int k = 0; k < SCHUR; ++k)
  {
    const double* row = matrix + SCHUR * k;
    const double pivot = row[k];
    const double inverse = 1.0 / pivot;
    positive = positive && pivot > 0.0 && inverse > 0.0;  // inverse is 0 for an infinite pivot
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

/// Vector whose lane k holds values[stride * first[k]].
inline Lanes gather(const Layout& layout, const double* values, int stride = 1)
{
  const int* first = layout.first;
  return Lanes{ values[stride * first[0]], values[stride * first[1]], values[stride * first[2]],
                values[stride * first[3]] };
}

/// Replaces the values of the lanes that have no tooth at step 0 by `value`.
inline Lanes patch(const Layout& layout, Lanes values, double value)
{
  const Choice idle{ -layout.idle[0], -layout.idle[1], -layout.idle[2], -layout.idle[3] };
  return idle ? value + Lanes{} : values;
}

/// Factors of a tooth: the inverse of its block, and the inverse times the couplings to the next two teeth.
struct Weights
{
  Lanes inverse_xx, inverse_xy, inverse_yy;
  Lanes next_xx, next_xy, next_yx, next_yy;
  Lanes second_xx, second_xy, second_yx, second_yy;
};

/// Factors of a tooth, with the products of the inverse and the tooth's couplings to the BORDER columns.
struct Factors : Weights
{
  Lanes border_x[BORDER], border_y[BORDER];
};
static_assert(sizeof(Factors) == FACTOR_ENTRIES * sizeof(Lanes), "FACTOR_ENTRIES does not match Factors");

/// Couplings of the first two teeth of each arc to the preceding separator, for the first three steps.
struct Seeds
{
  Seeds(const Layout& layout, const Tangent& tangent) : x{}, y{}
  {
    for (int k = 0; k < COUNT; ++k)
    {
      const int first = layout.idle[k] ? 1 : 0;
      const int b = layout.first[k] + first - 1;
      const int a = b - 1;
      x[first][0][k] = tangent.second[0][a];
      y[first][0][k] = tangent.second[1][a];
      x[first][1][k] = tangent.second[2][a];
      y[first][1][k] = tangent.second[3][a];
      x[first][2][k] = tangent.next[0][b];
      y[first][2][k] = tangent.next[1][b];
      x[first][3][k] = tangent.next[2][b];
      y[first][3][k] = tangent.next[3][b];
      x[first + 1][2][k] = tangent.second[0][b];
      y[first + 1][2][k] = tangent.second[1][b];
      x[first + 1][3][k] = tangent.second[2][b];
      y[first + 1][3][k] = tangent.second[3][b];
    }
  }

  Lanes x[3][BORDER];
  Lanes y[3][BORDER];
};

/// Entries of the tangent for a tooth, before the elimination of the preceding teeth changes these entries.
struct Fresh
{
  Lanes xx, xy, yy;    // block of the tooth
  Lanes next[4];       // couplings to the next tooth
  Lanes second[4];     // couplings to the second next tooth
  Lanes cup_x, cup_y;  // couplings to the cup
};

/// Contributions of the eliminated teeth to the next two teeth: to their blocks and to their couplings to the border.
struct Carried
{
  Lanes d_xx{}, d_xy{}, d_yy{};
  Lanes n_xx{}, n_xy{}, n_yx{}, n_yy{};
  Lanes e_xx{}, e_xy{}, e_yy{};
  Lanes bx[BORDER], by[BORDER], cx[BORDER], cy[BORDER];
};

inline __attribute__((always_inline)) Fresh freshRows(const Layout& layout, const Tangent& tangent, int t)
{
  Fresh fresh;
  fresh.xx = gather(layout, tangent.diagonal[0] + t);
  fresh.xy = gather(layout, tangent.diagonal[1] + t);
  fresh.yy = gather(layout, tangent.diagonal[2] + t);
  for (int e = 0; e < 4; ++e)
  {
    fresh.next[e] = gather(layout, tangent.next[e] + t);
    fresh.second[e] = gather(layout, tangent.second[e] + t);
  }
  fresh.cup_x = gather(layout, tangent.cup + 2 * t, 2);
  fresh.cup_y = gather(layout, tangent.cup + 2 * t + 1, 2);
  if (t == 0)
  {
    fresh.xx = patch(layout, fresh.xx, 1.0);
    fresh.xy = patch(layout, fresh.xy, 0.0);
    fresh.yy = patch(layout, fresh.yy, 1.0);
    for (int e = 0; e < 4; ++e)
    {
      fresh.next[e] = patch(layout, fresh.next[e], 0.0);
      fresh.second[e] = patch(layout, fresh.second[e], 0.0);
    }
    fresh.cup_x = patch(layout, fresh.cup_x, 0.0);
    fresh.cup_y = patch(layout, fresh.cup_y, 0.0);
  }
  return fresh;
}

inline __attribute__((always_inline)) void factorTooth(const Fresh& fresh, Carried& carried, Weights& out)
{
  const Lanes a = fresh.xx + carried.d_xx;
  const Lanes b = fresh.xy + carried.d_xy;
  const Lanes c = fresh.yy + carried.d_yy;
  carried.n_xx += fresh.next[0];
  carried.n_xy += fresh.next[1];
  carried.n_yx += fresh.next[2];
  carried.n_yy += fresh.next[3];
  carried.bx[BORDER - 1] += fresh.cup_x;
  carried.by[BORDER - 1] += fresh.cup_y;
  const Lanes scale = 1.0 / (a * c - b * b);
  const Lanes i_xx = c * scale;
  const Lanes i_xy = -b * scale;
  const Lanes i_yy = a * scale;
  out.inverse_xx = i_xx;
  out.inverse_xy = i_xy;
  out.inverse_yy = i_yy;
  out.next_xx = i_xx * carried.n_xx + i_xy * carried.n_yx;
  out.next_xy = i_xx * carried.n_xy + i_xy * carried.n_yy;
  out.next_yx = i_xy * carried.n_xx + i_yy * carried.n_yx;
  out.next_yy = i_xy * carried.n_xy + i_yy * carried.n_yy;
  out.second_xx = i_xx * fresh.second[0] + i_xy * fresh.second[2];
  out.second_xy = i_xx * fresh.second[1] + i_xy * fresh.second[3];
  out.second_yx = i_xy * fresh.second[0] + i_yy * fresh.second[2];
  out.second_yy = i_xy * fresh.second[1] + i_yy * fresh.second[3];
}

/// Eliminates the tooth's couplings to the border: changes the sums and the border couplings of the next two teeth.
inline __attribute__((always_inline)) void factorBorder(const Weights& own, Carried& carried, Factors& out, Lanes* sum)
{
  for (int col = 0; col < BORDER; ++col)
  {
    const Lanes x = carried.bx[col];
    const Lanes y = carried.by[col];
    const Lanes wx = own.inverse_xx * x + own.inverse_xy * y;
    const Lanes wy = own.inverse_xy * x + own.inverse_yy * y;
    out.border_x[col] = wx;
    out.border_y[col] = wy;
    for (int row = 0; row <= col; ++row)
    {
      // The sums are in the order of the upper triangle by columns.
      *sum++ -= (row == col ? x : carried.bx[row]) * wx + (row == col ? y : carried.by[row]) * wy;
    }
  }
  for (int col = 0; col < BORDER; ++col)
  {
    const Lanes x = carried.bx[col];
    const Lanes y = carried.by[col];
    carried.bx[col] = carried.cx[col] - (own.next_xx * x + own.next_yx * y);
    carried.by[col] = carried.cy[col] - (own.next_xy * x + own.next_yy * y);
    carried.cx[col] = -(own.second_xx * x + own.second_yx * y);
    carried.cy[col] = -(own.second_xy * x + own.second_yy * y);
  }
}

/// Computes the contributions of the eliminated tooth to the blocks of the next two teeth.
inline __attribute__((always_inline)) void carryOn(const Fresh& fresh, const Weights& out, Carried& carried)
{
  const Lanes n_xx = carried.n_xx;
  const Lanes n_xy = carried.n_xy;
  const Lanes n_yx = carried.n_yx;
  const Lanes n_yy = carried.n_yy;
  const Lanes* s = fresh.second;
  carried.d_xx = carried.e_xx - (n_xx * out.next_xx + n_yx * out.next_yx);
  carried.d_xy = carried.e_xy - (n_xx * out.next_xy + n_yx * out.next_yy);
  carried.d_yy = carried.e_yy - (n_xy * out.next_xy + n_yy * out.next_yy);
  carried.e_xx = -(s[0] * out.second_xx + s[2] * out.second_yx);
  carried.e_xy = -(s[0] * out.second_xy + s[2] * out.second_yy);
  carried.e_yy = -(s[1] * out.second_xy + s[3] * out.second_yy);
  carried.n_xx = -(n_xx * out.second_xx + n_yx * out.second_yx);
  carried.n_xy = -(n_xx * out.second_xy + n_yx * out.second_yy);
  carried.n_yx = -(n_xy * out.second_xx + n_yy * out.second_yx);
  carried.n_yy = -(n_xy * out.second_xy + n_yy * out.second_yy);
}

inline void factor(const Layout& where, const Tangent& entries, double* factors, const Sums& sums)
{
  // Copies, because the compiler must assume that a store through a vector's pointer changes `where` and `entries`.
  const Layout layout = where;
  const Tangent tangent = entries;
  const Seeds seeds(layout, tangent);
  Carried carried;
  Lanes before[BEFORE_ENTRIES]{};
  for (int c = 0; c < BORDER; ++c)
  {
    carried.bx[c] = seeds.x[0][c];
    carried.by[c] = seeds.y[0][c];
    carried.cx[c] = seeds.x[1][c];
    carried.cy[c] = seeds.y[1][c];
  }
  Factors* out = reinterpret_cast<Factors*>(factors);
  for (int t = 0; t < layout.steps; ++t, ++out)
  {
    const Fresh fresh = freshRows(layout, tangent, t);
    Weights own;
    factorTooth(fresh, carried, own);
    static_cast<Weights&>(*out) = own;
    factorBorder(own, carried, *out, before);
    if (t == 0)
    {
      for (int col = 0; col < BORDER; ++col)
      {
        carried.cx[col] += seeds.x[2][col];
        carried.cy[col] += seeds.y[2][col];
      }
    }
    carryOn(fresh, own, carried);
  }
  for (int e = 0; e < BEFORE_ENTRIES; ++e)
  {
    lanes(sums.before)[e] = before[e];
  }
  const Lanes after[AFTER_ENTRIES] = { carried.d_xx, carried.d_xy, carried.d_yy, carried.n_xx, carried.n_xy,
                                       carried.n_yx, carried.n_yy, carried.e_xx, carried.e_xy, carried.e_yy };
  for (int e = 0; e < AFTER_ENTRIES; ++e)
  {
    lanes(sums.after)[e] = after[e];
  }
  for (int c = 0; c < BORDER; ++c)
  {
    lanes(sums.between)[c] = carried.bx[c];
    lanes(sums.between)[BORDER + c] = carried.by[c];
    lanes(sums.between)[2 * BORDER + c] = carried.cx[c];
    lanes(sums.between)[3 * BORDER + c] = carried.cy[c];
  }
}

template <int COLUMNS>
void forward(const Layout& where, const double* factors, const double* const* columns, double* rows, double* before,
             double* after)
{
  const Layout layout = where;
  const double* b[COLUMNS];
#pragma GCC unroll 8
  for (int c = 0; c < COLUMNS; ++c)
  {
    b[c] = columns[c];
  }
  Lanes px[COLUMNS]{}, py[COLUMNS]{}, qx[COLUMNS]{}, qy[COLUMNS]{};
  Lanes sum[BORDER][COLUMNS]{};
  const Factors* f = reinterpret_cast<const Factors*>(factors);
  Lanes* row = lanes(rows);
  for (int t = 0; t < layout.steps; ++t, ++f, row += 2 * COLUMNS)
  {
#pragma GCC unroll 8
    for (int c = 0; c < COLUMNS; ++c)
    {
      Lanes x = gather(layout, b[c] + 2 * t, 2);
      Lanes y = gather(layout, b[c] + 2 * t + 1, 2);
      if (t == 0)
      {
        x = patch(layout, x, 0.0);
        y = patch(layout, y, 0.0);
      }
      x += px[c];
      y += py[c];
      row[2 * c] = x;
      row[2 * c + 1] = y;
      px[c] = qx[c] - (f->next_xx * x + f->next_yx * y);
      py[c] = qy[c] - (f->next_xy * x + f->next_yy * y);
      qx[c] = -(f->second_xx * x + f->second_yx * y);
      qy[c] = -(f->second_xy * x + f->second_yy * y);
#pragma GCC unroll 8
      for (int e = 0; e < BORDER; ++e)
      {
        sum[e][c] -= f->border_x[e] * x + f->border_y[e] * y;
      }
    }
  }
#pragma GCC unroll 8
  for (int c = 0; c < COLUMNS; ++c)
  {
#pragma GCC unroll 8
    for (int e = 0; e < BORDER; ++e)
    {
      lanes(before)[BORDER * c + e] = sum[e][c];
    }
    lanes(after)[4 * c] = px[c];
    lanes(after)[4 * c + 1] = py[c];
    lanes(after)[4 * c + 2] = qx[c];
    lanes(after)[4 * c + 3] = qy[c];
  }
}

template <int COLUMNS>
void backward(const Layout& where, const double* factors, const double* rows, const double* before, const double* after,
              double* const* columns)
{
  const Layout layout = where;
  double* x[COLUMNS];
#pragma GCC unroll 8
  for (int c = 0; c < COLUMNS; ++c)
  {
    x[c] = columns[c];
  }
  Lanes px[COLUMNS], py[COLUMNS], qx[COLUMNS], qy[COLUMNS];
#pragma GCC unroll 8
  for (int c = 0; c < COLUMNS; ++c)
  {
    px[c] = lanes(after)[4 * c];
    py[c] = lanes(after)[4 * c + 1];
    qx[c] = lanes(after)[4 * c + 2];
    qy[c] = lanes(after)[4 * c + 3];
  }
  const Factors* f = reinterpret_cast<const Factors*>(factors) + layout.steps;
  const Lanes* row = lanes(rows) + 2 * COLUMNS * layout.steps;
  for (int t = layout.steps - 1; t >= 0; --t)
  {
    --f;
    row -= 2 * COLUMNS;
#pragma GCC unroll 8
    for (int c = 0; c < COLUMNS; ++c)
    {
      const Lanes rx = row[2 * c];
      const Lanes ry = row[2 * c + 1];
      Lanes vx = f->inverse_xx * rx + f->inverse_xy * ry;
      Lanes vy = f->inverse_xy * rx + f->inverse_yy * ry;
#pragma GCC unroll 8
      for (int e = 0; e < BORDER; ++e)
      {
        vx -= f->border_x[e] * lanes(before)[BORDER * c + e];
        vy -= f->border_y[e] * lanes(before)[BORDER * c + e];
      }
      // The sum ends with the terms of the preceding steps, which are known last.
      vx -= f->second_xx * qx[c] + f->second_xy * qy[c];
      vy -= f->second_yx * qx[c] + f->second_yy * qy[c];
      vx -= f->next_xx * px[c] + f->next_xy * py[c];
      vy -= f->next_yx * px[c] + f->next_yy * py[c];
      qx[c] = px[c];
      qy[c] = py[c];
      px[c] = vx;
      py[c] = vy;
#pragma GCC unroll 8
      for (int k = 0; k < COUNT; ++k)
      {
        if (t > 0 || !layout.idle[k])
        {
          double* at = x[c] + 2 * (layout.first[k] + t);
          at[0] = vx[k];
          at[1] = vy[k];
        }
      }
    }
  }
}

constexpr Kernels kernels()
{
  return {
    factor, { forward<1>, forward<2>, forward<3> }, { backward<1>, backward<2>, backward<3> }, factorSchur, solveSchur
  };
}
}  // namespace
}  // namespace arcs
}  // namespace hjt
