// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <functional>
#include <limits>
#include <string>

#include <gmock/gmock.h>

#include "element_under_test.hpp"
#include "gear/angle.hpp"
#include "gear/ratio.hpp"
#include "harmonic_joint_twin/base/errors.hpp"
#include "model/faults/joint_faults.hpp"
#include "random_ring.hpp"
#include "solver/ring_equilibrium.hpp"
#include "test/core/faults_support.hpp"
#include "test_parameters.hpp"
#include "twin_runs.hpp"

namespace hjt
{
namespace
{
/// What a fault acts on, measured on the standing or slowly driven gear.
struct Effect
{
  FaultKind kind;
  const char* what;
  std::function<double(const Parameters&)> measure;
};

double lostStiffness(const Parameters& parameters)
{
  return -StandingGear(parameters).at(0.0, 20.0).stiffness()(1, 1);
}

double lostMotion(const Parameters& parameters)
{
  StandingGear gear(parameters);
  const double there = gear.at(0.0, 1.0).position().output_angle;
  return std::abs(gear.at(0.0, -1.0).position().output_angle - there);
}

double unloadedWaveGenerator(const Parameters& parameters)
{
  return -StandingGear(parameters).at(0.0, 0.0).forces().of<WaveGeneratorContact>().force.sum();
}

/// What tooth 0 does not carry on the way of the wave generator past it.
double idleTooth(const Parameters& parameters)
{
  StandingGear gear(parameters);
  double carried = 0.0;
  for (int k = -30; k <= 30; ++k)
  {
    carried += std::abs(gear.at(0.02 * k, 40.0).forces().of<ToothMesh>().flank_force[0]);
  }
  return -carried;
}

/// Most that a tooth point stands off where it stands in the sound gear.
double ringShift(const Parameters& parameters)
{
  Parameters sound = parameters;
  sound.faults.clear();
  StandingGear gear(parameters);
  StandingGear sound_gear(sound);
  return (gear.at(0.3, 40.0).shape().points - sound_gear.at(0.3, 40.0).shape().points).lpNorm<Eigen::Infinity>();
}

/// Load that the teeth of the two lobes do not share alike, the largest over half a turn of the wave generator.
double unequalLobes(const Parameters& parameters)
{
  StandingGear gear(parameters);
  double largest = 0.0;
  for (int k = 0; k < 8; ++k)
  {
    const double angle = PI * k / 8.0;
    const Eigen::VectorXd& force = gear.at(angle, 40.0).forces().of<ToothMesh>().flank_force;
    double difference = 0.0;
    for (int i = 0; i < force.size(); ++i)
    {
      difference += std::copysign(std::abs(force[i]), std::cos(TWO_PI * i / static_cast<double>(force.size()) - angle));
    }
    largest = std::max(largest, std::abs(difference));
  }
  return largest;
}

double runningFriction(const Parameters& parameters)
{
  Twin twin(parameters);
  twin.commandMotorTorque(0, 1.0);
  twin.commandLoadTorque(0, 30.0);
  advance(twin, 20 * MILLISECOND);
  return twin.outputs().friction_torque;
}

/// Largest change of the load on the wave generator over a turn, the output free.
double roughness(const Parameters& parameters)
{
  Twin twin(parameters);
  twin.commandMotorTorque(0, 0.3);
  double low = std::numeric_limits<double>::max();
  double high = 0.0;
  for (Stamp t = MILLISECOND; t < 100 * MILLISECOND; t += MILLISECOND)
  {
    advance(twin, t);
    const double load = twin.health().lobes.wave_generator_force;
    low = std::min(low, load);
    high = std::max(high, load);
  }
  return high - low;
}

class Effects : public testing::TestWithParam<Effect>
{
};
INSTANTIATE_TEST_SUITE_P(
    Kinds, Effects,
    testing::Values(Effect{ FaultKind::INTERFACE_WEAR, "load of the wave generator", unloadedWaveGenerator },
                    Effect{ FaultKind::REAR_SECTION_CRACK, "stiffness", lostStiffness },
                    Effect{ FaultKind::LUBRICANT_DEGRADATION, "friction", runningFriction },
                    Effect{ FaultKind::TOOTH_WEAR, "lost motion", lostMotion },
                    Effect{ FaultKind::TOOTH_ROOT_CRACK, "load of the tooth", idleTooth },
                    Effect{ FaultKind::FLANGE_CRACK, "stiffness", lostStiffness },
                    Effect{ FaultKind::TOOTH_TIP_CRACK, "load of the tooth", idleTooth },
                    Effect{ FaultKind::PITTING, "stiffness", lostStiffness },
                    Effect{ FaultKind::WAVE_GENERATOR_WEAR, "load of the wave generator", unloadedWaveGenerator },
                    Effect{ FaultKind::FLEXSPLINE_CRACK, "shape of the ring", ringShift },
                    Effect{ FaultKind::BUCKLING, "stiffness", lostStiffness },
                    Effect{ FaultKind::RATCHETING, "load of the lobes", unequalLobes },
                    Effect{ FaultKind::BEARING_INNER_RACE, "load over a turn", roughness },
                    Effect{ FaultKind::BEARING_OUTER_RACE, "load over a turn", roughness },
                    Effect{ FaultKind::BEARING_BALL, "load over a turn", roughness },
                    Effect{ FaultKind::BEARING_CAGE, "load over a turn", roughness }),
    [](const auto& effect) { return std::string(describe(effect.param.kind).name); });

TEST_P(Effects, GrowWithSeverity)
{
  Parameters parameters = shippedParameters(RUN);
  double last = GetParam().measure(parameters);
  for (const double severity : { 0.1, 0.3, 0.6, 1.0 })
  {
    parameters.faults = { { GetParam().kind, severity, loadedPlace(GetParam().kind), 0.0 } };
    const double value = GetParam().measure(parameters);
    EXPECT_GT(value, last) << GetParam().what << " at severity " << severity;
    last = value;
  }
}
}  // namespace
}  // namespace hjt
