// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>
#include <Eigen/SparseCore>

#include "elements/ring_sums.hpp"
#include "gear/ring_shape.hpp"
#include "model/joint_model.hpp"

namespace hjt
{
/// Every entry of a tangent over all coordinates as (row, column, value); the order does not depend on the values.
/// Visits the entries without the cup's, whose matrix of rank one is dense.
template <class Visitor>
void visitEntries(const RingTangent& tangent, Visitor&& visit)
{
  const auto block = [&](int row_tooth, int column_tooth, const Block2& values)
  {
    for (int i = 0; i < 2; ++i)
    {
      for (int j = 0; j < 2; ++j)
      {
        visit(2 * row_tooth + i, 2 * column_tooth + j, values(i, j));
      }
    }
  };
  const auto couple = [&](int i, int j, const Block2& values)
  {
    block(i, j, values);
    block(j, i, values.transpose());
  };
  const int teeth = tangent.teeth();
  const int wave_generator = 2 * teeth;
  const int output = wave_generator + 1;
  for (int i = 0; i < teeth; ++i)
  {
    block(i, i, tangent.diagonal.at(i));
    couple(i, (i + 1) % teeth, tangent.next.at(i));
    couple(i, (i + 2) % teeth, tangent.second.at(i));
  }
  for (int k = 0; k < wave_generator; ++k)
  {
    visit(k, wave_generator, tangent.wave_generator[k]);
    visit(wave_generator, k, tangent.wave_generator[k]);
    visit(k, output, tangent.output[k]);
    visit(output, k, tangent.output[k]);
  }
  visit(wave_generator, wave_generator, tangent.wave_generator_stiffness);
  visit(output, output, tangent.output_stiffness);
}

/// The wave's amplitude over time: grows at a constant speed. Where the speed changes a step has to end.
struct WaveGrowth
{
  double begin{};      ///< [s]
  double amplitude{};  ///< at `begin` [m]
  double speed{};      ///< [m/s]

  double at(double time) const noexcept { return amplitude + speed * (time - begin); }  ///< [m]
};

/// External drive of a dynamic ring. A driven body keeps its speed, whatever acts on it.
struct RingDrive
{
  WaveGrowth wave;
  bool wave_generator_driven{};
  bool output_driven{};
  double motor_torque{};  ///< on a wave generator that is not driven [N.m]
  double load_torque{};   ///< on an output that is not driven; > 0 resists positive motion [N.m]
};

/// Powers at one instant [W].
struct RingPower
{
  double supplied{};    ///< by motor or drive, load and the wave generator's growth
  double dissipated{};  ///< in dashpots and viscous friction
};

/// The ring with a mass at every tooth, wave generator and circular spline as two more bodies: M q'' = f(q, q', t).
///
/// Coordinates q: 2 N of the tooth points [m], wave generator angle, output angle [rad]; M is diagonal.
/// State: q and then q', 4 N + 4 values. Forces: those of the ring's elements with their dashpots, the motor's and the
/// load's viscous friction, gravity on the load. Dry friction is left out.
///
/// Teeth and spaces are paired by `pairTeeth`, between steps and never within one: between two pairings the right-hand
/// side is a fixed function of state and time. For solvers from outside there are `rates` and `jacobian`.
class DynamicRing
{
public:
  DynamicRing(const JointModel& model, const RingParameters& parameters, const RingDrive& drive);

  int teeth() const noexcept { return shape_.teeth(); }
  int coordinates() const noexcept { return static_cast<int>(mass_.size()); }  ///< 2 N + 2
  int states() const noexcept { return 2 * coordinates(); }
  int waveGenerator() const noexcept { return coordinates() - 2; }  ///< index of its angle
  int output() const noexcept { return coordinates() - 1; }         ///< index of its angle

  const RingDrive& drive() const noexcept { return drive_; }
  void setWave(const WaveGrowth& wave) noexcept { drive_.wave = wave; }
  bool driven(int coordinate) const noexcept { return inverse_mass_[coordinate] == 0.0; }
  const Eigen::VectorXd& mass() const noexcept { return mass_; }                 ///< [kg], [kg.m^2]
  const Eigen::VectorXd& inverseMass() const noexcept { return inverse_mass_; }  ///< 0 where driven

  /// Pairs every tooth out of contact with its nearest space.
  void pairTeeth(const Eigen::VectorXd& q, double time) noexcept;
  void setSpaces(const std::vector<int>& spaces) noexcept { shape_.space = spaces; }

  /// Brings everything below up to date with a state.
  void evaluate(const Eigen::VectorXd& q, const Eigen::VectorXd& v, double time) noexcept;

  const Eigen::VectorXd& force() const noexcept { return force_; }  ///< on every coordinate [N], [N.m]
  const RingShape& shape() const noexcept { return shape_; }
  const DrivePosition& position() const noexcept { return position_; }
  const RingForces& forces() const noexcept { return forces_; }  ///< of the elements, without the dashpots
  double storedEnergy() const noexcept { return model_.storedEnergy(forces_, position_); }  ///< [J]
  /// Of all coordinates; that of a driven body is constant and counts as its inertia says [J].
  double kineticEnergy(const Eigen::VectorXd& v) const noexcept { return 0.5 * v.cwiseAbs2().dot(mass_); }
  const RingPower& power() const noexcept { return power_; }

  /// Minus the derivative of the force at the state last evaluated: K + `by_speed` C, K by the coordinates, C by their
  /// speeds; `by_speed` [1/s]. What the dashpots change by the turning of their directions is left out, and so is the
  /// unsymmetric part of the polar contact: both only cost an iteration some digits.
  void tangent(double by_speed, RingTangent& tangent) const noexcept;

  /// The right-hand side for any solver: derivative of the state. Both of `states()` values.
  void rates(const double* state, double time, double* derivative) noexcept;

  /// Its derivative by the state, at the state last evaluated. The cup couples every tooth with every other by a matrix
  /// of rank one; without it the pattern, the same at every call, has some 20 entries a tooth and what is left out is
  /// - M^-1 k d d^T, from `cup_stiffness` and `cup_direction` of `tangent`.
  enum class Cup
  {
    DENSE,
    LEFT_OUT
  };
  Eigen::SparseMatrix<double> jacobian(Cup cup) const;

private:
  const JointModel& model_;
  RingDrive drive_;
  Eigen::VectorXd mass_;
  Eigen::VectorXd inverse_mass_;
  RingShape shape_;
  DrivePosition position_;
  RingForces forces_;
  Eigen::VectorXd growth_;  // N, of the wave generator's surface along each tooth's normal [m/s]
  Eigen::VectorXd force_;
  RingPower power_;
  Eigen::VectorXd q_;  // scratch
  Eigen::VectorXd v_;
};
}  // namespace hjt
