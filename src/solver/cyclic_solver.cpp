// SPDX-License-Identifier: BSD-3-Clause
#include "harmonic_joint_twin/solver/cyclic_solver.hpp"

namespace hjt
{
using arcs::BORDER;
using arcs::COUNT;

CyclicSolver::CyclicSolver(int teeth, const arcs::Kernels& kernels)
  : kernels_(kernels)
  , layout_{ (teeth - 2 * COUNT + COUNT - 1) / COUNT, {}, {} }
  , separator_{}
  , factors_(static_cast<std::size_t>(arcs::FACTOR_ENTRIES * layout_.steps))
  , rows_(static_cast<std::size_t>(2 * MAX_COLUMNS * layout_.steps))
{
  int tooth = 0;
  for (int k = 0; k < COUNT; ++k)
  {
    const int length = (teeth - 2 * COUNT + k) / COUNT;
    separator_[k] = tooth;
    layout_.idle[k] = length < layout_.steps;
    layout_.first[k] = tooth + (layout_.idle[k] ? 1 : 2);
    tooth += 2 + length;
  }
}

bool CyclicSolver::factor(const RingTangent& tangent) noexcept
{
  const ToothBlocks& d = tangent.diagonal;
  const ToothBlocks& n = tangent.next;
  const ToothBlocks& s = tangent.second;
  const arcs::Tangent entries{ { d.xx.data(), d.xy.data(), d.yy.data() },
                               { n.xx.data(), n.xy.data(), n.yx.data(), n.yy.data() },
                               { s.xx.data(), s.xy.data(), s.yx.data(), s.yy.data() },
                               tangent.cup_direction.data() };
  Entry before[arcs::BEFORE_ENTRIES];
  Entry after[arcs::AFTER_ENTRIES];
  Entry between[arcs::BETWEEN_ENTRIES];
  kernels_.factor(layout_, entries, factors_.data()->lane, { before->lane, after->lane, between->lane });

  // The upper triangle; the lower follows.
  Corner corner = Corner::Zero();
  const int cup = SEPARATORS;
  corner(cup, cup) = -1.0 / tangent.cup_stiffness;
  for (int k = 0; k < COUNT; ++k)
  {
    const int a = separator_[k];
    const int own = 4 * k;
    corner.block<2, 2>(own, own) += d.at(a);
    corner.block<2, 2>(own, own + 2) += n.at(a);
    corner.block<2, 2>(own + 2, own + 2) += d.at(a + 1);
    corner.block<4, 1>(own, cup) += tangent.cup_direction.segment<4>(2 * a);
    const auto index = [&](int c) { return c < 4 ? own + c : cup; };
    const Entry* sum = before;
    for (int c = 0; c < BORDER; ++c)
    {
      for (int r = 0; r <= c; ++r)
      {
        corner(index(r), index(c)) += (sum++)->lane[k];
      }
    }
    const int next = 4 * ((k + 1) % COUNT);
    constexpr int ROWS[arcs::AFTER_ENTRIES] = { 0, 0, 1, 0, 0, 1, 1, 2, 2, 3 };
    constexpr int COLS[arcs::AFTER_ENTRIES] = { 0, 1, 1, 2, 3, 2, 3, 2, 3, 3 };
    for (int e = 0; e < arcs::AFTER_ENTRIES; ++e)
    {
      corner(next + ROWS[e], next + COLS[e]) += after[e].lane[k];
    }
    for (int r = 0; r < 4; ++r)
    {
      for (int c = 0; c < BORDER; ++c)
      {
        const double value = between[BORDER * r + c].lane[k];
        const int i = next + r;
        const int j = index(c);
        corner(std::min(i, j), std::max(i, j)) += value;
      }
    }
  }
  corner.triangularView<Eigen::StrictlyLower>() = corner.transpose();
  corner_.compute(corner);
  const Corner& lu = corner_.matrixLU();
  return lu.allFinite() && (lu.diagonal().array() != 0.0).all();
}

void CyclicSolver::solve(double* b, int columns) noexcept
{
  Entry before[BORDER * MAX_COLUMNS];
  Entry after[4 * MAX_COLUMNS];
  kernels_.forward[columns - 1](layout_, factors_.data()->lane, b, rows_.data()->lane, before->lane, after->lane);
  for (int c = 0; c < columns; ++c)
  {
    Eigen::Matrix<double, CORNER, 1> x;
    x[SEPARATORS] = 0.0;
    for (int k = 0; k < COUNT; ++k)
    {
      const int previous = (k + COUNT - 1) % COUNT;
      for (int r = 0; r < 4; ++r)
      {
        x[4 * k + r] =
            b[(2 * separator_[k] + r) * columns + c] + before[BORDER * c + r].lane[k] + after[4 * c + r].lane[previous];
      }
      x[SEPARATORS] += before[BORDER * c + 4].lane[k];
    }
    x = corner_.solve(x);
    for (int k = 0; k < COUNT; ++k)
    {
      const int previous = (k + COUNT - 1) % COUNT;
      for (int r = 0; r < 4; ++r)
      {
        b[(2 * separator_[k] + r) * columns + c] = x[4 * k + r];
        before[BORDER * c + r].lane[k] = x[4 * k + r];
        after[4 * c + r].lane[previous] = x[4 * k + r];
      }
      before[BORDER * c + 4].lane[k] = x[SEPARATORS];
    }
  }
  kernels_.backward[columns - 1](layout_, factors_.data()->lane, rows_.data()->lane, before->lane, after->lane, b);
}
}  // namespace hjt
