// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <klu.h>
#include <Eigen/Core>

#include "studies/dynamic_ring.hpp"

namespace hjt
{
/// What any implicit solver needs of the ring: (I - gamma J) x = b over the states, J the derivative of the rates. By
/// SuiteSparse's KLU, refactored in a fixed pattern as SUNDIALS' own interface does. The cup's matrix of rank one is
/// left out of the pattern and put back by Sherman and Morrison's formula; inside, it would be a dense block to KLU.
class LinearSystem
{
public:
  explicit LinearSystem(DynamicRing& ring);
  ~LinearSystem();
  LinearSystem(const LinearSystem&) = delete;
  LinearSystem& operator=(const LinearSystem&) = delete;

  void linearise(const double* state, double time);  ///< J at a state
  bool factor(double gamma);                         ///< of the state last linearised at
  void solve(double* b);                             ///< in place

private:
  template <class Sink>
  void visit(double gamma, Sink&& sink) const;
  void solveSparse(double* b);

  DynamicRing& ring_;
  RingTangent stiffness_;
  RingTangent both_;  // stiffness and damping
  Eigen::VectorXd rates_;
  std::vector<int> starts_;
  std::vector<int> rows_;
  std::vector<double> values_;
  std::vector<int> slots_;  // of the entries visited, in order
  klu_common common_{};
  klu_symbolic* symbolic_{};
  klu_numeric* numeric_{};
  Eigen::VectorXd cup_;  // (I - gamma J0)^-1 times the cup's column
  double cup_factor_{};
};

}  // namespace hjt
