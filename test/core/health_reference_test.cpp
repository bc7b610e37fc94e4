// SPDX-License-Identifier: BSD-3-Clause

#include "health/reference_fit.hpp"
#include "test/core/signal_monitor_support.hpp"
#include "test/support/seeded_random.hpp"

namespace hjt
{
namespace
{
/// A drive that repeats as the twin does.
Parameters stillDrive()
{
  return shippedParameters({ "indicators.least_spread=0.0005" });
}

/// Score of a window whose running torque lies `off` beside what it falls by with the temperature, learned from windows
/// spread by `range` about 25 degC.
double scoreAt(double temperature, double off, double range)
{
  Assessor assessor(stillDrive());
  SeededRandom random(3);
  const auto assess = [&](double at, double beside)
  {
    const double torque = 0.15 - 0.002 * (at - 25.0) + 1e-4 * random.normal() + beside;
    assessor.update(torqueWindow({ 100.0, 1.0, 30.0, at }, torque));
  };
  for (int window = 0; window < LEARNING; ++window)
  {
    assess(25.0 + random.uniform(-range, range), 0.0);
  }
  assess(temperature, off);
  return assessor.assessment().largest_score;
}

/// And one of a single temperature calls nothing a fault at another.
TEST(Reference, FollowsTheTemperatureWithinAClass)
{
  EXPECT_LT(scoreAt(28.0, 0.0, 4.0), 1.0);
  EXPECT_GT(scoreAt(28.0, 0.002, 4.0), 1.0) << "a third of what the temperature makes";
  EXPECT_LT(scoreAt(28.0, 0.0, 0.05), 1.0);
  EXPECT_GT(scoreAt(25.0, 0.002, 0.05), 1.0);
}

TEST(Reference, ServesAWindowAtTheEdgeOfAClassThatHasNone)
{
  Assessor assessor(shippedParameters());
  SeededRandom random(3);
  const auto state_at = [&](double speed, double temperature) {
    return assessor.update(torqueWindow({ speed, 1.0, 30.0, temperature }, 0.15 + 1e-4 * random.normal())).state;
  };
  for (int window = 0; window < LEARNING; ++window)
  {
    state_at(100.0, 25.0);
  }
  const double edge = 128.0;  // of the octave
  EXPECT_EQ(state_at(std::exp2(0.2) * edge, 25.0), AssessmentState::TOO_FEW_WINDOWS);
  EXPECT_EQ(state_at(100.0, 32.0), AssessmentState::TOO_FEW_WINDOWS);
  EXPECT_EQ(state_at(std::exp2(0.3) * edge, 25.0), AssessmentState::LEARNING);
  EXPECT_EQ(state_at(100.0, 33.0), AssessmentState::LEARNING);
}

/// Running torques that rise with the payload, with 1e-4 N.m of noise; every sixth window may lack them.
class WithPayloads : public testing::Test
{
protected:
  static constexpr double RISE = 2e-4;  // [1]

  double scoreAt(double temperature, double payload, double off)
  {
    SignalIndicators window;
    window.windows = ++windows_;
    window.point = { 100.0, 1.0, 30.0, temperature, 0.0, payload, 0.0, 4.0 };
    if (!lacking_ || windows_ % 6 != 3)
    {
      window.values[indexOf(ScalarIndicator::RUNNING_TORQUE)] = 0.15 + RISE * payload + 1e-4 * random_.normal() + off;
    }
    return assess(window).largest_score;
  }

  const Assessment& assess(const SignalIndicators& window) { return assessor_.update(window); }

  AssessmentState state() const { return assessor_.assessment().state; }

  void learn(double temperature, double range)
  {
    for (int window = 0; window < LEARNING; ++window)
    {
      scoreAt(temperature, random_.uniform(-range, range), 0.0);
    }
  }

  bool lacking_{};

private:
  Assessor assessor_{ stillDrive() };
  std::uint64_t windows_{};
  SeededRandom random_{ 3 };
};

TEST_F(WithPayloads, ThoseLearnedAtOneTemperatureServeAtAnother)
{
  learn(25.0, 10.0);
  learn(35.0, 0.5);
  EXPECT_LT(scoreAt(35.0, 10.0, 0.0), 1.0);
  EXPECT_GT(scoreAt(35.0, 10.0, 15.0 * RISE), 1.0);
}

TEST_F(WithPayloads, ThoseNeverLearnedAreNotJudged)
{
  learn(35.0, 0.5);
  EXPECT_LT(scoreAt(35.0, 0.5, 0.0), 1.0);
  EXPECT_EQ(state(), AssessmentState::TOO_FEW_WINDOWS);
  EXPECT_LT(scoreAt(35.0, 10.0, 15.0 * RISE), 1.0);
  EXPECT_EQ(state(), AssessmentState::OTHER_PAYLOAD);
  Assessment said;
  said.state = state();
  EXPECT_THAT(whyNotJudged(said), testing::StartsWith("the reference has no windows with this payload, load or gain"));
  scoreAt(35.0, 0.0, 15.0 * RISE);
  EXPECT_EQ(state(), AssessmentState::TOO_FEW_WINDOWS) << "the next one with a known payload is judged";
}

/// Running torques of check-ups at one payload, with the spread of the twin's, and of a real drive's.
TEST(Repeatability, ADriveThatRepeatsAsARealOneDoesNotAlarm)
{
  constexpr double SOUND = 0.105;  // of the shipped drive in a UR5's shoulder [N.m]
  const auto alarms = [](const Parameters& parameters)
  {
    int beyond = 0;
    for (unsigned drive = 0; drive < 20; ++drive)
    {
      Assessor assessor(parameters);
      SeededRandom random(drive);
      for (int i = 0; i < 60; ++i)
      {
        const double spread = i < LEARNING ? 1e-3 * SOUND : std::hypot(0.03 * SOUND, 0.22 / RATIO);
        const SignalIndicators window =
            torqueWindow({ 60.0, 0.0, 30.0, 25.0, 0.0, 53.4, 0.0, 4.0 }, SOUND + spread * random.normal());
        beyond += assessor.update(window).largest_score > 1.0 ? 1 : 0;
      }
    }
    return beyond;
  };
  const std::string once = "indicators.evidence_windows=1";
  const std::string rate = "indicators.false_alarm_rate=1e-3";
  EXPECT_EQ(alarms(shippedParameters({ once, rate })), 0) << "of 400";
  EXPECT_GT(alarms(shippedParameters({ once, rate, "indicators.least_spread=0.0005" })), 200);
}

TEST_F(WithPayloads, CountForAnIndicatorThatSomeWindowsLack)
{
  lacking_ = true;
  learn(25.0, 10.0);
  EXPECT_LT(scoreAt(25.0, 9.0, 0.0), 1.0);
  EXPECT_GT(scoreAt(25.0, 9.0, 15.0 * RISE), 1.0) << "less than from one payload to another";
}

/// Variance of the mean of ten sound windows, over that of one, of a reference of `runs` stretches of ten windows whose
/// values share `shared` of their spread.
double varianceOfTen(double shared, int runs)
{
  Parameters parameters = shippedParameters({ "indicators.least_spread=0.0" });
  parameters.indicators.baseline_windows = 10 * runs;
  const auto own = [&](int evidence_windows)
  {
    SeededRandom random(5);
    parameters.indicators.evidence_windows = evidence_windows;
    Assessor assessor(parameters);
    for (int run = 0; run <= runs; ++run)
    {
      const double stays = std::sqrt(shared) * random.normal();
      for (int i = 1; i <= 10; ++i)
      {
        const double torque = 0.15 + 1e-3 * (stays + std::sqrt(1.0 - shared) * random.normal());
        SignalIndicators window = torqueWindow({ 100.0, 1.0, 30.0, 25.0 }, torque);
        window.windows = static_cast<std::uint64_t>(i);
        assessor.update(window);
      }
    }
    return assessor.baseline().residual().own[indexOf(ScalarIndicator::RUNNING_TORQUE)];
  };
  return own(10) / own(1);
}

TEST(Reference, OfIndependentWindowsMakesTheMeanOfTenNearlyTenTimesAsSure)
{
  EXPECT_NEAR(varianceOfTen(0.0, 60), 1.0 / 8.0, 0.12);
  EXPECT_NEAR(varianceOfTen(0.8, 60), 0.8, 0.15) << "of windows alike within a run";
}

/// Spread of a line in a window of the standard error `error`, where that of the healthy ones is `usual`; another line
/// has 1e-4 in the healthy ones and `other` in that window.
double spreadWith(double error, double usual, double other = 1e-4)
{
  constexpr std::size_t LINE = cosineIndex(LineSignal::MOTOR_RIPPLE, FIRST_LOADED);
  Assessor assessor(shippedParameters({ "indicators.least_spread=0.0", "indicators.evidence_windows=1" }));
  SeededRandom random(5);
  SignalIndicators window;
  window.point = { 100.0, 0.0, 30.0, 25.0 };
  for (int i = 0; i <= LEARNING; ++i)
  {
    window.values[LINE] = 1e-3 * random.normal();
    window.uncertainty[LINE] = i < LEARNING ? usual : error;
    window.uncertainty[amplitudeIndex(LineSignal::MOTOR_RIPPLE, 0)] = i < LEARNING ? 1e-4 : other;
    assessor.update(window);
  }
  return std::sqrt(assessor.baseline().residual().own[LINE]);
}

TEST(Reference, OfALineIsAsUncertainAsTheWindowsMotionMakesIt)
{
  const double usual = spreadWith(1e-4, 1e-4);
  EXPECT_NEAR(usual, 1e-3, 3e-4);
  EXPECT_NEAR(spreadWith(3e-4, 1e-4), 3.0 * usual, 1e-6) << "the spread grows with the error, small as that is";
  EXPECT_NEAR(spreadWith(1e-5, 1e-4), usual, 1e-6) << "a better fit makes no finer judgement";
  EXPECT_NEAR(spreadWith(3e-4, 1e-4, 3e-4), usual, 1e-6) << "noise of all lines is no reason to see less";
}

/// Spread of the first of `lines` parts of the ripple in proportion to the load in a reference of eight windows, in
/// which that one scatters by 1e-4 and the others by 1e-3, with like errors by the fit.
double spreadBeside(int lines)
{
  constexpr std::size_t LINE = cosineIndex(LineSignal::MOTOR_RIPPLE, FIRST_LOADED);
  Assessor assessor(shippedParameters(
      { "indicators.least_spread=0.0", "indicators.evidence_windows=1", "indicators.baseline_windows=8" }));
  SignalIndicators window;
  window.point = { 100.0, 0.0, 30.0, 25.0 };
  window.uncertainty[amplitudeIndex(LineSignal::MOTOR_RIPPLE, 0)] = 1e-4;
  for (int i = 0; i <= 8; ++i)
  {
    for (std::size_t line = LINE; line < LINE + static_cast<std::size_t>(lines); ++line)
    {
      window.values[line] = (i % 2 == 0 ? -1.0 : 1.0) * (line == LINE ? 1e-4 : 1e-3);
      window.uncertainty[line] = 1e-4;
    }
    assessor.update(window);
  }
  return std::sqrt(assessor.baseline().residual().own[LINE]);
}

TEST(Reference, OfFewWindowsTakesALineForNoMuchCalmerThanLinesLikeIt)
{
  const double alone = spreadBeside(1);
  const double beside = spreadBeside(12);
  const double freedom = 7.0;
  const double chance = std::log(1e-6 / 1e-8) * 11.0 / 12.0 + 1.0 / freedom + 1.0 / (3.0 * freedom * freedom);
  EXPECT_NEAR(beside / alone, std::sqrt((freedom + ALIKE_FREEDOM * std::exp(chance)) / (freedom + ALIKE_FREEDOM)), 0.01)
      << "three degrees of freedom of the geometric mean of all twelve";
  EXPECT_NEAR(spreadBeside(3), alone, 1e-12) << "three lines say nothing of a fourth";
}

TEST(Reference, KeepsTheSoundValueWhereAModelIsSubtracted)
{
  Assessor assessor(shippedParameters());
  SignalIndicators model;
  model.values[indexOf(ScalarIndicator::TORSIONAL_STIFFNESS)] = 25000.0;
  for (int window = 0; window <= LEARNING; ++window)
  {
    SignalIndicators measured = model;
    measured.point = { 100.0, 1.0, 30.0, 25.0 };
    measured.values[indexOf(ScalarIndicator::TORSIONAL_STIFFNESS)] = window < LEARNING ? 24000.0 : 21600.0;
    assessor.update(difference(measured, model), &model);
  }
  const WindowResidual& residual = assessor.baseline().residual();
  EXPECT_DOUBLE_EQ(residual.sound[indexOf(ScalarIndicator::TORSIONAL_STIFFNESS)], 24000.0);
  EXPECT_DOUBLE_EQ(residual.difference[indexOf(ScalarIndicator::TORSIONAL_STIFFNESS)], -2400.0);
}

/// A reference of a motion to and fro that is carried to one of twice the speed and three times the load.
class CarriedReference : public testing::Test
{
protected:
  CarriedReference()
  {
    for (int window = 0; window < LEARNING; ++window)
    {
      update(learned_, { 80.0, 0.0, 20.0, 25.0 + random_.normal() }, random_.normal());
    }
    carried_.setReference(learned_.baseline().bins(), true);
  }

  const Assessment& update(Assessor& assessor, const OperatingPoint& point, double stiffness_error)
  {
    SignalIndicators model;
    model.values[STIFFNESS] = model_stiffness_;
    model.values[TORQUE] = 0.1 + 0.001 * point.load;
    SignalIndicators measured = model;
    measured.point = point;
    measured.values[STIFFNESS] = 30000.0 + stiffness_error;
    measured.values[TORQUE] += 1e-4 * random_.normal();
    return assessor.update(difference(measured, model), &model);
  }

  const Assessment& tenWindows(Assessor& assessor, const OperatingPoint& point, double stiffness_error)
  {
    for (int window = 0; window < 10; ++window)
    {
      update(assessor, point, stiffness_error + random_.normal());
    }
    return assessor.assessment();
  }

  static constexpr std::size_t STIFFNESS = indexOf(ScalarIndicator::TORSIONAL_STIFFNESS);
  static constexpr std::size_t TORQUE = indexOf(ScalarIndicator::RUNNING_TORQUE);
  static constexpr OperatingPoint OTHER{ 160.0, 0.0, 60.0, 25.0 };

  const CarriedError error_of_others_ = shippedSignatures()->carried[STIFFNESS];
  const double carried_error_ = std::hypot(error_of_others_.deviation, error_of_others_.share * 1000.0);
  double model_stiffness_{ 29000.0 };  // the drive's is 30000
  SeededRandom random_{ 7 };
  Assessor learned_{ stillDrive() };
  Assessor carried_{ stillDrive() };
};

TEST_F(CarriedReference, JudgesAMotionThatHasNone)
{
  EXPECT_EQ(tenWindows(carried_, OTHER, 0.0).state, AssessmentState::ASSESSED);
  EXPECT_EQ(carried_.assessment().level, HealthLevel::OK);
  EXPECT_NEAR(carried_.baseline().residual().sound[STIFFNESS], 30000.0, 1.0);
  EXPECT_NEAR(carried_.baseline().residual().difference[TORQUE], 0.0, 1e-4);
  Assessor own(shippedParameters());
  own.setReference(learned_.baseline().bins());
  EXPECT_EQ(tenWindows(own, OTHER, 0.0).state, AssessmentState::NO_REFERENCE);
}

TEST_F(CarriedReference, IsOffByWhatOtherGearsWere)
{
  EXPECT_EQ(tenWindows(carried_, OTHER, 3.0 * carried_error_).level, HealthLevel::OK);
  EXPECT_EQ(tenWindows(carried_, OTHER, -40.0 * carried_error_).level, HealthLevel::ERROR);
  EXPECT_EQ(carried_.assessment().evidence[0].indicator, STIFFNESS);
}

TEST_F(CarriedReference, IsOfTheSameTemperatureAndOfMotionsToAndFro)
{
  EXPECT_EQ(tenWindows(carried_, { 160.0, 0.0, 60.0, 45.0 }, 0.0).state, AssessmentState::NO_REFERENCE);
  EXPECT_EQ(tenWindows(carried_, { 160.0, 1.0, 60.0, 25.0 }, 0.0).state, AssessmentState::NO_REFERENCE);
}

TEST_F(CarriedReference, LeavesOutOfTheCauseWhatTheModelDidNotDetermine)
{
  tenWindows(carried_, OTHER, -40.0 * carried_error_);
  model_stiffness_ = std::numeric_limits<double>::quiet_NaN();
  const Assessment& assessment = update(carried_, OTHER, 0.0);
  EXPECT_GT(assessment.largest_score, 1.0);
  EXPECT_EQ(carried_.baseline().residual().own[STIFFNESS], 0.0);
  EXPECT_TRUE(std::isfinite(assessment.confidence));
}
}  // namespace
}  // namespace hjt
