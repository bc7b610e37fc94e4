// SPDX-License-Identifier: BSD-3-Clause
#include "studies/dynamic_ring.hpp"

namespace hjt
{
namespace
{
using Triplets = std::vector<Eigen::Triplet<double>>;
}  // namespace

DynamicRing::DynamicRing(const JointModel& model, const RingParameters& parameters, const RingDrive& drive)
  : model_(model)
  , drive_(drive)
  , mass_(Eigen::VectorXd::Constant(2 * model.ring.rest.teeth() + 2, parameters.mass / model.ring.rest.teeth()))
  , shape_(model.ring.restShape({}))
  , forces_(model.ring.rest.teeth())
  , growth_(Eigen::VectorXd::Zero(model.ring.rest.teeth()))
  , force_(mass_.size())
  , q_(mass_.size())
  , v_(mass_.size())
{
  mass_.tail<2>() = model.inertia();
  inverse_mass_ = mass_.cwiseInverse();
  if (drive.wave_generator_driven)
  {
    inverse_mass_[waveGenerator()] = 0.0;
  }
  if (drive.output_driven)
  {
    inverse_mass_[output()] = 0.0;
  }
}

void DynamicRing::pairTeeth(const Eigen::VectorXd& q, double time) noexcept
{
  if (!model_.ring.meshed())
  {
    return;
  }
  position_ = { q[waveGenerator()], q[output()], drive_.wave.at(time) };
  shape_.points = q.head(2 * teeth());
  shape_.updateGeometry();
  model_.ring.of<ToothMesh>().pairNearest(position_, shape_);
}

void DynamicRing::evaluate(const Eigen::VectorXd& q, const Eigen::VectorXd& v, double time) noexcept
{
  const double motor_speed = v[waveGenerator()];
  const double output_speed = v[output()];
  const double growth_speed = drive_.wave.speed;
  position_ = { q[waveGenerator()], q[output()], drive_.wave.at(time) };
  shape_.points = q.head(2 * teeth());
  shape_.updateGeometry();
  model_.ring.forces(shape_, position_, forces_);
  const auto& contact = forces_.of<WaveGeneratorContact>();
  force_.head(2 * teeth()) = forces_.teeth;
  const Eigen::Vector2d torque =
      model_.torque(JointModel::summary(forces_), position_, drive_.motor_torque, drive_.load_torque);
  force_.tail<2>() = torque;
  force_[waveGenerator()] -= model_.motor.viscousFriction() * motor_speed;
  force_[output()] -= model_.load.viscousFriction() * output_speed;
  if (growth_speed != 0.0)
  {
    model_.ring.of<WaveGeneratorContact>().surfaceByAmplitude(position_, contact, growth_);
    growth_ *= growth_speed;
  }
  else
  {
    growth_.setZero();
  }
  const DashpotPower dashpots = model_.damping.addForces(shape_, contact, v, growth_, force_);
  power_.dissipated = dashpots.dissipated + model_.motor.viscousFriction() * motor_speed * motor_speed +
                      model_.load.viscousFriction() * output_speed * output_speed;
  power_.supplied = dashpots.supplied + contact.force.dot(growth_) +
                    model_.motor.rippled(drive_.motor_torque, position_.wave_generator_angle) * motor_speed -
                    drive_.load_torque * output_speed;
  // On a driven body, the force that prescribes its motion balances all other forces.
  for (const int k : { waveGenerator(), output() })
  {
    power_.supplied -= driven(k) ? force_[k] * v[k] : 0.0;
  }
}

void DynamicRing::tangent(double by_speed, RingTangent& tangent) const noexcept
{
  model_.ring.tangent(shape_, forces_, tangent);
  model_.damping.addTangent(shape_, forces_.of<WaveGeneratorContact>(), by_speed, tangent);
  tangent.wave_generator_stiffness += by_speed * model_.motor.viscousFriction();
  tangent.output_stiffness +=
      by_speed * model_.load.viscousFriction() + model_.load.gravityStiffness(position_.output_angle);
}

void DynamicRing::rates(const double* state, double time, double* derivative) noexcept
{
  const int n = coordinates();
  q_ = Eigen::Map<const Eigen::VectorXd>(state, n);
  v_ = Eigen::Map<const Eigen::VectorXd>(state + n, n);
  evaluate(q_, v_, time);
  Eigen::Map<Eigen::VectorXd>(derivative, n) = v_;
  Eigen::Map<Eigen::VectorXd>(derivative + n, n) = force_.cwiseProduct(inverse_mass_);
}

Eigen::SparseMatrix<double> DynamicRing::jacobian(Cup cup) const
{
  const int n = coordinates();
  RingTangent stiffness(teeth());
  RingTangent both(teeth());
  tangent(0.0, stiffness);
  tangent(1.0, both);
  Triplets entries;
  for (int k = 0; k < n; ++k)
  {
    entries.emplace_back(k, n + k, 1.0);
  }
  visitEntries(stiffness, [&](int row, int column, double value)
               { entries.emplace_back(n + row, column, -inverse_mass_[row] * value); });
  visitEntries(both, [&](int row, int column, double value)
               { entries.emplace_back(n + row, n + column, -inverse_mass_[row] * value); });
  visitEntries(stiffness, [&](int row, int column, double value)
               { entries.emplace_back(n + row, n + column, inverse_mass_[row] * value); });
  if (cup == Cup::DENSE)
  {
    const Eigen::VectorXd& d = stiffness.cup_direction;
    for (int row = 0; row < 2 * teeth(); ++row)
    {
      for (int column = 0; column < 2 * teeth(); ++column)
      {
        entries.emplace_back(n + row, column, -inverse_mass_[row] * stiffness.cup_stiffness * d[row] * d[column]);
      }
    }
  }
  Eigen::SparseMatrix<double> jacobian(2 * n, 2 * n);
  jacobian.setFromTriplets(entries.begin(), entries.end());
  return jacobian;
}
}  // namespace hjt
