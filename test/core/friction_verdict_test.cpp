// SPDX-License-Identifier: BSD-3-Clause
// Friction of a measured joint as a factor with an interval: what is judged, and why what is not is not.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <utility>

#include <gmock/gmock.h>

#include "test/core/test_parameters.hpp"
#include "test/support/seeded_random.hpp"
#include "tracking/common_friction.hpp"
#include "tracking/verdict.hpp"

namespace hjt
{
namespace
{
using testing::Contains;
using testing::Field;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

constexpr double PERIOD = 0.008;  // [s]
constexpr double NOT_GIVEN = std::numeric_limits<double>::quiet_NaN();

using Motion = std::function<MotionSample(double)>;

/// An elbow that swings under a weight.
MotionSample swing(double time)
{
  MotionSample sample;
  sample.position = 0.7 * std::sin(0.9 * time) + 0.2 * std::sin(2.3 * time);
  sample.velocity = 0.63 * std::cos(0.9 * time) + 0.46 * std::cos(2.3 * time);
  sample.load = 20.0 * std::sin(sample.position + 0.4);
  return sample;
}

/// To and fro between -0.5 and 0.5 rad at one speed [rad/s].
Motion between(double speed)
{
  return [speed](double time)
  {
    const double way = std::fmod(speed * time, 2.0);
    MotionSample sample;
    sample.position = way < 1.0 ? way - 0.5 : 1.5 - way;
    sample.velocity = way < 1.0 ? speed : -speed;
    return sample;
  };
}

/// A joint whose friction is a multiple of its twin's.
class WornJoint
{
public:
  WornJoint()
    : parameters_(shippedParameters({ "motor.viscous_friction=0.0", "solver.rate=2000" }))
    , twin_(parameters_)
    , torsion_(parameters_)
    , evidence_(parameters_, LoadOrigin::CONFIGURED)
  {
  }

  const Parameters& parameters() const { return parameters_; }
  double gain() const { return parameters_.telemetry.torque_per_current; }

  /// What its rows show. `factor`: of the friction, by time. `more`: current [A].
  const JointEvidence& evidence(const Motion& motion, double seconds, const std::function<double(double)>& factor,
                                double more = 0.0)
  {
    SeededRandom engine(5);
    evidence_.reset();
    torsion_.reset();
    for (int i = 0; i * PERIOD < seconds; ++i)
    {
      MotionSample sample = motion(i * PERIOD);
      sample.time = i * PERIOD;
      sample.after_gap = i == 0;
      const MotionPrediction predicted = twin_.step(sample);
      const double worn = (factor(sample.time) - 1.0) * predicted.friction_torque / gain();
      sample.current = predicted.current + worn + more + 0.05 * engine.normal();
      sample.target_current = predicted.current + (expected_ - 1.0) * predicted.friction_torque / gain();
      sample.motor_angle = evidence_.ratio() * (sample.position + compliance_ * torsion_.to(sample.load) + 1.0);
      evidence_.update(sample);
    }
    return evidence_;
  }

  const JointEvidence& evidence(const Motion& motion, double seconds, double factor, double more = 0.0)
  {
    return evidence(
        motion, seconds, [factor](double) { return factor; }, more);
  }

  Finding judged(double factor, const JointContext& context)
  {
    verdict_ = Verdict();
    return judgeFriction(evidence(swing, 60.0, factor), context, verdict_);
  }

  /// From now on a motor encoder shows this multiple of the twin's torsion; NaN: the motor has none.
  void twist(double compliance) { compliance_ = compliance; }

  /// From now on the controller expects this multiple of the twin's friction; NaN: what it expects is not recorded.
  void expect(double factor) { expected_ = factor; }

  const Verdict& verdict() const { return verdict_; }  ///< that holds what was judged last

private:
  Parameters parameters_;
  double expected_{ NOT_GIVEN };
  double compliance_{ NOT_GIVEN };
  Verdict verdict_;
  MotionDriven twin_;
  TorsionCourse torsion_;
  JointEvidence evidence_;
};

class FrictionVerdict : public testing::Test
{
protected:
  FrictionVerdict() : joint_(shared()) {}

  /// What it shows when its friction is the twin's.
  SoundFriction sound(double factor = 1.0, const Motion& motion = swing)
  {
    const JointEvidence& evidence = joint_.evidence(motion, 60.0, factor);
    return { evidence.friction().points(), frictionFactor(evidence, {}).scatter };
  }

  /// Other joints of the arm are as in the reference.
  static JointContext witnessed(const OwnReference& own)
  {
    JointContext context;
    context.own = own;
    context.arm_deviation = 0.0;
    return context;
  }

  Reason gap(const Motion& motion, double seconds, double factor, const JointContext& context = {}, double more = 0.0)
  {
    return gapOf(joint_.evidence(motion, seconds, factor, more), context);
  }

  /// That of evidence, which is never a fault.
  Reason gapOf(const JointEvidence& evidence, const JointContext& context)
  {
    const FrictionFactor factor = frictionFactor(evidence, context);
    Verdict verdict;
    const Finding finding = judgeFriction(evidence, context, verdict);
    EXPECT_EQ(finding.reason, factor.reason);
    EXPECT_EQ(finding.level == VerdictLevel::NOT_JUDGED, factor.reason != Reason::SOUND);
    if (!factor.isJudged())
    {
      EXPECT_THAT(finding.causes, IsEmpty());
      EXPECT_EQ(verdict.friction_text, factor.why_not);
      EXPECT_THAT(verdict.friction_text, Not(IsEmpty()));
      EXPECT_FALSE(verdict.friction.has_interval);
    }
    return factor.reason;
  }

  WornJoint& joint_;

private:
  /// Its tables take seconds.
  static WornJoint& shared()
  {
    static WornJoint joint;
    return joint;
  }
};

TEST_F(FrictionVerdict, WarnsWhereTheIntervalClearsTheBound)
{
  const JointContext context = witnessed(ownReference({ sound() }));
  const auto level = [&](double factor) { return joint_.judged(factor, context).level; };
  EXPECT_EQ(level(1.0), VerdictLevel::OK);
  EXPECT_EQ(level(1.10), VerdictLevel::OK);
  EXPECT_EQ(level(0.90), VerdictLevel::OK);
  const Finding more = joint_.judged(1.30, context);
  EXPECT_EQ(more.level, VerdictLevel::WARN);
  EXPECT_EQ(more.reason, Reason::FRICTION);
  EXPECT_THAT(joint_.verdict().friction_text, HasSubstr("times this joint's own when it was sound"));
  EXPECT_THAT(more.causes, Contains(Field(&WeightedCause::cause, causeOf(FaultKind::LUBRICANT_DEGRADATION))));
  const JudgedFriction& friction = joint_.verdict().friction;
  EXPECT_NEAR(friction.factor, 1.30, 0.01);
  EXPECT_TRUE(friction.has_interval);
  EXPECT_GT(friction.lower, 1.05);
  EXPECT_GT(friction.upper, friction.factor);
  EXPECT_EQ(level(0.70), VerdictLevel::WARN);
  EXPECT_EQ(level(3.0), VerdictLevel::ERROR);
}

TEST_F(FrictionVerdict, WithoutAReferenceDrivesOfOneKindDiffer)
{
  EXPECT_EQ(joint_.judged(1.30, {}).level, VerdictLevel::OK);
  EXPECT_EQ(joint_.judged(0.75, {}).level, VerdictLevel::OK);
  EXPECT_EQ(joint_.judged(1.70, {}).level, VerdictLevel::WARN);
  JointContext context;
  context.is_identified = true;
  EXPECT_EQ(joint_.judged(1.30, context).level, VerdictLevel::WARN) << "the twin's friction is this joint's own";
}

TEST_F(FrictionVerdict, WhatTheControllerExpectsIsAReferenceWhereMostJointsAgreeWithIt)
{
  // Drives of one kind differ by more than what is to be found: half again as much friction as the twin's is sound.
  const auto evidence = [&](double factor, double expected)
  {
    joint_.expect(expected);
    return JointEvidence(joint_.evidence(swing, 60.0, factor));
  };
  const JointEvidence sound = evidence(1.5, 1.5);
  const JointEvidence worn = evidence(1.5 * 1.3, 1.5);
  const JointEvidence unlike = evidence(1.5, 0.7);
  const JointEvidence unknown = evidence(1.5, NOT_GIVEN);
  joint_.expect(NOT_GIVEN);
  EXPECT_TRUE(controllerIsReference({ &sound, &worn, &sound, &sound }));
  EXPECT_FALSE(controllerIsReference({ &sound, &unlike, &unlike, &sound, &sound, &unlike }));
  EXPECT_FALSE(controllerIsReference({ &unknown, &unknown, &unknown, &unknown }));
  EXPECT_FALSE(controllerIsReference({ &sound, &sound })) << "two joints are no witnesses";

  JointContext context = witnessed({});
  context.has_controller = true;
  const auto judged = [&](const JointEvidence& rows, Verdict& verdict)
  { return judgeFriction(rows, context, verdict).level; };
  Verdict verdict;
  EXPECT_EQ(judged(sound, verdict), VerdictLevel::OK);
  EXPECT_EQ(judged(worn, verdict), VerdictLevel::WARN);
  EXPECT_NEAR(verdict.friction.factor, 1.3, 0.01);
  EXPECT_NEAR(verdict[Figure::FRICTION_OF_CONTROLLER], 1.3, 0.01);
  EXPECT_THAT(verdict.friction_text, HasSubstr("times the friction that the arm's controller expects"));
  EXPECT_EQ(judged(unknown, verdict), VerdictLevel::NOT_JUDGED);
  context.own = ownReference({ this->sound() });
  EXPECT_EQ(frictionFactor(worn, context).reference, FrictionReference::OWN);
}

TEST_F(FrictionVerdict, TheIntervalHoldsWhatIsUncertain)
{
  const OwnReference own = ownReference({ sound() });
  const JointEvidence& evidence = joint_.evidence(swing, 60.0, 1.2);
  const FrictionFactor witnessed_factor = frictionFactor(evidence, witnessed(own));
  EXPECT_NEAR(witnessed_factor.value, 1.2, 0.01);
  EXPECT_NEAR(witnessed_factor.low() * witnessed_factor.high(), std::pow(witnessed_factor.value, 2), 1e-9);
  EXPECT_GT(witnessed_factor.deviation, 0.025) << "by which sound drives repeat";
  JointContext alone;
  alone.own = own;
  const FrictionFactor unwitnessed = frictionFactor(evidence, alone);
  EXPECT_GT(std::pow(unwitnessed.deviation, 2) - std::pow(witnessed_factor.deviation, 2), std::pow(UNWITNESSED, 2));
  EXPECT_GT(witnessed_factor.low(), 1.0 + MORE_THAN_OWN) << "a fifth more is found";
  EXPECT_LT(unwitnessed.low(), 1.0 + MORE_THAN_OWN) << "but not without witnesses";

  // Rows that differ from each other more: friction that comes and goes.
  const auto uneven = [](double time) { return std::fmod(time, 20.0) < 10.0 ? 1.0 : 1.4; };
  const FrictionFactor scattered = frictionFactor(joint_.evidence(swing, 60.0, uneven), witnessed(own));
  EXPECT_NEAR(scattered.value, 1.2, 0.05);
  EXPECT_GT(scattered.scatter, 5.0 * witnessed_factor.scatter);
  EXPECT_GT(scattered.deviation, witnessed_factor.deviation);
}

TEST_F(FrictionVerdict, ALoadThatBothWaysDoNotShareIsUncertain)
{
  // Down with the weight, up without: what is off of the load does not go out.
  const auto sorted = [](double time)
  {
    MotionSample sample = swing(time);
    sample.load = sample.velocity > 0.0 ? 30.0 : -30.0;
    return sample;
  };
  const auto alike = [](double time)
  {
    MotionSample sample = swing(time);
    sample.load = 30.0;
    return sample;
  };
  const double with = frictionFactor(joint_.evidence(sorted, 60.0, 1.0), {}).deviation;
  const double without = frictionFactor(joint_.evidence(alike, 60.0, 1.0), {}).deviation;
  EXPECT_GT(with, 1.3 * without);
}

TEST_F(FrictionVerdict, TorsionIsJudgedBesideTheTwinOrBesideTheDrivesOwn)
{
  Verdict verdict;
  const auto torsion = [&](double compliance, double own, const Motion& motion = swing)
  {
    JointContext context;
    context.own.compliance_ratio = own;
    joint_.twist(compliance);
    verdict = judge(joint_.evidence(motion, 60.0, 1.0), context);
    joint_.twist(NOT_GIVEN);
    return *std::find_if(verdict.findings.begin(), verdict.findings.end(),
                         [](const Finding& finding) { return finding.subject == FindingSubject::TORSION; });
  };
  const ComparisonParameters& comparison = joint_.parameters().comparison;
  const double error = joint_.parameters().indicators.error_factor;
  for (const auto& [own, tolerance] :
       { std::pair{ NOT_GIVEN, comparison.compliance_tolerance }, std::pair{ 1.3, comparison.repeat_tolerance } })
  {
    const double sound = std::isnan(own) ? 1.0 : own;
    for (const auto& [deviation, level] :
         { std::pair{ 0.0, VerdictLevel::OK }, std::pair{ 0.9 * tolerance, VerdictLevel::OK },
           std::pair{ -0.9 * tolerance, VerdictLevel::OK }, std::pair{ 1.1 * tolerance, VerdictLevel::WARN },
           std::pair{ -1.1 * tolerance, VerdictLevel::WARN },
           std::pair{ 1.1 * error * tolerance, VerdictLevel::ERROR } })
    {
      SCOPED_TRACE(testing::Message() << "torsion " << deviation << " beside " << sound);
      const Finding finding = torsion(sound * (1.0 + deviation), own);
      EXPECT_EQ(finding.level, level);
      EXPECT_EQ(finding.reason, level == VerdictLevel::OK ? Reason::SOUND : Reason::TORSION);
      EXPECT_NEAR(verdict[Figure::TORSION_OF_TWIN], sound * (1.0 + deviation), 1e-5);
      EXPECT_NEAR(verdict[Figure::TORSION_TOLERANCE], tolerance, 1e-12);
    }
  }
  EXPECT_EQ(torsion(NOT_GIVEN, NOT_GIVEN).reason, Reason::NO_MOTOR_ANGLE);
  EXPECT_EQ(torsion(1.0, NOT_GIVEN, between(0.5)).reason, Reason::LOAD_CONSTANT);
  for (const double no_drive : { -0.1, 20.5 })
  {
    EXPECT_EQ(torsion(no_drive, NOT_GIVEN).reason, Reason::TORSION_NO_DRIVE);
    EXPECT_EQ(torsion(no_drive, NOT_GIVEN).level, VerdictLevel::NOT_JUDGED);
  }
}

TEST(OwnReference, IsAsUncertainAsTheMeanOfItsRecordings)
{
  EXPECT_DOUBLE_EQ(ownReference({ { {}, 0.03 }, { {}, 0.04 } }).friction_deviation, 0.025);
}

TEST_F(FrictionVerdict, ReferencesThatDifferWidenTheInterval)
{
  const OwnReference agreeing = ownReference({ sound(0.99), sound(1.0), sound(1.01) });
  const OwnReference differing = ownReference({ sound(0.8), sound(1.0), sound(1.2) });
  EXPECT_EQ(agreeing.recordings, 3U);
  EXPECT_NEAR(agreeing.recordings_deviation, 0.01, 0.002);
  EXPECT_NEAR(differing.recordings_deviation, 0.2, 0.02);
  EXPECT_EQ(joint_.judged(1.25, witnessed(agreeing)).level, VerdictLevel::WARN);
  EXPECT_EQ(joint_.judged(1.25, witnessed(differing)).level, VerdictLevel::OK);
  // Three that agree tell more than one.
  const JointEvidence& evidence = joint_.evidence(swing, 60.0, 1.25);
  EXPECT_LT(frictionFactor(evidence, witnessed(agreeing)).deviation,
            frictionFactor(evidence, witnessed(ownReference({ sound() }))).deviation);
}

TEST_F(FrictionVerdict, MotionThatShowsNoFrictionIsNotJudged)
{
  const auto still = [](double) { return MotionSample(); };
  const auto forward = [](double time)
  {
    MotionSample sample = swing(time);
    sample.velocity = 0.4 + 0.2 * std::cos(2.3 * time);
    sample.position = 0.4 * time + 0.2 / 2.3 * std::sin(2.3 * time) - 10.0;
    return sample;
  };
  EXPECT_EQ(gap(still, 60.0, 1.0), Reason::AT_REST);
  EXPECT_EQ(gap(swing, 0.2, 1.0), Reason::NO_STEADY_MOTION);
  EXPECT_EQ(gap(forward, 60.0, 2.0), Reason::ONE_DIRECTION);
  EXPECT_EQ(gap(between(0.5), 60.0, 2.0), Reason::ONE_SPEED);
  EXPECT_EQ(gap(swing, 3.9, 2.0), Reason::TOO_SHORT);
  EXPECT_THAT(frictionFactor(joint_.evidence(swing, 3.9, 2.0), {}).why_not, HasSubstr("for less than 6 s"));
  EXPECT_EQ(gap(swing, 60.0, 1.0), Reason::SOUND);
  const auto hidden = [&](const Motion& motion) { return judge(joint_.evidence(motion, 60.0, 1.0), {}).cannot_show; };
  EXPECT_THAT(hidden(forward), Contains(HasSubstr("in one direction only")));
  EXPECT_THAT(hidden(swing), Not(Contains(HasSubstr("in one direction only"))));
  EXPECT_THAT(hidden(still), Not(Contains(HasSubstr("in one direction only")))) << "it shows no friction at all";
}

TEST_F(FrictionVerdict, SpeedsThatTheReferenceLacksAreNotJudged)
{
  const JointContext slow = witnessed(ownReference({ sound(1.0, between(0.02)) }));
  EXPECT_EQ(gap(between(1.5), 60.0, 2.0, slow), Reason::NO_REFERENCE);
  EXPECT_EQ(gap(swing, 60.0, 1.0, witnessed(ownReference({ sound() }))), Reason::SOUND);
}

TEST_F(FrictionVerdict, WhatNoFaultMakesIsNoFault)
{
  EXPECT_EQ(gap(swing, 60.0, 0.0), Reason::NO_FRICTION);
  EXPECT_EQ(gap(swing, 60.0, 0.3), Reason::LESS_THAN_FAULTS);
  EXPECT_EQ(gap(swing, 60.0, -1.0), Reason::EFFORT_NOT_CURRENT);
  const FrictionPoint point = joint_.evidence(swing, 60.0, 1.0).friction().points().back();
  EXPECT_EQ(gap(swing, 60.0, 1.0, {}, 1.5 * point.measured / joint_.gain()), Reason::LOAD_WRONG);
  const auto chance = [](double time) { return std::fmod(time, 20.0) < 10.0 ? 0.1 : 1.9; };
  EXPECT_EQ(gapOf(joint_.evidence(swing, 20.0, chance), {}), Reason::FRICTION_SCATTER);
}

TEST_F(FrictionVerdict, AReferenceBetweenItsSpeedsIsInterpolated)
{
  const auto points = [](std::vector<std::pair<double, double>> of)
  {
    std::vector<FrictionPoint> made;
    for (const auto& [speed, measured] : of)
    {
      made.push_back({ speed, measured, 0.0, 10.0, 100, 0.0 });
    }
    return made;
  };
  const auto common = FrictionPoints::common(points({ { 0.5, 12.0 } }), points({ { 0.45, 11.0 }, { 0.556, 13.0 } }));
  ASSERT_EQ(common.size(), 1U);
  EXPECT_NEAR(common[0].twin, 12.0, 0.05) << "half way between two that are as far";
  EXPECT_THAT(FrictionPoints::common(points({ { 0.5, 12.0 } }), points({ { 0.2, 11.0 }, { -0.5, 13.0 } })), IsEmpty());
}

/// What all joints' currents leave open either way counts only where the friction departs that way.
TEST_F(FrictionVerdict, IsNoneWhereTheCurrentsOfAllJointsDoubtIt)
{
  JointContext context;
  EXPECT_EQ(judge(joint_.evidence(swing, 60.0, 2.0), context).level, VerdictLevel::WARN);
  context.fitted.not_less = "it may be more";
  EXPECT_EQ(judge(joint_.evidence(swing, 60.0, 2.0), context).level, VerdictLevel::WARN);
  context.fitted.not_more = "it may be as expected";
  const Verdict verdict = judge(joint_.evidence(swing, 60.0, 2.0), context);
  EXPECT_EQ(verdict.level, VerdictLevel::NOT_JUDGED);
  EXPECT_EQ(verdict.reason, Reason::LOAD_WRONG);
  EXPECT_EQ(verdict.misfit, context.fitted.not_more);
  EXPECT_EQ(judge(joint_.evidence(swing, 60.0, 1.0), context).level, VerdictLevel::OK);
}

/// Within what drives of one type differ by, but not in the fit of all joints' currents.
TEST_F(FrictionVerdict, IsWarnWhereTheFitOfAllJointsShowsIt)
{
  const JointEvidence& evidence = joint_.evidence(swing, 60.0, 1.2);
  JointContext context;
  context.fitted = { 1.3, 1.14, 1.46 };
  EXPECT_EQ(judge(evidence, context).level, VerdictLevel::OK);
  context.fitted.lower = 1.16;
  const Verdict verdict = judge(evidence, context);
  EXPECT_EQ(verdict.level, VerdictLevel::WARN);
  EXPECT_EQ(verdict.friction.factor, 1.3);
  EXPECT_THAT(verdict.friction_text, HasSubstr("1.30 [1.16, 1.46] times the twin's in a fit of the currents of all"));
  EXPECT_THAT(verdict.friction_text, HasSubstr("0.85 to 1.15 counts as sound"));
  context.fitted = { 0.7, 0.6, 0.84 };
  EXPECT_EQ(judge(evidence, context).level, VerdictLevel::WARN);
  context.own.is_unjudged = true;
  EXPECT_EQ(judge(evidence, context).level, VerdictLevel::OK) << "the fit is of joints that have a reference";
  context.own = ownReference({ { evidence.friction().points(), 0.01 } });
  EXPECT_EQ(judge(evidence, context).level, VerdictLevel::OK) << "its own rows show it better";
  context.own = ownReference({ { evidence.friction().points(), 0.3 } });
  EXPECT_EQ(judge(evidence, context).level, VerdictLevel::WARN) << "they do not";
}

TEST_F(FrictionVerdict, IsThatOfTheFitOfAllJointsWhereTheJointsOwnRowsDoNotShowIt)
{
  JointContext context = witnessed(ownReference({ sound(1.0, between(0.02)) }));
  const JointEvidence& evidence = joint_.evidence(between(1.5), 60.0, 1.0);
  context.fitted = { 1.02, 0.94, 1.1, 0.12 };
  const Verdict sound = judge(evidence, context);
  EXPECT_EQ(sound.level, VerdictLevel::OK);
  EXPECT_EQ(sound.friction.lower, 0.94);
  EXPECT_TRUE(std::isnan(sound[Figure::FRICTION_OF_OWN]));
  EXPECT_THAT(sound.friction_text, HasSubstr("1.02 [0.94, 1.10] times this joint's own when it was sound in a fit"));
  context.fitted.of_rows = 0.4;
  EXPECT_EQ(judge(evidence, context).reason, Reason::NO_REFERENCE) << "that is what is expected, not what rows show";
  context.fitted = { 1.4, 1.25, 1.55, 0.15 };
  const Verdict worn = judge(evidence, context);
  EXPECT_EQ(worn.level, VerdictLevel::WARN);
  EXPECT_THAT(causesOf(worn), Not(IsEmpty()));
  context.own = OwnReference();
  context.fitted = { 1.02, 0.94, 1.1, 0.12 };
  EXPECT_EQ(judge(joint_.evidence(swing, 60.0, 0.0), context).level, VerdictLevel::NOT_JUDGED) << "no friction at all";
}

TEST_F(FrictionVerdict, AReferenceThatWasNotJudgedIsNone)
{
  JointContext context;
  context.own.is_unjudged = true;
  const Finding finding = joint_.judged(1.3, context);
  EXPECT_EQ(finding.level, VerdictLevel::OK);
  EXPECT_THAT(joint_.verdict().friction_text, HasSubstr("The reference did not judge this joint's friction"));
}

using testing::DoubleEq;
using testing::Each;
using testing::ElementsAre;
using testing::Lt;

std::vector<MeasuredFriction> jointsWith(const std::vector<double>& ratios)
{
  std::vector<MeasuredFriction> joints;
  for (const double ratio : ratios)
  {
    joints.push_back({ ratio, 25.0, true, [](double temperature) { return 1.25 - 0.01 * temperature; }, false, false });
  }
  return joints;
}

TEST(CommonFriction, WhatAGroupSharesIsNoJointsFault)
{
  const ArmFriction arm = commonFriction(jointsWith({ 1.02, 0.98, 1.0, 1.25, 1.2, 1.22 }), 0.15);
  EXPECT_EQ(arm.median, 1.0);
  ASSERT_EQ(arm.groups.size(), 2U);
  EXPECT_DOUBLE_EQ(arm.groups[0].median, 1.0);
  EXPECT_DOUBLE_EQ(arm.groups[1].median, 1.22);
  EXPECT_THAT(arm.factors, ElementsAre(1.0, 1.0, 1.0, DoubleEq(1.17), DoubleEq(1.17), DoubleEq(1.17)))
      << "5 % may be chance";
  EXPECT_THAT(arm.deviations, Each(0.0)) << "each joint has its group as witness";
  EXPECT_THAT(arm.misfit.clause, IsEmpty());
}

/// The same, each held against its own when it was sound.
std::vector<MeasuredFriction> ownJointsWith(const std::vector<double>& ratios)
{
  std::vector<MeasuredFriction> joints = jointsWith(ratios);
  for (MeasuredFriction& joint : joints)
  {
    joint.temperature_received = false;
    joint.is_to_own = true;
  }
  return joints;
}

TEST(CommonFriction, OfJointsBesideTheirOwnAGroupSharesAllOfIt)
{
  const ArmFriction arm = commonFriction(ownJointsWith({ 1.04, 1.06, 1.09, 1.18, 1.12, 1.13 }), 0.15);
  EXPECT_THAT(arm.factors, ElementsAre(DoubleEq(1.04), DoubleEq(1.06), DoubleEq(1.06), DoubleEq(1.13), DoubleEq(1.12),
                                       DoubleEq(1.13)))
      << "and no joint has too little because the others have more";
  EXPECT_THAT(arm.deviations, Each(0.0));
  const ArmFriction warm = commonFriction(ownJointsWith({ 0.9, 0.92, 1.0, 1.0, 1.0, 1.0 }), 0.15);
  EXPECT_THAT(warm.factors, ElementsAre(0.92, 0.92, 0.92, 1.0, 1.0, 1.0));
  EXPECT_THAT(warm.deviations, Each(Lt(NO_WITNESS))) << "sound joints differ by as much";
  const ArmFriction scattered = commonFriction(ownJointsWith({ 1.0, 1.0, 1.0, 0.67, 0.77, 0.94 }), 0.15);
  EXPECT_DOUBLE_EQ(scattered.factors[5], 0.77);
  EXPECT_GT(scattered.deviations[5], NO_WITNESS) << "two that differ so much say little of the third";
  std::vector<MeasuredFriction> mixed = ownJointsWith({ 1.0, 1.0, 1.0, 1.0, 1.0, 1.0 });
  mixed[0].is_to_own = false;
  EXPECT_THAT(commonFriction(mixed, 0.15).deviations, ElementsAre(0.0, 0.05, 0.05, 0.0, 0.0, 0.0))
      << "a joint held against its type witnesses less of two held against their own";
}

TEST(CommonFriction, OneJointThatRubsIsNoTemperature)
{
  for (std::size_t i = 0; i < 6; ++i)
  {
    std::vector<double> ratios{ 1.05, 1.02, 1.0, 1.09, 1.0, 1.06 };
    ratios[i] *= 1.25;
    const ArmFriction arm = commonFriction(ownJointsWith(ratios), 0.15);
    EXPECT_FALSE(arm.temperature.has_value()) << i;
    EXPECT_GT(ratios[i] / arm.factors[i], 1.14) << i;
    for (std::size_t other = 0; other < 6; ++other)
    {
      EXPECT_TRUE(other == i || std::abs(ratios[other] / arm.factors[other] - 1.0) < 0.08) << i << ' ' << other;
    }
  }
}

TEST(CommonFriction, CurrentsAgainstTheMotionAreOfTheOppositeSign)
{
  std::vector<MeasuredFriction> joints = jointsWith({ 1.0, 1.0, 1.0, 1.0, 1.0, 1.0 });
  for (std::size_t i : { 0, 2 })
  {
    joints[i].is_below_faults = joints[i].is_none = joints[i].is_against = true;
    EXPECT_EQ(commonFriction(joints, 0.15).misfit.reason, i == 0 ? Reason::SOUND : Reason::EFFORT_NOT_CURRENT);
  }
}

TEST(CommonFriction, OneFaultyJointMovesNoGroup)
{
  const ArmFriction arm = commonFriction(jointsWith({ 1.0, 1.6, 1.0, 1.0, 1.0, 1.0 }), 0.15);
  EXPECT_THAT(arm.factors, Each(1.0));
  const ArmFriction apart = commonFriction(jointsWith({ 1.0, 1.6, 2.4, 1.0, 1.0, 1.0 }), 0.15);
  EXPECT_FALSE(apart.groups[0].is_known) << "no two agree";
  EXPECT_EQ(apart.deviations[1], UNWITNESSED);
  EXPECT_EQ(apart.factors[1], 1.0);
}

TEST(CommonFriction, SeveralJointsWithoutFrictionAreNoArmByItself)
{
  std::vector<MeasuredFriction> joints = jointsWith({ 1.0, 1.0, 1.0, 1.0, 1.0, 1.0 });
  joints[0].is_below_faults = true;
  EXPECT_THAT(commonFriction(joints, 0.15).misfit.clause, IsEmpty()) << "one alone may have another gain";
  joints[2].is_below_faults = true;
  EXPECT_EQ(commonFriction(joints, 0.15).misfit.reason, Reason::LESS_THAN_FAULTS);
  EXPECT_THAT(commonFriction(joints, 0.15).misfit.clause, HasSubstr("moves the arm by hand"));
  joints[0].is_none = joints[2].is_none = true;
  EXPECT_EQ(commonFriction(joints, 0.15).misfit.reason, Reason::NO_FRICTION);
  EXPECT_THAT(commonFriction(joints, 0.15).misfit.clause, HasSubstr("modelled or commanded torque"));
}

TEST(CommonFriction, TooLittleBesideFarTooMuchIsAnotherOrder)
{
  std::vector<MeasuredFriction> joints = jointsWith({ 1.0, 1.0, 1.0, 1.0, 1.0, 1.9 });
  joints[0].ratio.reset();
  joints[0].is_below_faults = true;
  EXPECT_FALSE(commonFriction(joints, 0.15).misfit.exists()) << "a fault of its own";
  joints[5].ratio = 3.4;
  EXPECT_EQ(commonFriction(joints, 0.15).misfit.reason, Reason::LESS_THAN_FAULTS);
  EXPECT_THAT(commonFriction(joints, 0.15).misfit.clause, HasSubstr("another order"));
  for (MeasuredFriction& joint : joints)
  {
    joint.ratio = 2.3;
  }
  joints[0].ratio.reset();
  EXPECT_FALSE(commonFriction(joints, 0.15).misfit.exists()) << "the whole arm has more";
}

TEST(CommonFriction, JointsThatFitNoLoadLeaveNoneJudged)
{
  std::vector<MeasuredFriction> joints = jointsWith({ 1.0, 1.0, 3.4, 1.0, 1.0, 1.0 });
  joints[0].is_load_wrong = true;
  EXPECT_FALSE(commonFriction(joints, 0.15).misfit.exists()) << "one may be its own fault";
  joints[1].is_load_wrong = true;
  const Misfit misfit = commonFriction(joints, 0.15).misfit;
  EXPECT_EQ(misfit.reason, Reason::LOAD_WRONG);
  EXPECT_THAT(misfit.clause, testing::HasSubstr("another arm"));
  joints[1] = joints[2];
  joints[1].is_below_faults = true;
  EXPECT_EQ(commonFriction(joints, 0.15).misfit.reason, Reason::LOAD_WRONG)
      << "nor is a joint judged beside two that show what no drive does";
}
}  // namespace
}  // namespace hjt
