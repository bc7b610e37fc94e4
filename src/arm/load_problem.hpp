// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include <Eigen/Core>

namespace hjt
{
/// Least squares of the currents that an arm's twins do not predict: terms of the load that all joints share, and for
/// each joint, as nuisances, an error of the gain, of the Coulomb and the viscous friction and an offset, each normally
/// distributed about zero. A row counts by the deviation and the correlation of its joint's rows, outliers less.
class LoadProblem
{
public:
  static constexpr int PAYLOAD = 4;    ///< mass and its three moments
  static constexpr int GRAVITY = 3;    ///< its change
  static constexpr int NUISANCES = 4;  ///< of each joint
  static constexpr int SHARED = PAYLOAD + GRAVITY;
  static constexpr int TERMS = SHARED + NUISANCES;

  static constexpr double BLOCK = 0.1;  ///< that a row is the mean of [s]

  using Columns = Eigen::Matrix<double, TERMS, 1>;
  using Shared = Eigen::Matrix<double, SHARED, 1>;

  /// Means of one joint while it moves one way.
  struct Rows
  {
    std::vector<Columns> columns;   ///< [A] for a term of 1
    std::vector<double> residuals;  ///< [A]
    std::vector<double> predicted;  ///< [A]
    std::vector<double> times;      ///< [s]
    std::vector<bool> touched;      ///< something touched the arm, or looked like it

    std::size_t size() const { return times.size(); }
    void add(const Rows& from, std::size_t row);
  };

  /// What may be another than it counts.
  enum class Term
  {
    PAYLOAD,
    GRAVITY,
    BOTH
  };

  static constexpr double SOUND_FRICTION = 0.3;  ///< by which that of sound joints differs, deviation [A], [A.s/rad]
  static constexpr double ANY_FRICTION = 2.0;    ///< that of faulty ones, likewise

  /// `friction`: deviation of the Coulomb and of the viscous friction from the twin's [A], [A.s/rad].
  LoadProblem(std::vector<Rows> rows, Term term, double friction = SOUND_FRICTION);

  struct Solution
  {
    Shared values{ Shared::Zero() };
    Shared half_widths{ Shared::Zero() };  ///< of 95 % intervals
  };
  /// The interval is that of the fit, or by leaving out one tenth of the time after the other where that is wider.
  Solution solve() const;
  Shared values() const;  ///< without their intervals: a twelfth of the time

  /// Of the currents, what is left with the best of all terms, and how much these take.
  struct Fit
  {
    double left{ 1.0 };  ///< share, rms [-]
    double cost{};       ///< logarithm of a likelihood, less is likelier; errors of models count for what they are [-]
  };
  /// `mass`: of the payload that counts [kg]. No change of it leaves less than none.
  Fit fit(double mass) const;

  /// When the payload most likely became another one [s]: the best of all times with LEAST_MOTION before and after, by
  /// what a payload of its own on either side takes of the squares that one payload leaves. None: too little motion.
  std::optional<double> likelyChange() const;
  static constexpr int LEAST_MOTION = 10;  ///< on either side of a change [s]

private:
  /// What is left of a joint's rows, whose nuisances begin at `own` [A].
  static Eigen::VectorXd errorsOf(const Rows& rows, Eigen::Index own, const Eigen::VectorXd& all);
  /// All terms. `information`: the inverse of their variance.
  Eigen::VectorXd solveAll(const std::vector<Rows>& rows, Eigen::MatrixXd& information) const;
  void add(const Rows& rows, Eigen::Index own, const Eigen::VectorXd& all, Eigen::MatrixXd& information,
           Eigen::VectorXd& right) const;

  std::vector<Rows> rows_;
  Shared known_;                             // to which each term is known before
  std::array<double, NUISANCES> known_own_;  // likewise
};
}  // namespace hjt
