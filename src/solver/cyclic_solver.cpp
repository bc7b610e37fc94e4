// SPDX-License-Identifier: BSD-3-Clause
#include "harmonic_joint_twin/solver/cyclic_solver.hpp"

namespace hjt
{
namespace
{
constexpr int CUP = 4;  // column of the border after the last block's four
}  // namespace

CyclicSolver::CyclicSolver(int teeth)
  : last_(teeth / 2 - 1), inverse_(last_), upper_(last_), border_(last_), corner_inverse_(Corner::Zero())
{
}

bool CyclicSolver::factor(const RingTangent& tangent) noexcept
{
  Corner corner = Corner::Zero();
  corner.topLeftCorner<4, 4>() = tangent.diagonal[last_];
  corner.block<4, 1>(0, CUP) = tangent.cup_direction.segment<4>(4 * last_);
  corner.block<1, 4>(CUP, 0) = tangent.cup_direction.segment<4>(4 * last_).transpose();
  corner(CUP, CUP) = -1.0 / tangent.cup_stiffness;

  Block4 diagonal = tangent.diagonal[0];
  Border border;
  border.leftCols<4>() = tangent.upper[last_].transpose();
  border.col(CUP) = tangent.cup_direction.segment<4>(0);
  for (int p = 0; p < last_; ++p)
  {
    const bool final = p + 1 == last_;
    if (final)
    {
      border.leftCols<4>() += tangent.upper[p];
    }
    inverse_[p] = diagonal.inverse();
    border_[p].noalias() = inverse_[p] * border;
    corner.noalias() -= border.transpose() * border_[p];
    if (final)
    {
      upper_[p].setZero();
      break;
    }
    const Block4& coupling = tangent.upper[p];
    upper_[p].noalias() = inverse_[p] * coupling;
    diagonal = tangent.diagonal[p + 1];
    diagonal.noalias() -= coupling.transpose() * upper_[p];
    Border next;
    next.leftCols<4>().setZero();
    next.col(CUP) = tangent.cup_direction.segment<4>(4 * (p + 1));
    next.noalias() -= coupling.transpose() * border_[p];
    border = next;
  }
  corner_inverse_ = corner.partialPivLu().inverse();
  return corner_inverse_.allFinite();
}
}  // namespace hjt
