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
/// Calls `visit(row, column, value)` for every entry of a tangent over all coordinates, in an order that does not
/// depend on the values. The function omits the entries of the cup, which form a dense matrix of rank one.
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

/// Amplitude of the wave, which grows at constant speed. A step of the integration must end when this speed changes.
struct WaveGrowth
{
  double begin{};      ///< time at which the growth begins [s]
  double amplitude{};  ///< amplitude at `begin` [m]
  double speed{};      ///< speed of growth [m/s]

  double at(double time) const noexcept { return amplitude + speed * (time - begin); }  ///< amplitude at a time [m]
};

/// Torques and prescribed motion of a dynamic ring. A driven body keeps a constant speed, whatever the torques are.
struct RingDrive
{
  WaveGrowth wave;
  bool wave_generator_driven{};
  bool output_driven{};
  double motor_torque{};  ///< torque on the wave generator if this is not driven [N.m]
  double load_torque{};   ///< torque on the output if this is not driven; > 0 resists positive motion [N.m]
};

/// Powers at one instant [W].
struct RingPower
{
  double supplied{};    ///< power supplied by the motor or by prescribed motion, the load, and the growth of the wave
  double dissipated{};  ///< power dissipated by dashpots and viscous friction
};

/// The ring with a mass at every tooth, and wave generator and circular spline as two more bodies: M q'' = f(q, q', t).
///
/// Coordinates q: x and y of the N tooth points [m], wave generator angle and output angle [rad]. M is diagonal, with
/// masses [kg] and inertias [kg.m^2]. The state is q followed by the speeds q', 4 N + 4 values. The force f is that of
/// the ring's elements and dashpots, viscous friction of motor and load, and gravity on the load, without dry friction.
/// `pairTeeth` assigns spaces to teeth between steps, so that q'' is a fixed function of state and time within a step.
/// External solvers use `rates` and `jacobian`.
class DynamicRing
{
public:
  DynamicRing(const JointModel& model, const RingParameters& parameters, const RingDrive& drive);

  int teeth() const noexcept { return shape_.teeth(); }
  int coordinates() const noexcept { return static_cast<int>(mass_.size()); }  ///< number of coordinates, 2 N + 2
  int states() const noexcept { return 2 * coordinates(); }
  int waveGenerator() const noexcept { return coordinates() - 2; }  ///< index of the wave generator's angle
  int output() const noexcept { return coordinates() - 1; }         ///< index of the output's angle

  const RingDrive& drive() const noexcept { return drive_; }
  void setWave(const WaveGrowth& wave) noexcept { drive_.wave = wave; }
  bool driven(int coordinate) const noexcept { return inverse_mass_[coordinate] == 0.0; }
  const Eigen::VectorXd& mass() const noexcept { return mass_; }                 ///< diagonal of M [kg], [kg.m^2]
  const Eigen::VectorXd& inverseMass() const noexcept { return inverse_mass_; }  ///< 1 / mass(); 0 for a driven body

  /// Assigns the nearest space of the circular spline to every tooth that is not in contact.
  void pairTeeth(const Eigen::VectorXd& q, double time) noexcept;
  void setSpaces(const std::vector<int>& spaces) noexcept { shape_.space = spaces; }

  /// Computes force, shape, energies and power for the coordinates `q`, their speeds `v` and a time [s].
  void evaluate(const Eigen::VectorXd& q, const Eigen::VectorXd& v, double time) noexcept;

  const Eigen::VectorXd& force() const noexcept { return force_; }  ///< force on every coordinate [N], [N.m]
  const RingShape& shape() const noexcept { return shape_; }
  const DrivePosition& position() const noexcept { return position_; }
  const RingForces& forces() const noexcept { return forces_; }  ///< forces of the elements without the dashpots
  double storedEnergy() const noexcept { return model_.storedEnergy(forces_, position_); }  ///< [J]
  /// Kinetic energy of all coordinates, including the constant energy of driven bodies [J].
  double kineticEnergy(const Eigen::VectorXd& v) const noexcept { return 0.5 * v.cwiseAbs2().dot(mass_); }
  const RingPower& power() const noexcept { return power_; }

  /// Minus the derivative of the force at the last evaluated state: K + `by_speed` C, with K the derivative by the
  /// coordinates, C that by the speeds, and `by_speed` [1/s]. The function omits the change of the dashpots' directions
  /// and the unsymmetric part of the polar contact. Without these terms an iteration only converges more slowly.
  void tangent(double by_speed, RingTangent& tangent) const noexcept;

  /// Derivative of the state by time, for any solver. `state` and `derivative` have `states()` values each.
  void rates(const double* state, double time, double* derivative) noexcept;

  /// Derivative of `rates` by the state at the last evaluated state. The cup couples all teeth by a matrix of rank one.
  /// With LEFT_OUT the result omits this matrix, - M^-1 k d d^T with k and d `cup_stiffness` and `cup_direction` of
  /// `tangent`. The pattern of the result is then constant, with about 20 entries for a tooth.
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
  Eigen::VectorXd growth_;  // N speeds at which the growing wave moves its surface along each tooth's normal [m/s]
  Eigen::VectorXd force_;
  RingPower power_;
  Eigen::VectorXd q_;  // working memory
  Eigen::VectorXd v_;
};
}  // namespace hjt
