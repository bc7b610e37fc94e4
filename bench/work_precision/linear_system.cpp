// SPDX-License-Identifier: BSD-3-Clause
#include "bench/work_precision/linear_system.hpp"

#include <algorithm>

#include <Eigen/SparseCore>

#include "studies/dynamic_ring.hpp"

namespace hjt
{
void LinearSystem::linearise(const double* state, double time)
{
  ring_.rates(state, time, rates_.data());
}

LinearSystem::LinearSystem(DynamicRing& ring)
  : ring_(ring), stiffness_(ring.teeth()), both_(ring.teeth()), rates_(ring.states())
{
  const int n = ring.states();
  stiffness_.setZero();
  both_.setZero();
  std::vector<Eigen::Triplet<double>> entries;
  visit(1.0, [&](int row, int column, double /*value*/) { entries.emplace_back(row, column, 1.0); });
  Eigen::SparseMatrix<double> pattern(n, n);
  pattern.setFromTriplets(entries.begin(), entries.end());
  starts_.assign(pattern.outerIndexPtr(), pattern.outerIndexPtr() + n + 1);
  rows_.assign(pattern.innerIndexPtr(), pattern.innerIndexPtr() + pattern.nonZeros());
  values_.resize(rows_.size());
  for (const auto& entry : entries)
  {
    const auto begin = rows_.begin() + starts_[static_cast<std::size_t>(entry.col())];
    const auto end = rows_.begin() + starts_[static_cast<std::size_t>(entry.col()) + 1];
    slots_.push_back(static_cast<int>(std::lower_bound(begin, end, entry.row()) - rows_.begin()));
  }
  klu_defaults(&common_);
  symbolic_ = klu_analyze(n, starts_.data(), rows_.data(), &common_);
  cup_.resize(n);
}

LinearSystem::~LinearSystem()
{
  klu_free_numeric(&numeric_, &common_);
  klu_free_symbolic(&symbolic_, &common_);
}

/// I - gamma J without the cup, entry by entry.
template <class Sink>
void LinearSystem::visit(double gamma, Sink&& sink) const
{
  const int n = ring_.coordinates();
  const Eigen::VectorXd& inverse_mass = ring_.inverseMass();
  for (int k = 0; k < n; ++k)
  {
    sink(k, k, 1.0);
    sink(n + k, n + k, 1.0);
    sink(k, n + k, -gamma);
  }
  visitEntries(stiffness_,
               [&](int row, int column, double value)
               {
                 const double entry = gamma * inverse_mass[row] * value;
                 sink(n + row, column, entry);
                 sink(n + row, n + column, -entry);
               });
  visitEntries(
      both_, [&](int row, int column, double value) { sink(n + row, n + column, gamma * inverse_mass[row] * value); });
}

bool LinearSystem::factor(double gamma)
{
  ring_.tangent(0.0, stiffness_);
  ring_.tangent(1.0, both_);
  std::fill(values_.begin(), values_.end(), 0.0);
  auto slot = slots_.begin();
  visit(gamma, [&](int /*row*/, int /*column*/, double value) { values_[static_cast<std::size_t>(*slot++)] += value; });
  if (numeric_ == nullptr ||
      klu_refactor(starts_.data(), rows_.data(), values_.data(), symbolic_, numeric_, &common_) == 0)
  {
    klu_free_numeric(&numeric_, &common_);
    numeric_ = klu_factor(starts_.data(), rows_.data(), values_.data(), symbolic_, &common_);
  }
  if (numeric_ == nullptr)
  {
    return false;
  }
  const Eigen::VectorXd& d = stiffness_.cup_direction;
  const Eigen::Index n = ring_.coordinates();
  cup_.setZero();
  cup_.segment(n, d.size()) = gamma * stiffness_.cup_stiffness * ring_.inverseMass().head(d.size()).cwiseProduct(d);
  solveSparse(cup_.data());
  cup_factor_ = 1.0 / (1.0 + d.dot(cup_.head(d.size())));
  return true;
}

void LinearSystem::solveSparse(double* b)
{
  klu_solve(symbolic_, numeric_, ring_.states(), 1, b, &common_);
}

void LinearSystem::solve(double* b)
{
  solveSparse(b);
  const Eigen::VectorXd& d = stiffness_.cup_direction;
  Eigen::Map<Eigen::VectorXd> x(b, ring_.states());
  x -= cup_ * (cup_factor_ * d.dot(x.head(d.size())));
}

}  // namespace hjt
