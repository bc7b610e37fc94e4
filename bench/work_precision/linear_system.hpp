// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <klu.h>
#include <Eigen/Core>

#include "studies/bordered_ring_solver.hpp"
#include "studies/dynamic_ring.hpp"

namespace hjt
{
/// What any implicit solver needs of the ring: (I - gamma J) x = b over the states, J the derivative of the rates.
class LinearSystem
{
public:
  explicit LinearSystem(DynamicRing& ring) : ring_(ring), stiffness_(ring.teeth()) {}
  virtual ~LinearSystem() = default;

  void linearise(const double* state, double time);  ///< J at a state
  virtual bool factor(double gamma) = 0;             ///< of the state last linearised at
  virtual void solve(double* b) = 0;                 ///< in place

protected:
  DynamicRing& ring_;
  RingTangent stiffness_;

private:
  Eigen::VectorXd rates_;
};

/// SuiteSparse KLU, refactored in a fixed pattern as SUNDIALS' own interface does. The cup's matrix of rank one is left
/// out of the pattern and put back by Sherman and Morrison's formula; with it inside, KLU would face a dense block.
class KluSystem : public LinearSystem
{
public:
  explicit KluSystem(DynamicRing& ring);
  ~KluSystem() override;
  KluSystem(const KluSystem&) = delete;
  KluSystem& operator=(const KluSystem&) = delete;

  bool factor(double gamma) override;
  void solve(double* b) override;

private:
  template <class Sink>
  void visit(double gamma, Sink&& sink) const;
  void solveSparse(double* b);

  RingTangent both_;  // stiffness and damping
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

/// The twin's own solver: condensed to the coordinates, cyclic block-tridiagonal with the two angles as border.
class StructuredSystem : public LinearSystem
{
public:
  explicit StructuredSystem(DynamicRing& ring);

  bool factor(double gamma) override;
  void solve(double* b) override;

private:
  RingTangent whole_;
  BorderedRingSolver solver_;
  double gamma_{};
  Eigen::VectorXd right_;
};

enum class LinearKind
{
  KLU,
  STRUCTURED
};
std::unique_ptr<LinearSystem> makeLinearSystem(LinearKind kind, DynamicRing& ring);
}  // namespace hjt
