// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "test/support/allocation_count.hpp"
#include "test/support/temporary_folder.hpp"
#include "test_parameters.hpp"

#include "gear/angle.hpp"
#include "harmonic_joint_twin/base/errors.hpp"
#include "life/drive_ageing.hpp"
#include "life/life_estimate.hpp"
#include "life/revolution_load_map.hpp"
#include "studies/life_trials.hpp"
#include "test/core/life_support.hpp"

namespace hjt
{
namespace
{
/// A motion like a robot's, as the loop counts it and as one duty cycle.
struct CountedMotion
{
  CountedMotion() : record(shippedLife())
  {
    constexpr int SAMPLES = 36000;  // of a tenth of a second
    for (int i = 0; i < SAMPLES; ++i)
    {
      const double swing = std::sin(1e-3 * i);
      const DutyPhase sample{ 0.1, 150.0 * std::abs(swing), 60.0 * swing, 25.0 + 20.0 * i / SAMPLES };
      record.add(sample);
      motion.phases.push_back(sample);
    }
  }

  UsageHistory record;
  DutyCycle motion;
};

TEST(UsageHistory, KeepsTimeTurnsAndLoadsOfAMotion)
{
  const CountedMotion counted;
  const DutyCycle duty = counted.record.duty();
  EXPECT_LT(duty.phases.size(), 150U) << "of 36000 samples, under loads of both signs";
  EXPECT_NEAR(counted.record.hours(), 1.0, 1e-9);
  EXPECT_NEAR(counted.record.turns(), counted.motion.turnsPerHour(), 1e-6);
  const LifeParameters life = shippedLife();
  const auto sums = [&](const DutyCycle& of)
  {
    std::array<double, 4> sum{};
    for (const DutyPhase& phase : of.phases)
    {
      sum[0] += phase.turns() * std::abs(phase.load_torque);
      sum[1] += phase.turns() * phase.temperature;
      sum[2] += phase.turns() * bearingWear(life, phase.load_torque);
      sum[3] += phase.turns() * greaseAgeing(life, phase.temperature);
    }
    return sum;
  };
  const std::array<double, 4> kept = sums(duty);
  const std::array<double, 4> truth = sums(counted.motion);
  EXPECT_NEAR(kept[0] / truth[0], 1.0, 1e-9) << "load";
  EXPECT_NEAR(kept[1] / truth[1], 1.0, 1e-9) << "temperature";
  EXPECT_NEAR(kept[2] / truth[2], 1.0, 5e-3) << "wear of the bearing, by the cube of the load";
  EXPECT_NEAR(kept[3] / truth[3], 1.0, 2e-2) << "ageing of the grease, halved every 15 K";
}

TEST(UsageHistory, AgesTheDriveAsItsMotionDoes)
{
  const Parameters parameters = shippedParameters();
  DutyCycle motion;
  UsageHistory record(parameters.life);
  for (int i = 0; i < 20; ++i)
  {
    motion.phases.push_back({ 1800.0, 200.0, 3.3 * i, 40.0 });
    record.add(motion.phases.back());
  }
  RevolutionLoadMap load_map(parameters, 8);
  load_map.cover(motion, {});
  const DriveAgeing ageing(parameters, motion, load_map);
  const DriveAge age = ageing.live(nominalDrive(parameters.life), 10.0, 10.0, true, {}).age;
  const LifeEstimate estimate = LifeEstimator(parameters).estimate(record, nullptr, 0.0);
  EXPECT_NEAR(estimate.hours, 10.0, 1e-9);
  const auto expect_share = [&](EndOfLife limit, double of)
  { EXPECT_NEAR(estimate.usedOf(limit) / of, 1.0, 0.01) << nameOf(limit); };
  expect_share(EndOfLife::FLANK_WEAR, age.worstFlank() / parameters.life.flank_wear_limit);
  expect_share(EndOfLife::INTERFACE_WEAR, age.interface_wear / parameters.life.interface_wear_limit);
  const UnitVariation nominal = nominalDrive(parameters.life);
  expect_share(EndOfLife::BEARING, age.bearing_turns / nominal.bearing_life / (1.0 + nominal.spall_growth));
  EXPECT_NEAR(estimate.grease_used, age.grease, 1e-9);
}

/// Drives whose wear is known and whose flexspline does not tire: of what is left the bearing decides.
TEST(LifeEstimator, TellsTheCataloguesLifeOfANewDriveAtTheRatedPoint)
{
  const Parameters parameters = shippedParameters({ "life.wear_spread=0.4", "life.endurance_limit=1000e6" });
  LifeEstimator estimator(parameters);
  UsageHistory record(parameters.life);
  DutyPhase rated = ratedDuty(parameters.life.grease_temperature).phases[0];
  record.add(rated);
  const LifeEstimate fresh = estimator.estimate(record, nullptr, 0.0);
  EXPECT_EQ(fresh.nearest(), EndOfLife::BEARING);
  EXPECT_NEAR(fresh.remaining.quantile[1], (1.0 + parameters.life.spall_growth) * parameters.life.bearing_l10,
              0.15 * parameters.life.bearing_l10);
  // Who has come so far is one of the better drives, and has less before it than they had when new.
  rated.duration = 3600.0 * parameters.life.bearing_l50;
  record.add(rated);
  const LifeEstimate worn = estimator.estimate(record, nullptr, 0.0);
  EXPECT_GT(worn.remaining.quantile[0], 0.0);
  EXPECT_GT(worn.remaining.quantile[2], fresh.remaining.quantile[2] - parameters.life.bearing_l50);
  EXPECT_LT(worn.remaining.quantile[2], fresh.remaining.quantile[2]);
}

TEST(LifeEstimator, OfADriveWhoseWearNobodyHasMeasuredIsWide)
{
  const auto fresh = [](const Parameters& parameters)
  {
    LifeEstimator estimator(parameters);
    UsageHistory record(parameters.life);
    record.add(ratedDuty(parameters.life.grease_temperature).phases[0]);
    return estimator.estimate(record, nullptr, 0.0).remaining;
  };
  const RemainingHours known = fresh(shippedParameters({ "life.wear_spread=0.4" }));
  const RemainingHours shipped = fresh(shippedParameters());
  EXPECT_LT(shipped.quantile[1], 0.7 * known.quantile[1]);
  EXPECT_GT(shipped.by_cause[0], 0.1) << "flanks";
  EXPECT_GT(shipped.by_cause[1], 0.05) << "interface";
}

TEST(UsageHistory, IsTheSameAfterItsFile)
{
  const TemporaryFolder folder;
  const CountedMotion counted;
  const std::string path = folder.write("use.csv", counted.record.text());
  const UsageHistory read(shippedLife(), path);
  const DutyCycle before = counted.record.duty();
  const DutyCycle after = read.duty();
  ASSERT_EQ(after.phases.size(), before.phases.size());
  for (std::size_t i = 0; i < after.phases.size(); ++i)
  {
    EXPECT_EQ(after.phases[i].duration, before.phases[i].duration);
    EXPECT_NEAR(after.phases[i].motor_speed, before.phases[i].motor_speed, 1e-12 * before.phases[i].motor_speed);
    EXPECT_EQ(after.phases[i].load_torque, before.phases[i].load_torque);
    EXPECT_EQ(after.phases[i].temperature, before.phases[i].temperature);
  }
  folder.write("use.csv", "duration,motor_speed,load_torque\n10,0,5\n");
  EXPECT_THROW(UsageHistory(shippedLife(), path), InputError);
}

TEST(DutyCycle, RefusesNumbersThatNoDriveHas)
{
  const TemporaryFolder folder;
  const std::string path = (folder.path() / "duty.csv").string();
  const auto write = [&](const std::string& rows)
  { folder.write("duty.csv", "duration,motor_speed,load_torque,temperature\n" + rows); };
  write("10,0,5,20\n");
  EXPECT_THROW(DutyCycle::fromFile(path), InputError);
  write("0,10,5,20\n");
  EXPECT_THROW(DutyCycle::fromFile(path), InputError);
  for (const char* row :
       { "1e308,10,5,20\n", "10,1e308,5,20\n", "10,-1e308,5,20\n", "10,10,1e308,20\n", "10,10,5,1e308\n" })
  {
    write(row);
    EXPECT_THROW(DutyCycle::fromFile(path), InputError) << row;
    EXPECT_THROW(UsageHistory(shippedLife(), path), InputError) << row;
  }
  write("10,-62.83185307179586,5,20\n10,0,0,20\n");
  EXPECT_NEAR(DutyCycle::fromFile(path).turnsPerHour(), 5.0 * 3600.0, 1e-6);
}
}  // namespace
}  // namespace hjt
