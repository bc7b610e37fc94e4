// SPDX-License-Identifier: BSD-3-Clause
#include "health/signature_file.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <sstream>

#include <gmock/gmock.h>

#include "harmonic_joint_twin/health/assessment.hpp"
#include "test/core/complaint.hpp"
#include "test/core/test_parameters.hpp"

namespace hjt
{
namespace
{
constexpr const char* SMALL = R"(format: 3
gear: mine
errors: {number: 0.1, motion: 0.4, line: 0.5, weight: 0.2, misfit: 0.1, severity: 0.3, severity_misfit: 0.6}
indicators:
  torsional_stiffness: N.m/rad
  torque_ball: N.m
sound:
  torsional_stiffness: 2000.0
carried:
  torque_ball_above: [0.1, 0.2, 3.0]
occurrence: {pitting: 6.0}
signatures: |
  pitting check_up 80 0.02 0.5 -0.25 3e-7
  circular_spline_tooth any 0 0 1.0 0 1e-2
)";

std::string replaced(const std::string& what, const std::string& by)
{
  std::string text = SMALL;
  return text.replace(text.find(what), what.size(), by);
}

std::string refusal(const std::string& text)
{
  return complaintOf([&] { parseSignatures(text, "mine.yaml"); });
}

TEST(SignatureFile, IsTakenNumberByNumber)
{
  const SignatureSet set = parseSignatures(SMALL, "mine.yaml");
  EXPECT_EQ(set.gear, "mine");
  EXPECT_EQ(set.motion_error, 0.4);
  EXPECT_EQ(set.misfit_weight, 0.1);
  EXPECT_EQ(set.severity_error, 0.3);
  EXPECT_EQ(set.severity_misfit, 0.6);
  EXPECT_EQ(set.occurrence[static_cast<std::size_t>(causeOf(FaultKind::PITTING))], 6.0);
  EXPECT_EQ(set.occurrence[static_cast<std::size_t>(causeOf(FaultKind::BUCKLING))], 0.0);
  constexpr std::size_t STIFFNESS = indexOf(ScalarIndicator::TORSIONAL_STIFFNESS);
  constexpr std::size_t BALL = signatureNumber(LineSignal::MOTOR_TORQUE, index(Line::BALL));
  EXPECT_EQ(std::count(set.fitted.begin(), set.fitted.end(), true), 2);
  EXPECT_TRUE(set.fitted[STIFFNESS] && set.fitted[BALL]);
  EXPECT_EQ(set.sound[STIFFNESS], 2000.0);
  EXPECT_TRUE(std::isnan(set.sound[indexOf(ScalarIndicator::RUNNING_TORQUE)]));
  const std::size_t above = amplitudeIndex(LineSignal::MOTOR_TORQUE, index(Line::BALL_ABOVE));
  EXPECT_EQ(set.carried[above].share, 0.2);
  EXPECT_EQ(set.carried[STIFFNESS].deviation, CarriedError{}.deviation);
  ASSERT_EQ(set.signatures.size(), 2U);
  EXPECT_EQ(set.signatures[0].cause, causeOf(FaultKind::PITTING));
  EXPECT_EQ(set.signatures[0].motion.speed, 80.0);
  EXPECT_EQ(set.signatures[0].change[STIFFNESS], -0.25);
  EXPECT_EQ(set.signatures[0].change[BALL], 3e-7);
  EXPECT_EQ(set.signatures[1].cause, Cause::CIRCULAR_SPLINE_TOOTH);
  EXPECT_EQ(causesThatMove(set, ScalarIndicator::TORSIONAL_STIFFNESS, -1.0, 0.1).size(), 0U);  // not at severity 1
}

TEST(SignatureFile, GivesSignaturesWhatRobotsShowOfTheirCauseAndSeverity)
{
  const std::string robots =
      "robots:\n  - [pitting, 0.4, 0.2, 0.0, 0.0, 0.0, 1.0]\n"
      "  - [pitting, 1.0, 0.5, 0.0, 0.0, 0.0, 7.0]\nsignatures: |\n";
  const SignatureSet set = parseSignatures(replaced("signatures: |\n", robots), "mine.yaml");
  constexpr std::size_t LINE = indexOf(ScalarIndicator::LAG_ORDER_4);
  EXPECT_TRUE(set.fitted[LINE]);
  EXPECT_NEAR(set.signatures[0].change[LINE], 2.0, 1e-12) << "at 0.5, a sixth of the way from 0.4 to 1";
  EXPECT_NEAR(set.signatures[0].change[indexOf(ScalarIndicator::LOAD_FRICTION)], 0.25, 1e-12);
  EXPECT_EQ(set.signatures[1].change[LINE], 0.0) << "of another cause";
  EXPECT_THAT(refusal(replaced("signatures: |\n", "robots: [[pitting, 0.4, 0.2]]\nsignatures: |\n")),
              testing::HasSubstr("robots: expected [cause, severity and 5 shares]"));
}

TEST(SignatureFile, TakesRowsOfRunsBehindItsOwn)
{
  const SignatureSet set = parseSignatures(SMALL, "mine.yaml");
  const std::string added = signatureText(set, { "check_up", "kinematics" });
  const std::string whole = SMALL;
  for (const std::string& own : { whole, whole.substr(0, whole.size() - 1) })
  {
    const SignatureSet both = parseSignatures(withRowsOf(own, "mine.yaml", added), "both.yaml");
    EXPECT_EQ(both.signatures.size(), set.signatures.size() + 1);
  }
}

TEST(SignatureFile, SaysWhereItIsDamaged)
{
  const auto says = [](const std::string& what)
  { return testing::StartsWith("indicators.signatures: mine.yaml" + what); };
  EXPECT_THAT(refusal(replaced("format: 3", "format: 2")), says(":1: format: 2, expected 3"));
  EXPECT_THAT(refusal(replaced("gear: mine\n", "")), says(": gear: missing"));
  EXPECT_THAT(refusal(replaced("weight: 0.2", "weight: -0.2")), says(":3: errors.weight: -0.2, expected 0 ... 1000"));
  EXPECT_THAT(refusal(replaced("torque_ball: N.m", "torque_bell: N.m")),
              says(":6: indicator torque_bell: no such indicator (did you mean torque_ball?)"));
  EXPECT_THAT(refusal(replaced("torque_ball: N.m", "torque_ball: rad")),
              says(":6: indicators.torque_ball: unit rad, expected N.m"));
  EXPECT_THAT(refusal(replaced("[0.1, 0.2, 3.0]", "[0.1, 0.2]")),
              says(":10: carried.torque_ball_above: expected [deviation, share, degrees of freedom]"));
  EXPECT_THAT(refusal(replaced("pitting", "pittin")), says(":11: cause pittin: no such cause (did you mean pitting?)"));
  EXPECT_THAT(refusal(replaced("6.0", "60.0")), says(":11: occurrence.pitting: 60.0, expected 1 ... 10"));
  EXPECT_THAT(refusal(replaced("0.5 -0.25", "1.5 -0.25")),
              says(":13: signatures: severity [-] = 1.5, expected 0 ... 1"));
  EXPECT_THAT(refusal(replaced("1e-2", "")), says(":14: signatures: 6 words, expected 7"));
  EXPECT_THAT(refusal(replaced("1e-2", "nan")), says(":14: signatures: change = nan"));
  EXPECT_THAT(refusal(replaced("signatures: |\n", "signatures:\n")), testing::Not(""));
  EXPECT_THAT(refusal("- 1\n"), says(": the file has no keys, so it is no file of signatures"));
}

TEST(SignatureFile, IsWrittenAsItWasRead)
{
  for (const char* name : { "size_14.yaml", "size_25.yaml" })
  {
    std::ifstream file(std::string(HJT_TEST_CONFIG_DIR "/signatures/") + name);
    const std::string shipped{ std::istreambuf_iterator<char>(file), {} };
    std::istringstream rows(shipped.substr(shipped.find("signatures: |") + 14));
    std::vector<std::string> motions;
    for (std::string cause, motion, rest; rows >> cause >> motion && std::getline(rows, rest);)
    {
      motions.push_back(motion);
    }
    EXPECT_EQ(signatureText(parseSignatures(shipped, name), motions), shipped) << name;
  }
}

TEST(SignatureFile, IsReadOnceAndSharedByAllWhoNameIt)
{
  const std::string name = shippedParameters().indicators.signatures;
  const auto shipped = loadSignatures(name);
  EXPECT_EQ(shipped, loadSignatures(name));
  EXPECT_GT(shipped->signatures.size(), 1000U);
  EXPECT_EQ(std::count(shipped->fitted.begin(), shipped->fitted.end(), true), SIGNATURE_SIZE);
  EXPECT_THROW(loadSignatures("signatures/size_26.yaml"), ParameterError);
}

TEST(SignatureFile, WithoutOneThereIsNoCauseAndNoConfidence)
{
  Assessor assessor(shippedParameters(
      { "indicators.signatures=none", "indicators.baseline_windows=8", "indicators.evidence_windows=1" }));
  SignalIndicators window;
  window.point.speed = 80.0;
  for (int i = 0; i < 20; ++i)
  {
    window.values[indexOf(ScalarIndicator::RUNNING_TORQUE)] = (i < 8 ? 0.1 : 0.3) + 1e-4 * (i % 3);
    ++window.windows;
    assessor.update(window);
  }
  EXPECT_EQ(assessor.assessment().level, HealthLevel::ERROR);
  EXPECT_EQ(assessor.assessment().cause, Cause::NONE);
  EXPECT_EQ(assessor.assessment().confidence, 0.0);
  EXPECT_GT(assessor.assessment().evidence_count, 0U);
}

TEST(Baseline, LearnsNoMoreClassesThanItHasMemoryFor)
{
  const Parameters parameters = shippedParameters({ "indicators.baseline_classes=2" });
  Baseline baseline(parameters, loadSignatures(NO_FILE));
  Deviations deviations;
  SignalIndicators window;
  for (const double speed : { 20.0, 80.0, 320.0 })
  {
    window.point.speed = speed;
    const AssessmentState state = baseline.update(window, nullptr, deviations);
    EXPECT_EQ(state, speed < 300.0 ? AssessmentState::LEARNING : AssessmentState::NO_REFERENCE);
  }
  EXPECT_EQ(baseline.bins().size(), 2U);
  baseline.setReference(baseline.bins());
  EXPECT_TRUE(baseline.sums().empty());
}
}  // namespace
}  // namespace hjt
