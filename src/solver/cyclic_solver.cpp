// SPDX-License-Identifier: BSD-3-Clause
#include "solver/cyclic_solver.hpp"

#include <algorithm>

namespace hjt
{
using arcs::BORDER;
using arcs::COUNT;

CyclicSolver::CyclicSolver(int teeth, const arcs::Kernels& kernels)
  : kernels_(kernels)
  , layout_{ (teeth - 2 * COUNT + COUNT - 1) / COUNT, {}, {} }
  , separator_{}
  , factors_(static_cast<std::size_t>(arcs::FACTOR_ENTRIES * std::max(layout_.steps, 1)))
  , rows_(static_cast<std::size_t>(2 * MAX_COLUMNS * std::max(layout_.steps, 1)))
  , schur_{}
  , cup_(Separators::Zero())
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
  const SymmetricBlocks& d = tangent.diagonal;
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

  return factorSchur(tangent, before, after, between);
}

/// Assembles the matrix of separators and cup from the entries of the tangent and the sums of the arcs, and factors it.
bool CyclicSolver::factorSchur(const RingTangent& tangent, const Entry* before, const Entry* after,
                               const Entry* between) noexcept
{
  alignas(32) SchurComplement schur = SchurComplement::Zero();  // upper triangle
  Separators cup = Separators::Zero();
  double pivot = -1.0 / tangent.cup_stiffness;
  for (int k = 0; k < COUNT; ++k)
  {
    const int a = separator_[k];
    const int own = 4 * k;
    const int next = 4 * ((k + 1) % COUNT);
    schur.block<2, 2>(own, own) += tangent.diagonal.at(a);
    schur.block<2, 2>(own, own + 2) += tangent.next.at(a);
    schur.block<2, 2>(own + 2, own + 2) += tangent.diagonal.at(a + 1);
    cup.segment<4>(own) += tangent.cup_direction.segment<4>(2 * a);
    const Entry* sum = before;
    for (int c = 0; c < 4; ++c)
    {
      for (int r = 0; r <= c; ++r)
      {
        schur(own + r, own + c) += (sum++)->lane[k];
      }
    }
    for (int r = 0; r < 4; ++r)
    {
      cup[own + r] += (sum++)->lane[k];
    }
    pivot += sum->lane[k];
    constexpr int ROWS[arcs::AFTER_ENTRIES] = { 0, 0, 1, 0, 0, 1, 1, 2, 2, 3 };
    constexpr int COLS[arcs::AFTER_ENTRIES] = { 0, 1, 1, 2, 3, 2, 3, 2, 3, 3 };
    for (int e = 0; e < arcs::AFTER_ENTRIES; ++e)
    {
      schur(next + ROWS[e], next + COLS[e]) += after[e].lane[k];
    }
    for (int r = 0; r < 4; ++r)
    {
      for (int c = 0; c < 4; ++c)
      {
        const double value = between[BORDER * r + c].lane[k];
        (own < next ? schur(own + c, next + r) : schur(next + r, own + c)) += value;
      }
      cup[next + r] += between[BORDER * r + 4].lane[k];
    }
  }
  cup_ = cup;
  cup_inverse_ = 1.0 / pivot;
  alignas(32) SchurComplement without_cup = schur;
  without_cup.noalias() -= cup_inverse_ * cup * cup.transpose();
  pivoting_ = !(pivot < 0.0 && kernels_.factor_schur(without_cup.data(), schur_));
  if (!pivoting_)
  {
    return true;
  }
  SchurWithCup whole;
  whole.topLeftCorner<SCHUR, SCHUR>() = schur.selfadjointView<Eigen::Upper>();
  whole.topRightCorner<SCHUR, 1>() = cup;
  whole.bottomLeftCorner<1, SCHUR>() = cup.transpose();
  whole(SCHUR, SCHUR) = pivot;
  lu_.compute(whole);
  const SchurWithCup& lu = lu_.matrixLU();
  return lu.allFinite() && (lu.diagonal().array() != 0.0).all();
}

/// Solves for the unknowns of the separators and the cup's multiplier. The solution replaces the right-hand side.
void CyclicSolver::solveSchur(Separators& x, double& multiplier) const noexcept
{
  if (pivoting_)
  {
    Eigen::Matrix<double, SCHUR + 1, 1> whole;
    whole << x, multiplier;
    whole = lu_.solve(whole);
    x = whole.head<SCHUR>();
    multiplier = whole[SCHUR];
    return;
  }
  alignas(32) Separators inner = x - cup_inverse_ * multiplier * cup_;
  kernels_.solve_schur(schur_, inner.data());
  multiplier = cup_inverse_ * (multiplier - cup_.dot(inner));
  x = inner;
}

void CyclicSolver::solve(double* const* columns, int count) noexcept
{
  Entry before[BORDER * MAX_COLUMNS];
  Entry after[4 * MAX_COLUMNS];
  kernels_.forward[count - 1](layout_, factors_.data()->lane, columns, rows_.data()->lane, before->lane, after->lane);
  for (int c = 0; c < count; ++c)
  {
    double* b = columns[c];
    Separators x;
    double multiplier = 0.0;
    for (int k = 0; k < COUNT; ++k)
    {
      const int previous = (k + COUNT - 1) % COUNT;
      for (int r = 0; r < 4; ++r)
      {
        x[4 * k + r] = b[2 * separator_[k] + r] + before[BORDER * c + r].lane[k] + after[4 * c + r].lane[previous];
      }
      multiplier += before[BORDER * c + 4].lane[k];
    }
    solveSchur(x, multiplier);
    for (int k = 0; k < COUNT; ++k)
    {
      const int previous = (k + COUNT - 1) % COUNT;
      for (int r = 0; r < 4; ++r)
      {
        b[2 * separator_[k] + r] = x[4 * k + r];
        before[BORDER * c + r].lane[k] = x[4 * k + r];
        after[4 * c + r].lane[previous] = x[4 * k + r];
      }
      before[BORDER * c + 4].lane[k] = multiplier;
    }
  }
  kernels_.backward[count - 1](layout_, factors_.data()->lane, rows_.data()->lane, before->lane, after->lane, columns);
}
}  // namespace hjt
