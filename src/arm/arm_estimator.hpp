// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

#include <Eigen/Core>

namespace hjt
{
/// Finds what explains the currents of an arm beside those that its twins predict: the most likely causes a posteriori.
///
///   current = (1 + g + g_i) (predicted + L_i + F_i (friction + rise_i U_i) - friction + (c + c_i) cold
///             + l_i |T_i + L_i| + j_i inertia) + o_i
///   L_i = Y_i . x + jump_i     x      mass and moments of a payload, the change of gravity, and a drag: a force on the
///                                     tip against its motion
///                              jump   of another payload, in the legs of state 1
///   F_i = 1 + f + f_group + f_i, of the twin's friction;  c, c_i  the same by temperature
///   U_i = |T_i + L_i| - |T_i|  T_i    load as configured
///                              rise_i how much friction rises with it
///   g, o gains and offsets;  l_i  loss in proportion to the load;  j_i  of the rotor's inertia
///
/// Friction, rise and loss have the sign of the motion. Few arms carry another payload than configured, are mounted
/// otherwise, or have a joint of another gain or friction: these causes have Cauchy priors. The other causes have
/// normal priors. A row is of one joint that moves one way. Outliers of the rows, as of contact, count as by Student's
/// t of 4 degrees of freedom. All rows of a joint count as at most INDEPENDENT rows, because errors of a model are no
/// noise. A joint's gain is free only where its load is at least its friction: elsewhere both look alike.
class ArmEstimator
{
public:
  static constexpr int PAYLOAD = 4;  ///< terms of the payload: its mass and three moments
  static constexpr int GRAVITY = 3;  ///< terms of the change of gravity
  static constexpr int DRAG = PAYLOAD + GRAVITY;
  static constexpr int LOAD = DRAG + 1;
  using Load = Eigen::Matrix<double, LOAD, 1>;
  using Carried = Eigen::Matrix<double, PAYLOAD, 1>;

  /// Mean currents of a joint while the joint moves in one direction [A].
  struct Row
  {
    double time{};  ///< [s]
    std::size_t leg{};
    double current{};
    double predicted{};
    double friction{};          ///< current of the twin's friction
    double cold{};              ///< current of the additional friction when the drive is 10 K colder
    double torque{};            ///< current of the load as configured
    double inertia{};           ///< current of the rotor's inertia
    double rise{};              ///< rise of the friction per load, both by their sizes [-]
    Load load{ Load::Zero() };  ///< currents of units of mass, moments, gravity and drag
    Eigen::Vector2d across{ Eigen::Vector2d::Zero() };  ///< currents of unit forces on the tip across gravity
  };
  using Rows = std::vector<std::vector<Row>>;  ///< rows of each joint, from the base on

  /// Value and half width of its 95 % interval.
  struct Known
  {
    double value{};
    double half_width{};
    double of_rows{ HUGE_VAL };  ///< half width of the 95 % interval by the rows alone, without the prior

    bool isBeyond(double least) const;  ///< whether the whole interval is farther than `least` from 0
  };

  /// A force on the tip that explains the part of a leg's currents that the other causes do not explain.
  struct Push
  {
    double size{};    ///< size of the force [N]
    double across{};  ///< part of the force across gravity, which no payload makes [N]
  };

  struct Estimate
  {
    Carried payload{ Carried::Zero() };  ///< payload of the legs of state 0, less the configured one
    Carried payload_half_width{ Carried::Zero() };
    Carried jump{ Carried::Zero() };  ///< payload of the legs of state 1, less that of state 0
    Carried jump_half_width{ Carried::Zero() };
    Eigen::Vector3d gravity{ Eigen::Vector3d::Zero() };  ///< gravity less the configured one
    Eigen::Vector3d gravity_half_width{ Eigen::Vector3d::Zero() };
    Known drag;                    ///< drag less the configured one [N]
    Known gain;                    ///< factor of all gains, less 1 [-]
    std::vector<Known> gains;      ///< factor of the gain of each joint, less that of all gains [-]
    std::vector<Known> frictions;  ///< friction of each joint over the twin's, in the joint's rows [-]
    std::vector<Known> own;        ///< part of each joint's friction that a fault causes, over the twin's friction [-]
    std::vector<bool> states;      ///< state of each leg; empty if all legs have one payload
    std::vector<Push> pushes;      ///< force on the tip in each leg
    double left{ 1.0 };            ///< share of the currents that is not explained, rms [-]
    double rareness{};             ///< logarithm of how rare the found causes are [-]
    double cost{};                 ///< negative logarithm of the likelihood a posteriori [-]
  };

  /// `gravity`: as configured, in the frame of the base [m/s^2]; another mounting does not change its size. `repeats`:
  /// standard deviation of each joint's friction when it is sound, as a share; empty: as joints of one type differ.
  ArmEstimator(Rows rows, const Eigen::Vector3d& gravity, std::vector<double> repeats = {});

  /// Causes that the estimator considers in addition to a payload.
  struct Freedom
  {
    bool mounting{};
    bool jump{};  ///< the payload may change between legs
    bool drag{};
  };
  /// The likeliest estimate with one payload. Where the payload may change and some legs have another one, the
  /// likeliest estimate with two payloads follows.
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
  int size_;  // number of all terms
};
}  // namespace hjt
