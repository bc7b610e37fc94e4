// SPDX-License-Identifier: BSD-3-Clause

#include <array>
#include <numeric>

#include "test/core/signal_monitor_support.hpp"
#include "test/core/twin_runs.hpp"

namespace hjt
{
namespace
{
/// A window that differs from its reference by noise, and by a signature where one is given.
class AgainstSignatures : public testing::Test
{
protected:
  const std::shared_ptr<const SignatureSet> signatures_ = shippedSignatures();

  AgainstSignatures()
  {
    // A hundredth of the largest change in any signature; the drive has no load estimate and no set points.
    for (const Signature& signature : signatures_->signatures)
    {
      for (std::size_t i = 0; i < SIGNATURE_SIZE; ++i)
      {
        spread_[i] = isOfRobot(i) ? 0.0 : std::max(spread_[i], 0.01 * std::abs(signature.change[i]));
      }
    }
  }

  WindowResidual windowOf(const std::array<double, SIGNATURE_SIZE>& change)
  {
    WindowResidual window;
    window.freedom = 40.0;
    const auto put = [&](std::size_t indicator, double value, double spread)
    {
      window.difference[indicator] = value + spread * random_.normal();
      window.own[indicator] = spread * spread;
    };
    for (std::size_t i = 0; i < SCALAR_COUNT; ++i)
    {
      put(i, change[i], spread_[i]);
      // Changes by the signature are then in its own unit.
      window.sound[i] = isStiffness(static_cast<ScalarIndicator>(i)) ? std::sqrt(signatures_->sound[i]) : 1.0;
    }
    for (const LineSignal signal : ALL_LINE_SIGNALS)
    {
      for (std::size_t line = 0; line < LINE_COUNT && hasLine(signal, line); ++line)
      {
        const std::size_t number = signatureNumber(signal, line);
        if (isPhaseLocked(line))
        {
          const double phase = TWO_PI * random_.uniform(0.0, 1.0);
          put(cosineIndex(signal, line), change[number] * std::cos(phase), spread_[number]);
          put(sineIndex(signal, line), change[number] * std::sin(phase), spread_[number]);
        }
        put(amplitudeIndex(signal, line), change[number], spread_[number]);
      }
    }
    return window;
  }

  static OperatingPoint pointOf(const MotionKind& motion)
  {
    OperatingPoint point;
    point.speed = motion.speed;
    point.direction = -motion.direction;
    return point;
  }

  CausePosterior posterior(const std::array<double, SIGNATURE_SIZE>& change, const MotionKind& motion)
  {
    const WindowResidual window = windowOf(change);
    const OperatingPoint point = pointOf(motion);
    const std::uint64_t before = allocationCount();
    search_.start();
    search_.advance(window, point, search_.signatures());
    const CausePosterior found = search_.posterior();
    EXPECT_EQ(allocationCount(), before);
    return found;
  }

  static double sum(const CausePosterior& posterior)
  {
    return std::accumulate(posterior.probability.begin(), posterior.probability.end(), 0.0);
  }

  /// Of its changes, in spreads: in some motions a fault changes next to nothing.
  double strength(const Signature& signature) const
  {
    return std::inner_product(
        signature.change.begin(), signature.change.end(), spread_.begin(), 0.0,
        [](double sum, double part) { return std::hypot(sum, part); },
        [](double change, double spread) { return spread > 0.0 ? change / spread : 0.0; });
  }

  CauseSearch search_{ signatures_ };
  std::array<double, SIGNATURE_SIZE> spread_{};
  SeededRandom random_{ 5 };
};

TEST_F(AgainstSignatures, EveryCauseIsAmongTheMostLikelyOfItsOwnSignature)
{
  for (const Signature& signature : signatures_->signatures)
  {
    if (signature.severity < 0.4 || strength(signature) < 10.0)
    {
      continue;
    }
    const CausePosterior found = posterior(signature.change, signature.motion);
    EXPECT_NEAR(sum(found), 1.0, 1e-9);
    const auto own = static_cast<std::size_t>(signature.cause);
    int before = 0;
    for (const double probability : found.probability)
    {
      before += probability > found.probability[own] ? 1 : 0;
    }
    // Single teeth, and the two cracks of the cup, change the same.
    EXPECT_LE(before, 3) << causeName(signature.cause) << " at " << signature.severity;
    // Of a line reasoned by kinematics alone, too few numbers speak for the severity.
    const auto numbers =
        std::count_if(signature.change.begin(), signature.change.end(), [](double change) { return change != 0.0; });
    if (before == 0 && numbers > 2)
    {
      // One step of the table, or what the error of the signatures makes.
      constexpr double STEP = 1.7;
      const double deviation = 3.0 * found.severity_deviation[own];
      EXPECT_GT(found.severity[own], std::min(signature.severity / STEP, signature.severity - deviation))
          << causeName(signature.cause);
      EXPECT_LT(found.severity[own], std::max(signature.severity * STEP, signature.severity + deviation))
          << causeName(signature.cause);
    }
  }
}

TEST_F(AgainstSignatures, OfAMotionLikeTheWindowsCountMore)
{
  double alike = 0.0;
  double other = 0.0;
  for (const Signature& signature : signatures_->signatures)
  {
    if (signature.motion.speed > 0.0 && strength(signature) > 10.0)
    {
      const auto own = static_cast<std::size_t>(signature.cause);
      const MotionKind far{ 3.0 * signature.motion.speed, 1.0 - signature.motion.direction };
      alike += posterior(signature.change, signature.motion).probability[own];
      other += posterior(signature.change, far).probability[own];
    }
  }
  EXPECT_GT(alike, other);
}

TEST_F(AgainstSignatures, OfCausesThatLookAlikeTheMoreFrequentIsTheMoreLikely)
{
  constexpr std::array CAUSES{ causeOf(FaultKind::PITTING), causeOf(FaultKind::BUCKLING),
                               Cause::CIRCULAR_SPLINE_TOOTH };
  auto set = std::make_shared<SignatureSet>(*signatures_);
  set->signatures.assign(CAUSES.size(), signatures_->signatures.front());
  for (std::size_t i = 0; i < CAUSES.size(); ++i)
  {
    set->signatures[i].cause = CAUSES[i];
  }
  set->occurrence = {};
  set->occurrence[static_cast<std::size_t>(CAUSES[0])] = 9.0;
  set->occurrence[static_cast<std::size_t>(CAUSES[1])] = 1.0;
  CauseSearch search(set);
  const Signature& signature = set->signatures.front();
  search.advance(windowOf(signature.change), pointOf(signature.motion), search.signatures());
  const std::array<double, CAUSE_COUNT> found = search.posterior().probability;
  const double unrated = found[static_cast<std::size_t>(CAUSES[2])];
  EXPECT_NEAR(found[static_cast<std::size_t>(CAUSES[0])] / unrated, 0.5 * (1.0 + 9.0 / 5.0), 1e-9);
  EXPECT_NEAR(found[static_cast<std::size_t>(CAUSES[1])] / unrated, 0.5 * (1.0 + 1.0 / 5.0), 1e-9);
}

TEST_F(AgainstSignatures, WhatTheBestOneLeavesTakesFromConfidenceAndSeverity)
{
  double less_sure = 0.0;
  double wider = 0.0;  // as a share of the severity
  int count = 0;
  for (const Signature& signature : signatures_->signatures)
  {
    if (signature.severity != 0.4 || strength(signature) < 30.0)
    {
      continue;
    }
    const auto own = static_cast<std::size_t>(signature.cause);
    std::array<double, SIGNATURE_SIZE> change = signature.change;
    const CausePosterior exact = posterior(change, signature.motion);
    for (std::size_t i = 0; i < SCALAR_COUNT; ++i)
    {
      change[i] += (i % 2 == 0 ? 5.0 : -5.0) * spread_[i];
    }
    const CausePosterior off = posterior(change, signature.motion);
    less_sure += exact.probability[own] - off.probability[own];
    wider += off.severity_deviation[own] / off.severity[own] - exact.severity_deviation[own] / exact.severity[own];
    ++count;
  }
  ASSERT_GT(count, 10);
  EXPECT_GT(less_sure, 0.0);
  EXPECT_GT(wider, 0.0);
}

TEST_F(AgainstSignatures, WhatMovesEverythingAtRandomIsNoneOfThem)
{
  std::array<double, SIGNATURE_SIZE> change{};
  for (std::size_t i = 0; i < SIGNATURE_SIZE; ++i)
  {
    change[i] = (i % 2 == 0 ? 20.0 : -20.0) * spread_[i];
  }
  const CausePosterior found = posterior(change, ANY_MOTION);
  EXPECT_GT(found.probability[static_cast<std::size_t>(Cause::NONE)], 0.9);
}

/// The twin held at 150 rad/s under a load that swings; its indicators of the second window of 30 turns.
SignalIndicators twinIndicators(std::vector<std::string> edits)
{
  edits.insert(edits.end(), { "indicators.window_turns=30.0", "output.load_inertia=0.5" });
  Twin twin(shippedParameters(edits));
  twin.watchSignals(true);
  double held_back = 0.0;  // integral part of the speed control [N.m]
  const double step = 1e-9 * static_cast<double>(twin.stepLength());
  while (twin.signalIndicators().windows < 2)
  {
    const double missing = 150.0 - twin.outputs().motor_velocity;
    held_back += 0.2 * missing * step;
    stepUnder(twin, 0.02 * missing + held_back,
              12.0 * std::sin(TWO_PI * 3.0 * 1e-9 * static_cast<double>(twin.stamp())));
  }
  return twin.signalIndicators();
}

TEST_F(AgainstSignatures, SmallChangesThatBelongTogetherAreAPattern)
{
  const CausePatterns patterns(signatures_);
  constexpr int WINDOWS = 200;
  int found = 0;
  int large = 0;
  const auto known = std::find_if(signatures_->signatures.begin(), signatures_->signatures.end(),
                                  [](const Signature& signature)
                                  {
                                    return signature.cause == causeOf(FaultKind::INTERFACE_WEAR) &&
                                           signature.severity == 0.4 && signature.motion.speed > 0.0;
                                  });
  ASSERT_NE(known, signatures_->signatures.end());
  // Six spreads long, none of its changes beyond five: with a chance of 1e-3 none stands out by itself.
  std::array<double, SIGNATURE_SIZE> small = known->change;
  double largest = 0.0;
  double length = 0.0;
  for (std::size_t i = 0; i < SCALAR_COUNT; ++i)
  {
    const double change = spread_[i] > 0.0 ? std::abs(small[i]) / spread_[i] : 0.0;
    largest = std::max(largest, change);
    length = std::hypot(length, change);
  }
  ASSERT_LT(6.0 * largest / length, 5.0);
  for (double& change : small)
  {
    change *= 6.0 / length;
  }
  for (int i = 0; i < WINDOWS; ++i)
  {
    const std::uint64_t before = allocationCount();
    const PatternScore faulty = patterns.strongest(windowOf(small), pointOf(known->motion));
    const PatternScore sound = patterns.strongest(windowOf({}), pointOf(known->motion));
    EXPECT_EQ(allocationCount(), before);
    found += faulty.student > 4.0 ? 1 : 0;
    large += sound.student > 4.0 ? 1 : 0;  // 3e-5 of each of seventeen kinds, by noise
  }
  EXPECT_GT(found, 8 * WINDOWS / 10);
  EXPECT_LE(large, 1);
}

/// Torque at every speed alike; peaks and lines that scatter more.
TEST_F(AgainstSignatures, DragOfABrakeAndNoiseAreNoFaultOfAGear)
{
  constexpr MotionKind CHECK_UP{ 82.7, 0.02 };
  constexpr double DRAG = 0.03;
  constexpr double NOISE = 0.5;
  std::array<double, SIGNATURE_SIZE> change{};
  change[indexOf(ScalarIndicator::RUNNING_TORQUE)] = change[indexOf(ScalarIndicator::COULOMB_TORQUE)] = DRAG;
  std::array<WindowResidual, 2> windows{ windowOf(change), windowOf({}) };
  for (double& difference : windows[1].difference)
  {
    difference *= 1.0 + NOISE;
  }
  for (WindowResidual& window : windows)
  {
    for (const ScalarIndicator own : { ScalarIndicator::RUNNING_TORQUE, ScalarIndicator::KINEMATIC_ERROR })
    {
      window.sound[indexOf(own)] = signatures_->sound[indexOf(own)];
    }
  }
  constexpr std::size_t PEAKS = indexOf(ScalarIndicator::KINEMATIC_ERROR);
  windows[1].difference[PEAKS] = NOISE * signatures_->sound[PEAKS];
  for (const WindowResidual& window : windows)
  {
    search_.start();
    search_.advance(window, pointOf(CHECK_UP), search_.signatures());
    EXPECT_GT(search_.posterior().probability[static_cast<std::size_t>(Cause::NONE)], 0.6);
  }
}

TEST(TwinsIndicators, FollowPhysicalEdits)
{
  const SignalIndicators healthy = twinIndicators({});
  const double stiffness = healthy[ScalarIndicator::TORSIONAL_STIFFNESS];
  EXPECT_GT(stiffness, 20e3);
  EXPECT_LT(stiffness, 50e3);
  // The load swings by less than 1 mrad of torsion, the output turns by 62 mrad in a motor turn, 30 of them.
  EXPECT_NEAR(healthy[ScalarIndicator::RATIO_DEVIATION], 0.0, 5e-4);

  const SignalIndicators soft_cup = twinIndicators({ "cup.torsion_stiffness=[26.0e+3, 45.4e+3, 52.3e+3]" });
  EXPECT_LT(soft_cup[ScalarIndicator::TORSIONAL_STIFFNESS], 0.95 * stiffness);

  const SignalIndicators thick_grease = twinIndicators({ "motor.viscous_friction=1.066e-3" });
  EXPECT_NEAR(thick_grease[ScalarIndicator::RUNNING_TORQUE] - healthy[ScalarIndicator::RUNNING_TORQUE], 0.15, 0.03);

  const SignalIndicators worn_teeth = twinIndicators({ "mesh.flank_clearance=5.0e-6" });
  EXPECT_GT(worn_teeth[ScalarIndicator::LOST_MOTION], healthy[ScalarIndicator::LOST_MOTION]);
}

TEST(OperatingBin, StepsWithTheGearsTorqueAndTakesAnyNumber)
{
  const Parameters parameters = shippedParameters();
  const Parameters wrist = shippedParameters({}, { "size_14" });
  OperatingPoint point;
  point.speed = 100.0;
  const auto bin_at = [&](const Parameters& gear, double share)
  {
    point.load = share * gear.life.rated_torque;
    return binOf(point, loadStep(gear)).load;
  };
  for (const double share : { -1.3, 0.1, 0.5, 2.0 })
  {
    EXPECT_EQ(bin_at(parameters, share), bin_at(wrist, share)) << share;
  }
  EXPECT_LT(loadStep(wrist), 0.2 * loadStep(parameters));
  for (const double huge : { 6.7e305, -6.7e305, HUGE_VAL, std::nan("") })
  {
    point.load = point.temperature = point.speed = huge;
    const OperatingBin bin = binOf(point, loadStep(parameters));
    EXPECT_LE(std::abs(bin.load), 1'000'000) << huge;
    EXPECT_LE(std::abs(bin.temperature), 1'000'000) << huge;
    EXPECT_LE(std::abs(bin.speed), 1100) << huge;
  }
}

/// The teeth most, the interface as much, the grease less: no one signature is like it.
TEST_F(AgainstSignatures, WearThatComesTogetherIsNoOtherFault)
{
  const auto is = [](const Signature& signature, FaultKind kind, double severity)
  { return signature.cause == causeOf(kind) && signature.severity == severity; };
  const auto probability_of = [](const CausePosterior& posterior, FaultKind kind)
  { return posterior.probability[static_cast<std::size_t>(causeOf(kind))]; };
  int windows = 0;
  for (const Signature& teeth : signatures_->signatures)
  {
    std::array<double, SIGNATURE_SIZE> change = teeth.change;
    int parts = 0;
    for (const Signature& other : signatures_->signatures)
    {
      const bool is_alike =
          other.motion.speed == teeth.motion.speed && other.motion.direction == teeth.motion.direction;
      if (is_alike && (is(other, FaultKind::INTERFACE_WEAR, 0.4) || is(other, FaultKind::LUBRICANT_DEGRADATION, 0.16)))
      {
        std::transform(change.begin(), change.end(), other.change.begin(), change.begin(), std::plus<>());
        ++parts;
      }
    }
    if (!is(teeth, FaultKind::TOOTH_WEAR, 0.4) || parts < 2)
    {
      continue;
    }
    ++windows;
    const CausePosterior found = posterior(change, teeth.motion);
    EXPECT_GT(probability_of(found, FaultKind::TOOTH_WEAR) + probability_of(found, FaultKind::INTERFACE_WEAR) +
                  probability_of(found, FaultKind::LUBRICANT_DEGRADATION),
              0.9)
        << teeth.motion.speed;
  }
  EXPECT_GE(windows, 8);
}
}  // namespace
}  // namespace hjt
