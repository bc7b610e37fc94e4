// SPDX-License-Identifier: BSD-3-Clause
#include "studies/ratchet_analysis.hpp"

#include <algorithm>
#include <cmath>

#include "model/faults/joint_faults.hpp"
#include "solver/ring_equilibrium.hpp"

namespace hjt
{
namespace
{
/// The ring on a wave generator with elastic lobes.
class CompliantDrive
{
public:
  CompliantDrive(RingEquilibrium& ring, double lobe_stiffness)
    : ring_(ring)
    , stiffness_(lobe_stiffness)
    , amplitude_(ring.position().wave_amplitude)
    , surface_(ring.shape().teeth())
    , unloaded_(amplitudeForce())
  {
  }

  /// Moves the output to an angle [rad] and solves for the wave amplitude at which the lobes are in balance.
  SolveStatus moveOutput(double output_angle)
  {
    DrivePosition target = ring_.position();
    target.output_angle = output_angle;
    const SolveStatus status = move(target);
    return status.ok() && std::isfinite(stiffness_) ? balanceAmplitude() : status;
  }

  int snaps() const { return snaps_; }

  /// Inward force of the ring on each lobe, minus this force without load [N].
  double lobeForce() { return 0.5 * (amplitudeForce() - unloaded_); }

private:
  /// Derivative of the stored energy by the wave amplitude: inward force of the ring [N].
  double amplitudeForce()
  {
    ring_.model().of<WaveGeneratorContact>().surfaceByAmplitude(ring_.position(),
                                                                ring_.forces().of<WaveGeneratorContact>(), surface_);
    return ring_.forces().of<WaveGeneratorContact>().force.dot(surface_);
  }

  /// Unbalanced force on the wave amplitude [N]. The force grows with the amplitude by at least twice lobe_stiffness.
  double excess()
  {
    return amplitudeForce() - unloaded_ - 2.0 * stiffness_ * (amplitude_ - ring_.position().wave_amplitude);
  }

  /// Moves the ring to the position `target`. If single teeth snap on the way, descends to the next equilibrium.
  SolveStatus move(const DrivePosition& target)
  {
    const SolveStatus status = ring_.moveTo(target);
    if (status.ok())
    {
      return status;
    }
    ++snaps_;
    return ring_.descend(target);
  }

  SolveStatus moveAmplitude(double amplitude)
  {
    DrivePosition target = ring_.position();
    target.wave_amplitude = amplitude;
    return move(target);
  }

  /// Solves for the wave amplitude in balance, by the Illinois variant of the method of false position.
  SolveStatus balanceAmplitude()
  {
    constexpr int MAX_ITERATIONS = 60;
    constexpr double FORCE_TOLERANCE = 1e-3;  // N
    constexpr double FIRST_STEP = 1e-7;       // m
    double here = ring_.position().wave_amplitude;
    double here_excess = excess();
    double other = here;
    double other_excess = here_excess;
    SolveStatus status;
    double step = std::copysign(FIRST_STEP, -here_excess);
    while (status.ok() && here_excess * other_excess > 0.0 && std::abs(other_excess) > FORCE_TOLERANCE)
    {
      here = other;
      here_excess = other_excess;
      other = std::max(0.0, here + step);
      step *= 2.0;
      status = moveAmplitude(other);
      other_excess = excess();
      if (other == 0.0)
      {
        status.code = SolveCode::UNBALANCED;  // the lobes have collapsed: the force exceeds that of their springs
      }
    }
    for (int i = 0; i < MAX_ITERATIONS && status.ok() && std::abs(excess()) > FORCE_TOLERANCE; ++i)
    {
      const double middle = other - other_excess * (other - here) / (other_excess - here_excess);
      status = moveAmplitude(middle);
      const double middle_excess = excess();
      if (middle_excess * other_excess < 0.0)
      {
        here = other;
        here_excess = other_excess;
      }
      else
      {
        here_excess *= 0.5;
      }
      other = middle;
      other_excess = middle_excess;
    }
    if (status.ok() && std::abs(excess()) > FORCE_TOLERANCE)
    {
      status.code = SolveCode::ITERATION_LIMIT;
    }
    return status;
  }

  RingEquilibrium& ring_;
  double stiffness_;
  double amplitude_;
  Eigen::VectorXd surface_;  // working memory
  double unloaded_;
  int snaps_{};
};

RatchetRow rowOf(const RingEquilibrium& ring, CompliantDrive& drive, double unloaded_angle,
                 const std::vector<int>& unloaded_space)
{
  const RingForces& forces = ring.forces();
  RatchetRow row;
  row.output_angle = ring.position().output_angle - unloaded_angle;
  row.torque = forces.output_torque;
  row.wave_amplitude = ring.position().wave_amplitude;
  row.lobe_force = drive.lobeForce();
  row.snaps = drive.snaps();
  row.wave_generator_force_max = forces.of<WaveGeneratorContact>().force.maxCoeff();
  row.mesh_force_max = forces.of<ToothMesh>().flank_force.lpNorm<Eigen::Infinity>();
  for (int i = 0; i < ring.shape().teeth(); ++i)
  {
    row.depth_max = std::max(row.depth_max, ring.model().of<ToothMesh>().place(ring.shape(), ring.position(), i).depth);
    row.teeth_loaded += forces.of<ToothMesh>().meshed[i];
    row.teeth_jumped += forces.of<ToothMesh>().meshed[i] != 0 && ring.shape().space[i] != unloaded_space[i] ? 1 : 0;
  }
  return row;
}
}  // namespace

RatchetResult analyseRatchet(const Parameters& parameters, double wave_generator_angle, double lobe_stiffness,
                             double angle_step, double torque_limit, const std::function<void(double)>& progress)
{
  constexpr double FALL = 0.9;  // torque over the largest torque, below which the decrease is a jump of teeth
  RatchetResult result;
  const RingModel model = startingJoint(parameters).ring;
  RingEquilibrium ring(model, parameters.solver);
  result.status = insertUnderLoad(ring, wave_generator_angle, 0.0);
  if (!result.status.ok())
  {
    return result;
  }
  CompliantDrive drive(ring, lobe_stiffness);
  const double unloaded_angle = ring.position().output_angle;
  const std::vector<int> unloaded_space = ring.shape().space;
  result.end = RatchetEnd::LIMIT_REACHED;
  for (int i = 1; result.peak.torque < torque_limit; ++i)
  {
    if (!drive.moveOutput(unloaded_angle - i * angle_step).ok())
    {
      result.end = RatchetEnd::NO_EQUILIBRIUM;
      return result;
    }
    result.rows.push_back(rowOf(ring, drive, unloaded_angle, unloaded_space));
    const RatchetRow& row = result.rows.back();
    if (row.torque > result.peak.torque)
    {
      result.peak = row;
    }
    if (row.torque < FALL * result.peak.torque)
    {
      result.end = RatchetEnd::TEETH_JUMPED;
      return result;
    }
    if (progress)
    {
      progress(std::min(1.0, row.torque / torque_limit));
    }
  }
  return result;
}
}  // namespace hjt
