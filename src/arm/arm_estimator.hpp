// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

#include <Eigen/Core>

namespace hjt
{
/// Finds the most probable causes of the difference between the currents of an arm and those that its twins predict.
///
///   current = (1 + g + g_i) (predicted + L_i + F_i (friction + rise_i U_i) - friction + (c + c_i) cold
///             + l_i |T_i + L_i| + j_i inertia) + o_i
/// where words are fields of a Row of joint i, T_i is its `torque` and Y_i its `load`. The causes are:
///   L_i = Y_i . x + jump_i        x: mass and moments of a payload, change of gravity, drag; jump_i: the effect
///                                 of another payload in the legs of state 1 than in those of state 0
///   F_i = 1 + f + f_group + f_i   factors on the twin's friction;  c, c_i: coldness of the drives [10 K]
///   U_i = |T_i + L_i| - |T_i|     change of the load's magnitude by L_i
///   g, g_i gains;  o_i offset;  l_i loss per load;  j_i change of the rotor's inertia, as a share
///
/// Friction, rise and loss have the sign of the motion. Payload, mounting, gain and friction rarely differ from their
/// configured values, but a difference can have any size. So these causes have Cauchy priors. The other causes have
/// normal priors. The errors of the rows have Student's t distribution of 4 degrees of freedom, because contacts cause
/// outliers. All rows of a joint together count as at most INDEPENDENT rows, because errors of the twin are alike in
/// many rows. The estimator changes a joint's gain only if the joint's load is at least as large as its friction. With
/// a smaller load, gain and friction have nearly the same effect.
class ArmEstimator
{
public:
  static constexpr int PAYLOAD = 4;  ///< number of terms of the payload: its mass and three moments
  static constexpr int GRAVITY = 3;  ///< number of terms of the change of gravity
  static constexpr int DRAG = PAYLOAD + GRAVITY;
  static constexpr int LOAD = DRAG + 1;
  using Load = Eigen::Matrix<double, LOAD, 1>;
  using Carried = Eigen::Matrix<double, PAYLOAD, 1>;

  /// Mean currents of a joint while the joint moves in one direction [A].
  struct Row
  {
    double time{};  ///< time of the first sample in the mean [s]
    std::size_t leg{};
    double current{};
    double predicted{};
    double friction{};          ///< current of the twin's friction
    double cold{};              ///< current of the additional friction when the drive is 10 K colder
    double torque{};            ///< current of the configured load
    double inertia{};           ///< current of the rotor's inertia
    double rise{};              ///< rise of the friction's magnitude per magnitude of the load [-]
    Load load{ Load::Zero() };  ///< current that each unit of mass, moment, gravity and drag takes
    Eigen::Vector2d across{ Eigen::Vector2d::Zero() };  ///< currents of two forces of 1 N on the tip across gravity
  };
  using Rows = std::vector<std::vector<Row>>;  ///< rows of each joint, from the base on

  /// A value with the half width of its 95 % interval.
  struct Known
  {
    double value{};
    double half_width{};
    double of_rows{ HUGE_VAL };  ///< half width of the 95 % interval from the rows alone, without the prior

    bool isBeyond(double least) const;  ///< whether no value of the interval is within `least` of 0
  };

  /// A force on the tip that explains the part of a leg's currents that the other causes do not explain.
  struct Push
  {
    double size{};    ///< size of the force [N]
    double across{};  ///< part of the force across gravity; a payload has no such part [N]
  };

  struct Estimate
  {
    Carried payload{ Carried::Zero() };  ///< payload in the legs of state 0 - configured payload [kg], [kg.m]
    Carried payload_half_width{ Carried::Zero() };
    Carried jump{ Carried::Zero() };  ///< payload in the legs of state 1 - payload in the legs of state 0 [kg], [kg.m]
    Carried jump_half_width{ Carried::Zero() };
    Eigen::Vector3d gravity{ Eigen::Vector3d::Zero() };  ///< found gravity - configured gravity [m/s^2]
    Eigen::Vector3d gravity_half_width{ Eigen::Vector3d::Zero() };
    Known drag;                    ///< found drag - configured drag [N]
    Known gain;                    ///< common factor of all gains - 1 [-]
    std::vector<Known> gains;      ///< factor of each joint's gain - common factor of all gains [-]
    std::vector<Known> frictions;  ///< friction of each joint over the twin's friction [-]
    std::vector<Known> own;        ///< part of each joint's friction that a fault causes, over the twin's friction [-]
    std::vector<bool> states;      ///< state of each leg; empty if all legs have one payload
    std::vector<Push> pushes;      ///< force that pushes the tip in each leg
    double left{ 1.0 };            ///< share of the currents that the estimate does not explain, rms [-]
    double rareness{};             ///< negative logarithm of the prior probability of the found causes [-]
    double cost{};                 ///< negative logarithm of the posterior probability of the estimate [-]
  };

  /// `gravity`: configured gravity in the frame of the base [m/s^2]. Another mounting changes its direction, not its
  /// size. `repeats`: relative standard deviation of the friction of each joint when the joint is sound [-]; empty: the
  /// standard deviation from joint to joint of one type.
  ArmEstimator(Rows rows, const Eigen::Vector3d& gravity, std::vector<double> repeats = {});

  /// Causes that the estimator considers in addition to a payload that differs from the configured one.
  struct Freedom
  {
    bool mounting{};
    bool jump{};  ///< whether the payload may change between legs
    bool drag{};
  };
  /// Returns the likeliest estimate with the same payload in all legs. If `may.jump` is true and two groups of legs fit
  /// different payloads, the likeliest estimate with two payloads is the second in the list.
  std::vector<Estimate> solve(const Freedom& may) const;

private:
  struct Prior;
  struct Point;
  struct Work;
  struct Products;
  static constexpr int SLOPES = LOAD + 6;
  using Slope = Eigen::Matrix<double, SLOPES, 1>;

  Prior priorOf(const Freedom& may) const;
  static bool stateOf(const Row& row, const std::vector<bool>& states) { return !states.empty() && states[row.leg]; }
  static double errorOf(std::size_t joint, const Row& row, bool state, const Eigen::VectorXd& at, Slope* slope);
  Point refine(const Prior& prior, const std::vector<bool>& states, Eigen::VectorXd at, int start,
               const Point& best) const;
  static bool isNear(const Point& point, const Point& other);
  double multiple() const;
  Point best(const Prior& prior, const std::vector<bool>& states) const;
  Point withJump(const Freedom& may, const Point& without, std::vector<bool>& states) const;
  std::vector<bool> parted(const Point& by) const;
  std::vector<bool> likelier(const Point& by) const;
  std::vector<Push> pushesOf(const Point& point, const std::vector<bool>& states) const;
  Estimate estimateOf(const Point& point, const std::vector<bool>& states) const;

  void addPrior(const Prior& prior, int start, Point& point, Eigen::VectorXd& right) const;
  void addRows(std::size_t joint, const std::vector<bool>& states, Work& work, Point& point,
               Eigen::VectorXd& right) const;

  Rows rows_;
  Eigen::Vector3d gravity_;
  std::vector<double> repeats_;
  std::size_t legs_{};
  int size_;  // number of unknowns of the fit, of the arm and all joints together
};
}  // namespace hjt
