// SPDX-License-Identifier: BSD-3-Clause

#include <limits>

#include <gmock/gmock.h>

#include "gear/ratio.hpp"
#include "model/faults/joint_faults.hpp"
#include "test/core/element_under_test.hpp"
#include "test/core/random_ring.hpp"
#include "test/core/test_parameters.hpp"
#include "test/core/twin_runs.hpp"

namespace hjt
{
namespace
{
const std::vector<std::string> RUN{ "input.command_timeout=10.0" };

/// A place in the loaded lobe, where every kind shows.
int loadedPlace(FaultKind kind)
{
  return describe(kind).whole ? WHOLE_MEMBER : 0;
}

FaultList listOf(const std::vector<Fault>& faults)
{
  FaultList list;
  for (const Fault& fault : faults)
  {
    list.set(fault, 0);
  }
  return list;
}

/// The ring of a gear with the faults that its parameters name, in equilibrium.
class StandingGear
{
public:
  explicit StandingGear(const Parameters& parameters)
    : faults_(parameters, listOf(parameters.faults)), ring_(faults_.model().ring, parameters.solver)
  {
    EXPECT_TRUE(ring_.insert({ 0.0, 0.0, parameters.gear.wave_amplitude }).ok());
  }

  /// Wave generator at `angle` [rad], `torque` at the output [N.m].
  const RingEquilibrium& at(double angle, double torque)
  {
    EXPECT_TRUE(balanceOutput(ring_, angle, torque).ok());
    return ring_;
  }

private:
  JointFaults faults_;
  RingEquilibrium ring_;
};

/// A twin under torque and load: some tooth pitches on, then back.
std::vector<double> historyOf(Twin& twin)
{
  std::vector<double> history;
  twin.commandMotorTorque(0, 1.0);
  twin.commandLoadTorque(0, 30.0);
  twin.commandMotorTorque(4 * MILLISECOND, -1.0);
  while (twin.step(8 * MILLISECOND))
  {
    const std::vector<double> row = numbers(twin.outputs());
    history.insert(history.end(), row.begin(), row.end());
  }
  return history;
}

using EveryKind = testing::TestWithParam<FaultKind>;
std::vector<FaultKind> allKinds()
{
  std::vector<FaultKind> kinds;
  for (const FaultDescription& description : FAULT_DESCRIPTIONS)
  {
    kinds.push_back(description.kind);
  }
  return kinds;
}
INSTANTIATE_TEST_SUITE_P(Kinds, EveryKind, testing::ValuesIn(allKinds()),
                         [](const auto& kind) { return std::string(describe(kind.param).name); });

TEST_P(EveryKind, AtSeverityZeroChangesNoBit)
{
  Parameters parameters = shippedParameters(RUN);
  Twin sound(parameters);
  const std::vector<double> expected = historyOf(sound);
  parameters.faults.push_back({ GetParam(), 0.0, loadedPlace(GetParam()), 0.0 });
  Twin configured(parameters);
  EXPECT_EQ(historyOf(configured), expected);
  Twin injected(shippedParameters(RUN));
  injected.injectFault(2 * MILLISECOND, { GetParam(), 0.0, loadedPlace(GetParam()), 0.0 });
  EXPECT_EQ(historyOf(injected), expected);
}

TEST_P(EveryKind, ChangesTheDriveAndResetTakesItAway)
{
  Twin sound(shippedParameters(RUN));
  const std::vector<double> expected = historyOf(sound);
  Twin twin(shippedParameters(RUN));
  twin.injectFault(0, { GetParam(), 1.0, loadedPlace(GetParam()), 0.0 });
  EXPECT_NE(historyOf(twin), expected);
  EXPECT_EQ(twin.counters().solver_failures, 0U);
  EXPECT_EQ(twin.activeFaults().size(), 1U);
  twin.reset(0);
  EXPECT_TRUE(twin.activeFaults().empty());
  EXPECT_EQ(historyOf(twin), expected);
}

TEST_P(EveryKind, ClearedLeavesTheSoundJointToTheLastBit)
{
  const Parameters parameters = shippedParameters();
  const JointModel sound(parameters);
  JointFaults faults(parameters);
  const JointModel& model = faults.model();
  FaultList list = listOf({ { GetParam(), 0.7, loadedPlace(GetParam()), 0.0 } });
  faults.apply(list);
  list.set({ GetParam(), 0.0, loadedPlace(GetParam()), 0.0 }, 1);
  EXPECT_TRUE(list.empty());
  faults.apply(list);
  RandomRing ring(3);
  const auto [shape, position] = ring.draw(sound.ring);
  RingForces here(shape.teeth());
  RingForces there(shape.teeth());
  sound.ring.forces(shape, position, here);
  model.ring.forces(shape, position, there);
  EXPECT_EQ(here.energy, there.energy);
  EXPECT_EQ(allForces(here), allForces(there));
  EXPECT_EQ(sound.bearing.torque(100.0, 500.0, 20.0), model.bearing.torque(100.0, 500.0, 20.0));
  EXPECT_EQ(sound.mesh_friction.coefficient(1e-3), model.mesh_friction.coefficient(1e-3));
}

TEST_P(EveryKind, RingOfAFaultyGearIsTheGradientOfItsEnergy)
{
  const Parameters parameters =
      goldenParameters({ "contact.smoothing=20.0e-6", "mesh.smoothing=20.0e-6", "fault_scale.spall_length=5.0e-3" });
  const JointFaults faults(parameters, listOf({ { GetParam(), 0.7, loadedPlace(GetParam()), 0.0 } }));
  const JointModel& model = faults.model();
  const ElementUnderTest whole{ [&](auto& shape, auto& position, auto& forces)
                                { model.ring.forces(shape, position, forces); },
                                [&](auto& shape, auto& forces, auto& tangent)
                                { model.ring.tangent(shape, forces, tangent); } };
  RandomRing ring(11);
  for (int k = 0; k < 3; ++k)
  {
    const auto [shape, position] = ring.draw(model.ring);
    expectGradientAndTangent(whole, shape, position);
  }
}

TEST_P(EveryKind, EnergyBalancesWhenItSetsIn)
{
  // At full speed a step is a tooth pitch, and the quadrature of the torques the larger error.
  Twin twin(shippedParameters({ RUN.front(), "motor.speed_limit=150.0" }));
  twin.commandMotorTorque(0, 2.0);
  twin.commandLoadTorque(0, 60.0);
  twin.injectFault(20 * MILLISECOND, { GetParam(), 1.0, loadedPlace(GetParam()), 0.0 });
  twin.injectFault(40 * MILLISECOND, { GetParam(), 0.0, loadedPlace(GetParam()), 0.0 });
  double worst = 0.0;
  double work = 0.0;
  while (twin.step(60 * MILLISECOND))
  {
    worst = std::max(worst, std::abs(twin.outputs().energy_residual));
    work += std::abs(2.0 * twin.outputs().motor_velocity * 1e-4);
  }
  EXPECT_EQ(twin.counters().solver_failures, 0U);
  EXPECT_LT(worst, 1e-4 * work) << "of " << work << " J, released " << twin.outputs().released_energy
                                << " J, steps with jumps " << twin.counters().jumps;
}

/// Of the compliance of a whole gear what is not the wall's stays.
TEST(Faults, OfTheCupSoftenItsWallAlone)
{
  Parameters parameters = shippedParameters();
  const FaultScaleParameters& scale = parameters.fault_scale;
  const double cracked = scale.cup_crack_fraction / (1.0 - scale.cup_crack_fraction);
  const double sound = 1.0 / StandingGear(parameters).at(0.0, 5.0).stiffness()(1, 1);
  struct Row
  {
    FaultKind kind;
    double softer;  // compliance added over that of the wall
  };
  for (const Row& row : { Row{ FaultKind::FLANGE_CRACK, scale.flange_share * cracked },
                          Row{ FaultKind::REAR_SECTION_CRACK, scale.rear_section_share * cracked } })
  {
    parameters.faults = { { row.kind, 1.0, WHOLE_MEMBER, 0.0 } };
    const double added = 1.0 / StandingGear(parameters).at(0.0, 5.0).stiffness()(1, 1) - sound;
    // The wave generator takes 1/101 of the load, the cup the rest, and the output turns by as much of the cup's
    // rotation. Rim and teeth under the same torque give way as before.
    const double share = 1.0 - 1.0 / nominalRatio(parameters.gear);
    EXPECT_NEAR(added * parameters.cup.wall_stiffness / (share * share), row.softer, 1e-3 * row.softer)
        << describe(row.kind).name;
  }
}

/// What a fault of severity 1/2 makes of its tooth, by the laws of docs/faults.md.
TEST(Faults, ChangeAToothByTheirLaws)
{
  constexpr int TOOTH = 7;
  const Parameters parameters = shippedParameters();
  const FaultScaleParameters& scale = parameters.fault_scale;
  const GearParameters& gear = parameters.gear;
  // Of the compliance of a sound pair the tooth's bending is a share; the rest stays.
  const auto pair = [&](double bending)
  { return 1.0 / (1.0 - scale.tooth_compliance_share + scale.tooth_compliance_share / bending); };
  const double worn = 0.5 * scale.tooth_wear_depth / std::cos(parameters.mesh.flank_angle);
  const double thickness = PI * (gear.flexspline_inner_radius + gear.toothMidHeight()) / gear.teeth_flexspline;
  struct Row
  {
    FaultKind kind;
    double stiffness;  // over that of a sound pair [-]
    double clearance;  // added [m]
    double friction;   // of the flanks, over that of sound flanks [-]
    double tip_loss;   // [m]
  };
  for (const Row& row : { Row{ FaultKind::TOOTH_ROOT_CRACK, pair(std::pow(0.5, 3)), 0.0, 1.0, 0.0 },
                          Row{ FaultKind::TOOTH_TIP_CRACK, pair(1.0 / (1.0 + 3.0 * std::pow(0.5, 3))), 0.0, 1.0, 0.0 },
                          Row{ FaultKind::TOOTH_WEAR, pair(std::pow(1.0 - 2.0 * worn / thickness, 3)), worn, 1.0, 0.0 },
                          Row{ FaultKind::PITTING, 1.0 - 0.5 * scale.pitted_fraction, 0.0,
                               0.5 * (1.0 + scale.pitted_friction_factor), 0.0 },
                          Row{ FaultKind::RATCHETING, 1.0, 0.0, 1.0, 0.5 * scale.ratcheting_tip_loss } })
  {
    SCOPED_TRACE(describe(row.kind).name);
    const bool is_whole = row.kind == FaultKind::RATCHETING;
    const JointFaults faults(parameters, listOf({ { row.kind, 0.5, is_whole ? WHOLE_MEMBER : TOOTH, 0.0 } }));
    JointModel joint = faults.model();
    JointModel sound(parameters);
    ToothMesh& mesh = joint.ring.edit<ToothMesh>();
    ToothMesh& sound_mesh = sound.ring.edit<ToothMesh>();
    EXPECT_NEAR(mesh.stiffness()[TOOTH] / sound_mesh.stiffness()[TOOTH], row.stiffness, 1e-12);
    EXPECT_NEAR(mesh.clearance()[TOOTH] - sound_mesh.clearance()[TOOTH], row.clearance, 1e-15);
    EXPECT_NEAR(mesh.tipLoss()[TOOTH] - sound_mesh.tipLoss()[TOOTH], row.tip_loss, 1e-15);
    EXPECT_NEAR(joint.mesh_friction.toothFactor()[TOOTH] / sound.mesh_friction.toothFactor()[TOOTH], row.friction,
                1e-12);
    if (!is_whole)
    {
      EXPECT_EQ(mesh.stiffness()[TOOTH + 1], sound_mesh.stiffness()[TOOTH + 1]);
      EXPECT_EQ(mesh.clearance()[TOOTH + 1], sound_mesh.clearance()[TOOTH + 1]);
    }
  }
}

TEST(Faults, OfTheLubricantChangeEveryFrictionByTheirLaw)
{
  const Parameters parameters = shippedParameters({ "bearing.constant_share=0.0" });
  const FaultScaleParameters& scale = parameters.fault_scale;
  const JointFaults faults(parameters, listOf({ { FaultKind::LUBRICANT_DEGRADATION, 0.5, WHOLE_MEMBER, 0.0 } }));
  const JointModel sound(parameters);
  const JointModel& joint = faults.model();
  EXPECT_NEAR(joint.mesh_friction.coefficient(1e-3) / sound.mesh_friction.coefficient(1e-3),
              0.5 * (1.0 + scale.boundary_friction_factor), 1e-12);
  EXPECT_NEAR(joint.bearing.viscosity(20.0) / sound.bearing.viscosity(20.0), 0.5 * (1.0 + scale.viscosity_factor),
              1e-9);
}

TEST(Faults, ComposeInAnyOrderAndSetInLiveAsConfigured)
{
  std::vector<Fault> faults;
  for (const FaultKind kind : allKinds())
  {
    faults.push_back({ kind, 0.3, loadedPlace(kind), 0.0 });
  }
  Parameters parameters = shippedParameters(RUN);
  parameters.faults = faults;
  Twin one(parameters);
  parameters.faults.assign(faults.rbegin(), faults.rend());
  Twin other(parameters);
  EXPECT_EQ(one.activeFaults().size(), FAULT_KINDS);
  EXPECT_EQ(historyOf(one), historyOf(other));
  // By onset, or by injection at the same stamp: before, while, in any order.
  parameters.faults = faults;
  for (Fault& fault : parameters.faults)
  {
    fault.onset = 3e-3;
  }
  Twin configured(parameters);
  Twin injected(shippedParameters(RUN));
  for (auto fault = faults.rbegin(); fault != faults.rend(); ++fault)
  {
    injected.injectFault(3 * MILLISECOND, *fault);
  }
  EXPECT_EQ(historyOf(configured), historyOf(injected));
  ASSERT_EQ(injected.activeFaults().size(), FAULT_KINDS);
  EXPECT_EQ(injected.activeFaults().begin()->since, 3 * MILLISECOND);
}

TEST(Faults, AreRefusedWithKeyValueAndRange)
{
  Twin twin(shippedParameters());
  const Fault good{ FaultKind::TOOTH_WEAR, 0.5, 3, 0.0 };
  for (const Fault& bad :
       { Fault{ FaultKind::TOOTH_WEAR, 1.1, 3, 0.0 }, Fault{ FaultKind::TOOTH_WEAR, -0.1, 3, 0.0 },
         Fault{ FaultKind::TOOTH_WEAR, std::nan(""), 3, 0.0 }, Fault{ FaultKind::TOOTH_WEAR, 0.5, 200, 0.0 },
         Fault{ FaultKind::TOOTH_ROOT_CRACK, 0.5, WHOLE_MEMBER, 0.0 }, Fault{ FaultKind::FLANGE_CRACK, 0.5, 0, 0.0 },
         Fault{ FaultKind::BEARING_BALL, 0.5, 23, 0.0 }, Fault{ FaultKind::TOOTH_WEAR, 0.5, 3, -1.0 },
         Fault{ FaultKind(77), 0.5, 0, 0.0 } })
  {
    twin.injectFault(0, bad);
  }
  EXPECT_EQ(twin.counters().faults.refused, 9U);
  EXPECT_EQ(twin.counters().faults.accepted, 0U);
  for (int i = 0; i < 1000; ++i)
  {
    twin.injectFault(0, good);
  }
  EXPECT_EQ(twin.counters().faults.accepted, FaultSchedule::CAPACITY);
  EXPECT_EQ(twin.counters().faults.no_room, 1000 - FaultSchedule::CAPACITY);
  advance(twin, MILLISECOND);
  EXPECT_EQ(twin.activeFaults().size(), 1U);
  EXPECT_EQ(twin.counters().faults.no_room, 1000 - FaultSchedule::CAPACITY);
}

TEST(Faults, ThatComeLateDoNotUndoWhatIsNewer)
{
  Twin twin(shippedParameters());
  const Fault worn{ FaultKind::TOOTH_WEAR, 0.5, 3, 0.0 };
  const Fault sound{ FaultKind::TOOTH_WEAR, 0.0, 3, 0.0 };
  const Fault worse{ FaultKind::TOOTH_WEAR, 0.8, 3, 0.0 };
  advance(twin, 10 * MILLISECOND);
  twin.injectFault(8 * MILLISECOND, sound);
  advance(twin, 11 * MILLISECOND);
  twin.injectFault(7 * MILLISECOND, worn);
  advance(twin, 12 * MILLISECOND);
  EXPECT_TRUE(twin.activeFaults().empty()) << "cleared after it set in";
  twin.injectFault(9 * MILLISECOND, worse);
  twin.injectFault(8500 * MILLISECOND / 1000, worn);
  advance(twin, 13 * MILLISECOND);
  ASSERT_EQ(twin.activeFaults().size(), 1U);
  EXPECT_EQ(twin.activeFaults().begin()->fault.severity, 0.8);
  EXPECT_EQ(twin.activeFaults().begin()->since, 9 * MILLISECOND);
  EXPECT_EQ(twin.counters().faults.late, 4U);
  twin.reset(0);
  for (const Fault& fault : { worn, Fault{ FaultKind::TOOTH_WEAR, 0.2, 3, 0.0 }, worse })
  {
    twin.injectFault(2 * MILLISECOND, fault);
  }
  advance(twin, 3 * MILLISECOND);
  ASSERT_EQ(twin.activeFaults().size(), 1U) << "reset forgets";
  EXPECT_EQ(twin.activeFaults().begin()->fault.severity, 0.8) << "of one stamp the last that came";
}

TEST(FaultList, HasRoomForSoMany)
{
  FaultList list;
  for (int i = 0; i < static_cast<int>(MAX_FAULTS); ++i)
  {
    EXPECT_TRUE(list.set({ FaultKind::TOOTH_WEAR, 0.5, i, 0.0 }, 0));
  }
  EXPECT_FALSE(list.set({ FaultKind::TOOTH_WEAR, 0.5, WHOLE_MEMBER, 0.0 }, 0));
  EXPECT_TRUE(list.set({ FaultKind::TOOTH_WEAR, 0.6, 7, 0.0 }, 0)) << "one that is there";
  EXPECT_TRUE(list.set({ FaultKind::TOOTH_WEAR, 0.0, 7, 0.0 }, 0));
  EXPECT_TRUE(list.set({ FaultKind::TOOTH_WEAR, 0.5, WHOLE_MEMBER, 0.0 }, 0));
  EXPECT_EQ(list.begin()->fault.place, WHOLE_MEMBER);
}

TEST(FaultDescriptions, GiveTheOrdersOfTheGearInQuestion)
{
  const Parameters parameters = shippedParameters();
  EXPECT_EQ(shownFirst(FaultKind::BEARING_INNER_RACE, parameters), "order 12.68");
  EXPECT_EQ(shownFirst(FaultKind::BEARING_BALL, parameters), "orders 9.65 and 1.10");
  EXPECT_EQ(shownFirst(FaultKind::BEARING_CAGE, parameters),
            "order 1.10: twice the difference of 1 and the cage's order 0.45");
  EXPECT_EQ(shownFirst(FaultKind::RATCHETING, parameters), "running torque, orders 2 and 1.98");
  // 15 balls, 7 mm on 50 mm: the cage turns at 0.43.
  const Parameters other =
      shippedParameters({ "bearing.balls=15", "bearing.ball_diameter=7.0e-3", "bearing.pitch_diameter=50.0e-3" });
  EXPECT_EQ(shownFirst(FaultKind::BEARING_INNER_RACE, other), "order 8.55");
  EXPECT_EQ(shownFirst(FaultKind::BEARING_OUTER_RACE, other), "order 6.45 with sidebands at a distance of 2");
}

TEST(RootCrack, GoesWhereTheBackupRatioSendsIt)
{
  GearParameters gear = shippedParameters().gear;
  EXPECT_TRUE(rootCrackRunsThroughTooth(gear)) << "0.8 over 0.5";
  gear.rim_thickness = 0.6 * gear.tooth_height_flexspline;
  EXPECT_FALSE(rootCrackRunsThroughTooth(gear));
  // A thin rim hangs by what is left.
  Parameters parameters = goldenParameters();
  parameters.gear.rim_thickness = gear.rim_thickness;
  const JointFaults faults(parameters, listOf({ { FaultKind::TOOTH_ROOT_CRACK, 1.0, 40, 0.0 } }));
  const JointModel& model = faults.model();
  const double left = 1.0 - parameters.fault_scale.rim_crack_depth;
  EXPECT_DOUBLE_EQ(model.ring.of<RimTension>().stiffness()[40], left * parameters.ring.tension_stiffness);
  EXPECT_DOUBLE_EQ(model.ring.of<RimBending>().stiffness()[40], left * left * left * parameters.ring.bending_stiffness);
  EXPECT_EQ(model.ring.of<ToothMesh>().stiffness()[40], parameters.mesh.stiffness);
}

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

using Effects = testing::TestWithParam<Effect>;
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

/// How often the sag over one tooth, or anywhere, has a maximum in `turns` of the wave generator.
TEST(RaceDeflection, OrdersComeOutOfTheKinematics)
{
  Parameters parameters = shippedParameters();
  const int teeth = parameters.gear.teeth_flexspline;
  const auto events_per_turn = [&](const std::function<void(RaceDeflection&)>& damage)
  {
    RaceDeflection bearing(parameters.bearing);
    damage(bearing);
    Eigen::VectorXd sag(teeth);
    Eigen::VectorXd rate(teeth);
    Eigen::VectorXd second(teeth);
    constexpr int TURNS = 200;
    constexpr int STEPS = 1000;  // a turn
    int events = 0;
    bool sagged = true;
    for (int k = 0; k < TURNS * STEPS; ++k)
    {
      bearing.at(TWO_PI * k / STEPS, sag, rate, second);
      const bool sags = sag.maxCoeff() > 0.0;
      events += sags && !sagged ? 1 : 0;
      sagged = sags;
    }
    return static_cast<double>(events) / TURNS;
  };
  const double length = 1e-3;
  EXPECT_NEAR(events_per_turn([&](RaceDeflection& b) { b.addInnerSpall(0.3, 1e-5, length); }), 12.6793, 0.006);
  EXPECT_NEAR(events_per_turn([&](RaceDeflection& b) { b.addOuterSpall(0.3, 1e-5, length); }), 10.3207, 0.006);
  EXPECT_NEAR(events_per_turn([&](RaceDeflection& b) { b.addBallSpall(4, 1e-5, length); }), 2.0 * 4.8244, 0.006);
  EXPECT_NEAR(RaceDeflection(parameters.bearing).cageRate(), 0.4487, 5e-5);
  // Balls and cage that lag pass the outer race less often and the inner one, which runs ahead, more often.
  parameters.bearing.cage_slip = 0.02;
  EXPECT_NEAR(events_per_turn([&](RaceDeflection& b) { b.addInnerSpall(0.3, 1e-5, length); }), 12.8857, 0.006);
  EXPECT_NEAR(events_per_turn([&](RaceDeflection& b) { b.addOuterSpall(0.3, 1e-5, length); }), 10.1143, 0.006);
  EXPECT_NEAR(events_per_turn([&](RaceDeflection& b) { b.addBallSpall(4, 1e-5, length); }), 2.0 * 4.7279, 0.006);
}

TEST(RaceDeflection, NoBallDropsButTheOneThatMay)
{
  const Parameters parameters = shippedParameters();
  std::vector<RaceDeflection> bearings(5, RaceDeflection(parameters.bearing));
  bearings[0].addInnerSpall(2.3, 1e-5, 2e-3);
  bearings[1].addInnerSpall(-1.1, 1e-5, 4e-3);  // nearly from ball to ball
  bearings[2].addOuterSpall(6.2, 1e-5, 2e-3);
  bearings[3].addBallSpall(4, 1e-5, 2e-3);
  bearings[4].addIdleBall(22, 1e-5);
  for (const RaceDeflection& bearing : bearings)
  {
    ASSERT_TRUE(bearing.dropsOneBall());
    int drops = 0;
    for (double angle = -700.0; angle < 700.0; angle += 0.0713)
    {
      const int dropping = bearing.ballThatMayDrop(angle);
      ASSERT_TRUE(dropping >= 0 && dropping < bearing.balls());
      drops += bearing.drop(dropping, angle).value > 0.0 ? 1 : 0;
      for (int ball = 0; ball < bearing.balls(); ++ball)
      {
        ASSERT_TRUE(ball == dropping || bearing.drop(ball, angle).value == 0.0) << ball << " at " << angle;
      }
    }
    EXPECT_GT(drops, 100);
  }
}

TEST(RaceDeflection, OfAllBallsIsTheSameAllRound)
{
  const Parameters parameters = shippedParameters();
  RaceDeflection bearing(parameters.bearing);
  for (int ball = 0; ball < parameters.bearing.balls; ++ball)
  {
    bearing.addIdleBall(ball, 3e-6);
  }
  Eigen::VectorXd sag(200);
  Eigen::VectorXd rate(200);
  Eigen::VectorXd second(200);
  bearing.at(12.34, sag, rate, second);
  EXPECT_NEAR(sag.minCoeff(), 3e-6, 1e-15);
  EXPECT_NEAR(sag.maxCoeff(), 3e-6, 1e-15);
}
}  // namespace
}  // namespace hjt
