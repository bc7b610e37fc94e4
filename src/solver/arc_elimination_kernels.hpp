// SPDX-License-Identifier: BSD-3-Clause
// The elimination itself. Included once for each kind of processor, in a file compiled for it; hence all in an unnamed
// namespace, and nothing of any library: the linker must not mix the kinds.
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

/// values[stride * tooth] of each lane's tooth.
inline Lanes gather(const Layout& layout, const double* values, int stride = 1)
{
  const int* first = layout.first;
  return Lanes{ values[stride * first[0]], values[stride * first[1]], values[stride * first[2]],
                values[stride * first[3]] };
}

/// The same with `value` in the lanes that idle at the first step.
inline Lanes patch(const Layout& layout, Lanes values, double value)
{
  const Choice idle{ -layout.idle[0], -layout.idle[1], -layout.idle[2], -layout.idle[3] };
  return idle ? value + Lanes{} : values;
}

/// What a tooth leaves: the inverse of its block, and that times its couplings.
struct Factors
{
  Lanes inverse_xx, inverse_xy, inverse_yy;
  Lanes next_xx, next_xy, next_yx, next_yy;
  Lanes second_xx, second_xy, second_yx, second_yy;
  Lanes border_x[BORDER], border_y[BORDER];
};
static_assert(sizeof(Factors) == FACTOR_ENTRIES * sizeof(Lanes), "entries a tooth");

/// Couplings of the first two teeth of each arc to the separator before it, at the first three steps.
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

inline void factor(const Layout& where, const Tangent& entries, double* factors, const Sums& sums)
{
  // Copies: what is stored through a vector's pointer might else be them.
  const Layout layout = where;
  const Tangent tangent = entries;
  const Seeds seeds(layout, tangent);
  // What the teeth eliminated so far add to the two that come next: blocks, and couplings to the border.
  Lanes d_xx{}, d_xy{}, d_yy{};
  Lanes n_xx{}, n_xy{}, n_yx{}, n_yy{};
  Lanes e_xx{}, e_xy{}, e_yy{};
  Lanes bx[BORDER], by[BORDER], cx[BORDER], cy[BORDER];
  Lanes before[BEFORE_ENTRIES]{};
  for (int c = 0; c < BORDER; ++c)
  {
    bx[c] = seeds.x[0][c];
    by[c] = seeds.y[0][c];
    cx[c] = seeds.x[1][c];
    cy[c] = seeds.y[1][c];
  }
  Factors* out = reinterpret_cast<Factors*>(factors);
  for (int t = 0; t < layout.steps; ++t, ++out)
  {
    Lanes a = gather(layout, tangent.diagonal[0] + t);
    Lanes b = gather(layout, tangent.diagonal[1] + t);
    Lanes c = gather(layout, tangent.diagonal[2] + t);
    Lanes fresh_n[4], s[4];
    for (int e = 0; e < 4; ++e)
    {
      fresh_n[e] = gather(layout, tangent.next[e] + t);
      s[e] = gather(layout, tangent.second[e] + t);
    }
    Lanes cup_x = gather(layout, tangent.cup + 2 * t, 2);
    Lanes cup_y = gather(layout, tangent.cup + 2 * t + 1, 2);
    if (t == 0)
    {
      a = patch(layout, a, 1.0);
      b = patch(layout, b, 0.0);
      c = patch(layout, c, 1.0);
      for (int e = 0; e < 4; ++e)
      {
        fresh_n[e] = patch(layout, fresh_n[e], 0.0);
        s[e] = patch(layout, s[e], 0.0);
      }
      cup_x = patch(layout, cup_x, 0.0);
      cup_y = patch(layout, cup_y, 0.0);
    }
    a += d_xx;
    b += d_xy;
    c += d_yy;
    n_xx += fresh_n[0];
    n_xy += fresh_n[1];
    n_yx += fresh_n[2];
    n_yy += fresh_n[3];
    bx[BORDER - 1] += cup_x;
    by[BORDER - 1] += cup_y;

    const Lanes scale = 1.0 / (a * c - b * b);
    const Lanes i_xx = c * scale;
    const Lanes i_xy = -b * scale;
    const Lanes i_yy = a * scale;
    out->inverse_xx = i_xx;
    out->inverse_xy = i_xy;
    out->inverse_yy = i_yy;
    const Lanes wn_xx = i_xx * n_xx + i_xy * n_yx;
    const Lanes wn_xy = i_xx * n_xy + i_xy * n_yy;
    const Lanes wn_yx = i_xy * n_xx + i_yy * n_yx;
    const Lanes wn_yy = i_xy * n_xy + i_yy * n_yy;
    const Lanes ws_xx = i_xx * s[0] + i_xy * s[2];
    const Lanes ws_xy = i_xx * s[1] + i_xy * s[3];
    const Lanes ws_yx = i_xy * s[0] + i_yy * s[2];
    const Lanes ws_yy = i_xy * s[1] + i_yy * s[3];
    out->next_xx = wn_xx;
    out->next_xy = wn_xy;
    out->next_yx = wn_yx;
    out->next_yy = wn_yy;
    out->second_xx = ws_xx;
    out->second_xy = ws_xy;
    out->second_yx = ws_yx;
    out->second_yy = ws_yy;

    d_xx = e_xx - (n_xx * wn_xx + n_yx * wn_yx);
    d_xy = e_xy - (n_xx * wn_xy + n_yx * wn_yy);
    d_yy = e_yy - (n_xy * wn_xy + n_yy * wn_yy);
    e_xx = -(s[0] * ws_xx + s[2] * ws_yx);
    e_xy = -(s[0] * ws_xy + s[2] * ws_yy);
    e_yy = -(s[1] * ws_xy + s[3] * ws_yy);

    Lanes* sum = before;
    for (int col = 0; col < BORDER; ++col)
    {
      const Lanes x = bx[col];
      const Lanes y = by[col];
      const Lanes wx = i_xx * x + i_xy * y;
      const Lanes wy = i_xy * x + i_yy * y;
      out->border_x[col] = wx;
      out->border_y[col] = wy;
      for (int row = 0; row <= col; ++row)
      {
        // (row, col) of the upper triangle by columns
        *sum++ -= (row == col ? x : bx[row]) * wx + (row == col ? y : by[row]) * wy;
      }
    }
    for (int col = 0; col < BORDER; ++col)
    {
      const Lanes x = bx[col];
      const Lanes y = by[col];
      bx[col] = cx[col] - (wn_xx * x + wn_yx * y);
      by[col] = cy[col] - (wn_xy * x + wn_yy * y);
      cx[col] = -(ws_xx * x + ws_yx * y);
      cy[col] = -(ws_xy * x + ws_yy * y);
    }
    if (t == 0)
    {
      for (int col = 0; col < BORDER; ++col)
      {
        cx[col] += seeds.x[2][col];
        cy[col] += seeds.y[2][col];
      }
    }
    const Lanes m_xx = -(n_xx * ws_xx + n_yx * ws_yx);
    const Lanes m_xy = -(n_xx * ws_xy + n_yx * ws_yy);
    const Lanes m_yx = -(n_xy * ws_xx + n_yy * ws_yx);
    const Lanes m_yy = -(n_xy * ws_xy + n_yy * ws_yy);
    n_xx = m_xx;
    n_xy = m_xy;
    n_yx = m_yx;
    n_yy = m_yy;
  }
  for (int e = 0; e < BEFORE_ENTRIES; ++e)
  {
    lanes(sums.before)[e] = before[e];
  }
  const Lanes after[AFTER_ENTRIES] = { d_xx, d_xy, d_yy, n_xx, n_xy, n_yx, n_yy, e_xx, e_xy, e_yy };
  for (int e = 0; e < AFTER_ENTRIES; ++e)
  {
    lanes(sums.after)[e] = after[e];
  }
  for (int c = 0; c < BORDER; ++c)
  {
    lanes(sums.between)[c] = bx[c];
    lanes(sums.between)[BORDER + c] = by[c];
    lanes(sums.between)[2 * BORDER + c] = cx[c];
    lanes(sums.between)[3 * BORDER + c] = cy[c];
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
      // What the next step waits for comes last.
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

constexpr Kernels kernels(const char* name)
{
  return { name,        factor,    { forward<1>, forward<2>, forward<3> }, { backward<1>, backward<2>, backward<3> },
           factorSchur, solveSchur };
}
}  // namespace
}  // namespace arcs
}  // namespace hjt
