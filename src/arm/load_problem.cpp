// SPDX-License-Identifier: BSD-3-Clause
#include "arm/load_problem.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include <Eigen/Cholesky>

#include "arm/residual_statistics.hpp"

namespace hjt
{
namespace
{
constexpr double OUTLIER = 3.0;  // deviations
constexpr double LEAST = 0.01;   // deviation [A]
constexpr int PARTS = 10;        // of the time, of which one after the other is left out
/// What each is known to before: mass [kg], moment [kg.m], gravity [m/s^2]; what does not count.
constexpr double KNOWN_MASS = 10.0;
constexpr double KNOWN_MOMENT = 2.0;
constexpr double KNOWN_GRAVITY = 10.0;
constexpr double FIXED = 1e-6;
constexpr double KNOWN_GAIN = 0.05;
constexpr double KNOWN_OFFSET = 0.03;  // [A]

/// How much rarer an arm's joints are whose gain, Coulomb and viscous friction and offset are these, logarithm: a fault
/// may add any friction (Cauchy), gains and offsets are normally distributed.
double rareness(const Eigen::Vector4d& own)
{
  const auto squared = [&](int term, double deviation) { return 0.5 * std::pow(own[term] / deviation, 2); };
  return squared(0, KNOWN_GAIN) + std::log1p(squared(1, LoadProblem::SOUND_FRICTION)) +
         std::log1p(squared(2, LoadProblem::SOUND_FRICTION)) + squared(3, KNOWN_OFFSET);
}

/// All but those of one of PARTS parts of the time.
std::vector<LoadProblem::Rows> without(const std::vector<LoadProblem::Rows>& rows, int part, double begin, double end)
{
  std::vector<LoadProblem::Rows> left(rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i)
  {
    for (std::size_t k = 0; k < rows[i].size(); ++k)
    {
      if (static_cast<int>(PARTS * (rows[i].times[k] - begin) / (end - begin)) != part)
      {
        left[i].add(rows[i], k);
      }
    }
  }
  return left;
}
}  // namespace

void LoadProblem::Rows::add(const Rows& from, std::size_t row)
{
  columns.push_back(from.columns[row]);
  residuals.push_back(from.residuals[row]);
  predicted.push_back(from.predicted[row]);
  times.push_back(from.times[row]);
  touched.push_back(from.touched[row]);
}

LoadProblem::LoadProblem(std::vector<Rows> rows, Term term, double friction)
  : rows_(std::move(rows)), known_own_{ KNOWN_GAIN, friction, friction, KNOWN_OFFSET }
{
  known_.setConstant(FIXED);
  if (term != Term::GRAVITY)
  {
    known_.head<PAYLOAD>() << KNOWN_MASS, KNOWN_MOMENT, KNOWN_MOMENT, KNOWN_MOMENT;
  }
  if (term != Term::PAYLOAD)
  {
    known_.tail<GRAVITY>().setConstant(KNOWN_GRAVITY);
  }
}

LoadProblem::Solution LoadProblem::solve() const
{
  double begin = std::numeric_limits<double>::infinity();
  double end = -begin;
  for (const Rows& rows : rows_)
  {
    for (const double time : rows.times)
    {
      begin = std::min(begin, time);
      end = std::max(end, time + BLOCK);
    }
  }
  Eigen::MatrixXd information;
  Solution solution;
  solution.values = solveAll(rows_, information).head<SHARED>();
  const Eigen::MatrixXd variance =
      information.ldlt().solve(Eigen::MatrixXd::Identity(information.rows(), information.cols()));
  solution.half_widths = NORMAL_95 * variance.diagonal().head<SHARED>().cwiseSqrt();
  Shared squares = Shared::Zero();
  for (int part = 0; part < PARTS && end > begin; ++part)
  {
    squares += (solveAll(without(rows_, part, begin, end), information).head<SHARED>() - solution.values).cwiseAbs2();
  }
  solution.half_widths = solution.half_widths.cwiseMax(NORMAL_95 * (squares * (PARTS - 1.0) / PARTS).cwiseSqrt());
  return solution;
}

LoadProblem::Shared LoadProblem::values() const
{
  Eigen::MatrixXd information;
  return solveAll(rows_, information).head<SHARED>();
}

LoadProblem::Fit LoadProblem::fit(double mass) const
{
  constexpr double ROWS = 60.0;    // that count: errors of a model are not independent from row to row
  constexpr double FLOOR = 0.02;   // of the currents: that the twin of no real arm falls below [-]
  constexpr double NO_MASS = 0.5;  // below zero: deviation that masses of links make [kg]
  Eigen::MatrixXd information;
  const Eigen::VectorXd all = solveAll(rows_, information);
  double left = 0.0;
  double squares = 0.0;
  double cost = 0.0;
  for (std::size_t i = 0; i < rows_.size(); ++i)
  {
    const auto own = static_cast<Eigen::Index>(SHARED + NUISANCES * i);
    cost += rareness(all.segment<NUISANCES>(own));
    left += errorsOf(rows_[i], own, all).squaredNorm();
    for (std::size_t k = 0; k < rows_[i].size(); ++k)
    {
      squares += std::pow(rows_[i].residuals[k] + rows_[i].predicted[k], 2);
    }
  }
  Fit fit;
  fit.left = squares > 0.0 ? std::sqrt(left / squares) : 1.0;
  const double below_zero = std::min(mass + all[0], 0.0);
  fit.cost = cost + ROWS * std::log(std::hypot(fit.left, FLOOR)) + 0.5 * std::pow(below_zero / NO_MASS, 2);
  return fit;
}

std::optional<double> LoadProblem::likelyChange() const
{
  struct Piece
  {
    Eigen::Matrix4d products{ Eigen::Matrix4d::Zero() };
    Eigen::Vector4d sums{ Eigen::Vector4d::Zero() };
  };
  std::map<double, Piece> pieces;  // by the second of motion that they are of
  Piece rest;
  Eigen::MatrixXd information;
  const Eigen::VectorXd all = solveAll(rows_, information);
  for (std::size_t i = 0; i < rows_.size(); ++i)
  {
    const Eigen::VectorXd errors = errorsOf(rows_[i], static_cast<Eigen::Index>(SHARED + NUISANCES * i), all);
    const double weight = 1.0 / std::pow(std::max(errors.size() > 0 ? robustDeviation(errors) : 0.0, LEAST), 2);
    for (std::size_t k = 0; k < rows_[i].size(); ++k)
    {
      const Eigen::Vector4d column = rows_[i].columns[k].head<PAYLOAD>();
      for (Piece* piece : { &pieces[std::floor(rows_[i].times[k])], &rest })
      {
        piece->products += weight * column * column.transpose();
        piece->sums += weight * errors[static_cast<Eigen::Index>(k)] * column;
      }
    }
  }
  const Eigen::Matrix4d known = known_.head<PAYLOAD>().cwiseAbs2().cwiseInverse().asDiagonal();
  const auto taken = [&](const Piece& of)
  { return of.sums.dot(Eigen::Matrix4d(of.products + known).ldlt().solve(of.sums)); };
  Piece before;
  double most = 0.0;
  std::optional<double> change;
  int count = 0;
  for (const auto& [second, piece] : pieces)
  {
    const double both = taken(before) + taken(rest);
    if (count >= LEAST_MOTION && count + LEAST_MOTION <= static_cast<int>(pieces.size()) && both > most)
    {
      most = both;
      change = second;
    }
    before.products += piece.products;
    before.sums += piece.sums;
    rest.products -= piece.products;
    rest.sums -= piece.sums;
    ++count;
  }
  return change;
}

Eigen::VectorXd LoadProblem::errorsOf(const Rows& rows, Eigen::Index own, const Eigen::VectorXd& all)
{
  Columns values;
  values << all.head<SHARED>() * (1.0 + all[own]), all.segment<NUISANCES>(own);  // a gain's error is of both
  Eigen::VectorXd errors(static_cast<Eigen::Index>(rows.size()));
  for (std::size_t k = 0; k < rows.size(); ++k)
  {
    errors[static_cast<Eigen::Index>(k)] = rows.residuals[k] - rows.columns[k].dot(values);
  }
  return errors;
}

Eigen::VectorXd LoadProblem::solveAll(const std::vector<Rows>& rows, Eigen::MatrixXd& information) const
{
  const auto size = static_cast<Eigen::Index>(SHARED + NUISANCES * rows.size());
  Eigen::VectorXd known(size);
  known.head<SHARED>() = known_;
  for (Eigen::Index own = SHARED; own < size; own += NUISANCES)
  {
    known.segment<NUISANCES>(own) = Eigen::Map<const Eigen::Vector4d>(known_own_.data());
  }
  Eigen::VectorXd all = Eigen::VectorXd::Zero(size);
  constexpr int ROUNDS = 5;
  for (int round = 0; round < ROUNDS; ++round)
  {
    information = known.cwiseAbs2().cwiseInverse().asDiagonal();
    Eigen::VectorXd right = Eigen::VectorXd::Zero(size);
    for (std::size_t i = 0; i < rows.size(); ++i)
    {
      add(rows[i], static_cast<Eigen::Index>(SHARED + NUISANCES * i), all, information, right);
    }
    all = information.ldlt().solve(right);
  }
  return all;
}

/// The rows of one joint, whose nuisances begin at `own`, weighed by what `all` leaves of them.
void LoadProblem::add(const Rows& rows, Eigen::Index own, const Eigen::VectorXd& all, Eigen::MatrixXd& information,
                      Eigen::VectorXd& right) const
{
  constexpr std::size_t FEWEST = 5;
  if (rows.size() < FEWEST)
  {
    return;
  }
  const Eigen::VectorXd errors = errorsOf(rows, own, all);
  const double deviation = std::max(robustDeviation(errors), LEAST);
  const double weight = 1.0 / (deviation * deviation * correlationRows(errors));
  Eigen::Matrix<double, TERMS, TERMS> products = Eigen::Matrix<double, TERMS, TERMS>::Zero();
  Columns sums = Columns::Zero();
  for (std::size_t k = 0; k < rows.size(); ++k)
  {
    const double error = std::abs(errors[static_cast<Eigen::Index>(k)]);
    const double row_weight = weight * std::min(1.0, OUTLIER * deviation / std::max(error, LEAST));
    Columns row = rows.columns[k];
    row[SHARED] += row.head<SHARED>().dot(all.head<SHARED>());  // an error of the gain is one of what these change too
    products.noalias() += row_weight * row * row.transpose();
    sums += row_weight * rows.residuals[k] * row;
  }
  information.topLeftCorner<SHARED, SHARED>() += products.topLeftCorner<SHARED, SHARED>();
  information.block<NUISANCES, NUISANCES>(own, own) += products.bottomRightCorner<NUISANCES, NUISANCES>();
  information.block<SHARED, NUISANCES>(0, own) += products.topRightCorner<SHARED, NUISANCES>();
  information.block<NUISANCES, SHARED>(own, 0) += products.bottomLeftCorner<NUISANCES, SHARED>();
  right.head<SHARED>() += sums.head<SHARED>();
  right.segment<NUISANCES>(own) += sums.tail<NUISANCES>();
}
}  // namespace hjt
