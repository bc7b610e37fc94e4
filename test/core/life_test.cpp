// SPDX-License-Identifier: BSD-3-Clause

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "test/core/life_support.hpp"

namespace hjt
{
namespace
{
TEST(AgeingLaws, BearingMeetsTheCatalogueAtBothLives)
{
  const LifeParameters life = shippedLife();
  const BearingLife bearing(life);
  const double turns_per_hour = life.rated_speed * 3600.0 / TWO_PI;
  EXPECT_NEAR(bearing.failedBy(life.bearing_l10 * turns_per_hour), 0.1, 1e-12);
  EXPECT_NEAR(bearing.failedBy(life.bearing_l50 * turns_per_hour), 0.5, 1e-12);
  EXPECT_NEAR(bearing.failedBy(bearing.quantile(0.37)), 0.37, 1e-12);
  EXPECT_NEAR(bearingWear(life, -2.0 * life.rated_torque), 8.0, 1e-12);
}

TEST(AgeingLaws, GreaseLastsAsLongAsTheCatalogueSaysAndHalfAsLongWarmer)
{
  const LifeParameters life = shippedLife();
  EXPECT_DOUBLE_EQ(greaseAgeing(life, life.grease_temperature) * life.grease_turns, 1.0);
  EXPECT_DOUBLE_EQ(greaseAgeing(life, life.grease_temperature + life.grease_halving) * life.grease_turns, 2.0);
  EXPECT_EQ(greaseWearFactor(life, 0.0), 1.0);
  EXPECT_EQ(greaseWearFactor(life, 1.0), life.grease_wear_factor);
}

TEST(AgeingLaws, CrackGrowsOnlyAboveItsThresholdAndAsParisSays)
{
  const Parameters parameters = shippedParameters();
  const LifeParameters& life = parameters.life;
  const double depth = 100e-6;
  RevolutionLoad load;
  load.bending_range = 1.0;
  load.bending_range = 1e6 * life.crack_threshold / stressIntensityRange(parameters, load, depth);
  RevolutionLoad less = load;
  less.bending_range *= 0.999;
  EXPECT_EQ(crackGrowth(parameters, less, depth), 0.0);
  load.bending_range *= 2.0;
  const double growth = crackGrowth(parameters, load, depth);
  EXPECT_NEAR(growth, 2.0 * life.crack_coefficient * std::pow(2.0 * life.crack_threshold, life.crack_exponent),
              1e-12 * growth);
  EXPECT_EQ(crackGrowth(parameters, load, 0.0), 0.0);
}

TEST(AgeingLaws, StressIntensityIsThatOfAStripWhoseShapeIsPrescribed)
{
  Parameters parameters = shippedParameters();
  parameters.stress.concentration[0] = 1.0;
  const double thickness = parameters.gear.rim_thickness;
  RevolutionLoad bending;
  bending.bending_range = 100e6;
  RevolutionLoad tension;
  tension.tension_range = 100e6;
  const auto factor = [&](const RevolutionLoad& load, double share)
  { return stressIntensityRange(parameters, load, share * thickness) / (100e6 * std::sqrt(PI * share * thickness)); };
  // Short cracks: the edge crack's 1.122. Deep ones: Tada's factors of the strip, 1.12 and 1.66 at 0.3, 2.83 at a half.
  EXPECT_NEAR(factor(bending, 1e-4), 1.122, 1e-3);
  EXPECT_NEAR(factor(tension, 1e-4), 1.122, 1e-3);
  EXPECT_NEAR(factor(tension, 0.3), 1.66, 0.01);
  EXPECT_NEAR(factor(tension, 0.5), 2.83, 0.01);
  // By hand: S(0.3) = 0.460 relieves the section to 1 / (1 + 2 x 0.91 x 0.8/0.403 x 0.460).
  EXPECT_NEAR(factor(bending, 0.3), 1.12 / (1.0 + 2.0 * 0.91 * 0.8 / 0.403 * 0.460), 0.01);
  double last = 2.0;
  for (const double share : { 1e-3, 0.05, 0.2, 0.4, 0.6 })
  {
    EXPECT_LT(factor(bending, share), last);
    last = factor(bending, share);
  }
  // The notch raises that of a short crack alone.
  parameters.stress.concentration[0] = 2.0;
  EXPECT_NEAR(factor(bending, 1e-4), 2.0 * 1.122, 5e-3);
  EXPECT_NEAR(factor(tension, 0.3), 1.66, 0.01);
}

TEST(RevolutionLoad, GrowsWithTheLoadAndIsThatOfTheLosses)
{
  const Parameters parameters = shippedParameters();
  RevolutionLoadAnalysis analysis(parameters, POSITIONS);
  const RevolutionLoad idle = analysis.under(0.0);
  const RevolutionLoad rated = analysis.under(67.0);
  const RevolutionLoad peak = analysis.under(157.0);
  EXPECT_LT(idle.flank_sliding, rated.flank_sliding);
  EXPECT_LT(rated.flank_sliding, peak.flank_sliding);
  EXPECT_GT(rated.interface_sliding, 0.0);
  for (std::size_t place = 0; place < STRESS_PLACES; ++place)
  {
    EXPECT_LT(idle.stress[place].largest(), rated.stress[place].largest()) << STRESS_PLACE_NAMES[place];
    EXPECT_LT(rated.stress[place].largest(), peak.stress[place].largest()) << STRESS_PLACE_NAMES[place];
  }
  EXPECT_GT(idle.bending_range, 30.0 * idle.tension_range);
  EXPECT_LT(peak.bending_range, 4.0 * peak.tension_range);
}

TEST(RevolutionLoad, OfBothDirectionsOfLoadIsAlike)
{
  RevolutionLoadAnalysis analysis(shippedParameters(), POSITIONS);
  const RevolutionLoad forth = analysis.under(67.0);
  const RevolutionLoad back = analysis.under(-67.0);
  EXPECT_NEAR(forth.flank_sliding, back.flank_sliding, 0.05 * forth.flank_sliding);
  EXPECT_NEAR(forth.interface_sliding, back.interface_sliding, 0.05 * forth.interface_sliding);
}

TEST(RaceCreep, FollowsTheBendingAtTheLobesAndIsHeldBackByTheStretchedRim)
{
  RevolutionLoadAnalysis analysis(shippedParameters(), POSITIONS);
  const double idle = analysis.under(0.0).race_creep;
  const Parameters parameters = shippedParameters();
  // The whole lever times the rate of tilt of an ellipse at its lobes, 3 w0/r: more than the mean over the contact.
  const double at_lobes = TWO_PI * parameters.contact.slip_lever * 3.0 * parameters.gear.wave_amplitude /
                          parameters.gear.flexspline_inner_radius;
  EXPECT_GT(idle, 0.0);
  EXPECT_LT(idle, at_lobes);
  const double rated = analysis.under(67.0).race_creep;
  EXPECT_LT(rated, idle);
  EXPECT_LT(analysis.under(150.0).race_creep, rated);
}

TEST(RaceCreep, OfALooseRaceLagsByTheDifferenceOfCircumferences)
{
  const auto creep_of_worn = [](double depth)
  {
    Parameters parameters = shippedParameters();
    parameters.faults.push_back({ FaultKind::INTERFACE_WEAR, depth / parameters.fault_scale.interface_wear_depth });
    return RevolutionLoadAnalysis(parameters, POSITIONS).under(67.0).race_creep;
  };
  const double lag = creep_of_worn(4e-6) - creep_of_worn(6e-6);
  EXPECT_GT(lag, TWO_PI * 2e-6);
  EXPECT_LT(lag, 2.0 * TWO_PI * 2e-6);  // the loaded rim touches nearer to the lobes
}

TEST(RaceCreep, WithoutLeverIsThatOfTheStretchAlone)
{
  Parameters parameters = shippedParameters();
  parameters.contact.slip_lever = 0.0;
  const double creep = RevolutionLoadAnalysis(parameters, POSITIONS).under(0.0).race_creep;
  const double strain = parameters.contact.fit / parameters.gear.flexspline_inner_radius -
                        creep / (TWO_PI * parameters.gear.flexspline_inner_radius);
  EXPECT_GT(strain, 1e-5);  // the wave generator stretches the rim
  EXPECT_LT(strain, 2e-3);
}

TEST(RevolutionLoadMap, IsTheToothModelAtItsStagesAndNearItBetween)
{
  const RatedUse& use = ratedUse();
  const RevolutionLoad fresh = RevolutionLoadAnalysis(use.parameters, POSITIONS).under(use.duty.phases[0].load_torque);
  EXPECT_DOUBLE_EQ(use.load_map.at(use.duty.phases[0].load_torque, 0.0, 0.0).flank_sliding, fresh.flank_sliding);
  EXPECT_LT(use.load_map.largestError(), 0.05);
}

TEST(DriveAgeing, NominalWearIsTheClosedFormAsLongAsWearChangesLittle)
{
  const RatedUse& use = ratedUse();
  for (const bool changes : { false, true })
  {
    const NominalUse closed(use.ageing, use.parameters.life, changes);
    UnitVariation tough = nominalDrive(use.parameters.life);
    tough.flank_factor = 1e-6;  // no wear to feed back
    tough.interface_factor = 1e-6;
    tough.bearing_life = 1e30;
    const double hours = 2.6 * use.parameters.life.grease_turns / use.duty.turnsPerHour();
    const DriveAgeing::Life life = use.ageing.live(tough, hours, hours, changes, {});
    EXPECT_FALSE(life.end);
    const Usage usage = closed.until(hours);
    EXPECT_NEAR(1e6 * life.age.worstFlank(), usage.flank_wear, 1e-3 * usage.flank_wear);
    EXPECT_NEAR(life.age.bearing_turns, usage.bearing_turns, 1e-6 * usage.bearing_turns);
  }
}

TEST(DriveAgeing, LimitsEndALifeAndTheEndIsFoundExactly)
{
  const RatedUse& use = ratedUse();
  const UnitVariation nominal = nominalDrive(use.parameters.life);
  double last = -1.0;
  const DriveAgeing::Life life = use.ageing.live(nominal, 1e6, 500.0, true,
                                                 [&](double hours, const DriveAge&)
                                                 {
                                                   EXPECT_GT(hours, last);
                                                   last = hours;
                                                 });
  ASSERT_TRUE(life.end);
  EXPECT_EQ(last, life.hours);
  const double largest = std::max({ life.age.worstFlank() / use.parameters.life.flank_wear_limit,
                                    life.age.interface_wear / use.parameters.life.interface_wear_limit,
                                    std::sqrt(spallSize(nominal, life.age.bearing_turns)) });
  EXPECT_NEAR(largest, 1.0, 1e-6);

  UnitVariation soft = nominal;
  soft.flank_factor = 50.0;
  const DriveAgeing::Life shorter = use.ageing.live(soft, 1e6, 1e6, true, {});
  EXPECT_EQ(shorter.end, EndOfLife::FLANK_WEAR);
  EXPECT_LT(shorter.hours, life.hours);
}

TEST(DriveAgeing, WearsTheFlanksThatTheLoadPresses)
{
  const Parameters parameters = shippedParameters();
  const auto lived = [&](const std::vector<double>& loads)
  {
    DutyCycle duty;
    for (const double load : loads)
    {
      duty.phases.push_back({ 10.0 / static_cast<double>(loads.size()), 200.0, load, 40.0 });
    }
    RevolutionLoadMap load_map(parameters, 2);
    load_map.cover(duty, {});
    const DriveAgeing ageing(parameters, duty, load_map);
    UnitVariation tough = nominalDrive(parameters.life);
    tough.flank_factor = 1e-3;  // no wear to feed back
    return ageing.live(tough, 100.0, 100.0, true, {}).age;
  };
  const DriveAge forth = lived({ 67.0 });
  const DriveAge back = lived({ -67.0 });
  const DriveAge both = lived({ 67.0, -67.0 });
  EXPECT_EQ(forth.flank_wear[1], 0.0);
  EXPECT_EQ(back.flank_wear[0], 0.0);
  EXPECT_DOUBLE_EQ(back.worstFlank(), forth.worstFlank());
  // Half of the turns each: a side lasts twice as long, the play grows as fast.
  EXPECT_NEAR(both.worstFlank() / forth.worstFlank(), 0.5, 1e-6);
  EXPECT_NEAR(both.meanFlank() / forth.meanFlank(), 1.0, 1e-6);
}

/// Lives of the nominal drive under some phases of its rated speed.
struct Lived
{
  Lived(const Parameters& given, const std::vector<std::pair<double, double>>& torque_and_share)
    : parameters(given), load_map(given, POSITIONS)
  {
    for (const auto& [torque, share] : torque_and_share)
    {
      duty.phases.push_back({ 10.0 * share, given.life.rated_speed, torque, given.life.grease_temperature });
    }
    load_map.cover(duty, {});
    life = DriveAgeing(parameters, duty, load_map).live(nominalDrive(parameters.life), 1e6, 1e6, true, {});
  }

  Parameters parameters;
  DutyCycle duty;
  RevolutionLoadMap load_map;
  DriveAgeing::Life life;
};

// The catalogue: for ever up to the repeated peak torque, 1e4 deflections under momentary peaks.
TEST(Fatigue, SparesTheFlexsplineUpToTheRepeatedPeakAndTiresItByOverloads)
{
  const Parameters parameters = goldenParameters();
  const LifeParameters& life = parameters.life;
  Parameters shipped = shippedParameters();
  shipped.life.flank_wear_coefficient = 0.0;  // the bearing or the flexspline
  EXPECT_EQ(Lived(shipped, { { life.rated_torque, 1.0 } }).life.end, EndOfLife::BEARING);
  EXPECT_EQ(Lived(shipped, { { life.repeated_peak_torque, 1.0 } }).life.end, EndOfLife::BEARING);
  const DriveAgeing::Life peak = Lived(parameters, { { life.momentary_peak_torque, 1.0 } }).life;
  EXPECT_EQ(peak.end, EndOfLife::TOOTH_SPACE_FATIGUE);
  EXPECT_GT(2.0 * peak.age.turns, life.momentary_peak_cycles);
  EXPECT_LT(2.0 * peak.age.turns, 10.0 * life.momentary_peak_cycles);
  // A thousandth of the time: the overloads alone would take a thousand times as long; they take the rest along.
  const DriveAgeing::Life seldom =
      Lived(parameters, { { life.rated_torque, 0.999 }, { life.momentary_peak_torque, 0.001 } }).life;
  EXPECT_EQ(seldom.end, EndOfLife::TOOTH_SPACE_FATIGUE);
  EXPECT_LT(seldom.age.turns, 1001.0 * peak.age.turns);
  EXPECT_GT(seldom.age.turns, 500.0 * peak.age.turns);
}

TEST(Fatigue, OfTheWeakIsKnownToTheForecast)
{
  Parameters parameters = goldenParameters();
  const Lived peak(parameters, { { parameters.life.momentary_peak_torque, 1.0 } });
  const DriveAgeing ageing(peak.parameters, peak.duty, peak.load_map);
  const NominalUse use(ageing, parameters.life, true);
  const RemainingHours remaining =
      RemainingLife(parameters).remaining({}, use.from(0.0, 10.0 * peak.life.hours, 400), nullptr, {});
  EXPECT_GT(remaining.by_cause[3] + remaining.by_cause[4], 0.99);
  // Drives of that spread.
  constexpr int DRIVES = 300;
  const BearingLife bearing(parameters.life);
  boost::random::mt19937 random(9);
  std::vector<double> hours;
  for (int i = 0; i < DRIVES; ++i)
  {
    UnitVariation drive = nominalDrive(parameters.life);
    const UnitVariation drawn = drawVariation(parameters.life, bearing, random);
    drive.strength = drawn.strength;
    drive.transition = drawn.transition;
    hours.push_back(ageing.live(drive, 1e6, 1e6, true, {}).hours);
  }
  std::sort(hours.begin(), hours.end());
  const auto below = [&](double time)
  { return static_cast<double>(std::lower_bound(hours.begin(), hours.end(), time) - hours.begin()) / DRIVES; };
  // Four standard errors of the share of so many drives.
  EXPECT_NEAR(below(remaining.quantile[1]), 0.1, 4.0 * std::sqrt(0.1 * 0.9 / DRIVES));
  EXPECT_NEAR(below(remaining.quantile[2]), 0.5, 4.0 * std::sqrt(0.5 * 0.5 / DRIVES));
  EXPECT_NEAR(below(remaining.quantile[3]), 0.9, 4.0 * std::sqrt(0.1 * 0.9 / DRIVES));
}

TEST(Fatigue, ACrackThatIsThereStopsWhereOnlyTheShapeLoadsIt)
{
  Parameters parameters = shippedParameters();
  EXPECT_EQ(parameters.life.flaw_depth, 0.0) << "a sound drive has none";
  parameters.life.flaw_depth = 100e-6;
  const Lived idle(parameters, { { 0.0, 1.0 } });
  EXPECT_NE(idle.life.end, EndOfLife::ROOT_CRACK);
  EXPECT_LT(idle.life.age.flaw_depth, 0.6 * parameters.gear.rim_thickness);
  EXPECT_EQ(Lived(parameters, { { parameters.life.rated_torque, 1.0 } }).life.end, EndOfLife::ROOT_CRACK);
}

TEST(AgeingLaws, GreaseAgesWithTheCubeOfTheTorqueAboveTheRatedOne)
{
  const Parameters parameters = shippedParameters();
  const auto rate = [&](double torque)
  {
    const Lived lived(parameters, { { torque, 1.0 } });
    return DriveAgeing(parameters, lived.duty, lived.load_map).rates(nominalDrive(parameters.life), {}).grease;
  };
  const double rated = rate(parameters.life.rated_torque);
  EXPECT_NEAR(rate(0.5 * parameters.life.rated_torque), rated, 1e-9 * rated);
  EXPECT_NEAR(rate(1.5 * parameters.life.rated_torque), 3.375 * rated, 1e-6 * rated);
}

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
