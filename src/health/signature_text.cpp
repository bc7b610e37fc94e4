// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <sstream>
#include <string>

#include "base/number_text.hpp"
#include "harmonic_joint_twin/base/errors.hpp"
#include "health/signature_file.hpp"

namespace hjt
{
namespace
{
constexpr const char* KINEMATICS = " kinematics ";  // motion of the rows that no run made
constexpr const char* HEAD = R"(# SPDX-License-Identifier: BSD-3-Clause
# What faults change in the health indicators of a gear, found in the twin's own runs
# (docs/indicators.md, "Signatures").
# Written by `joint_twin signatures`.
format: )";
constexpr const char* ERRORS = R"(
# Errors by the law of docs/indicators.md [-]: of each number of a signature on another gear, and in a motion of another
# kind; share of the sound drive's lines that a fault of severity 1 changes; weight of the evidence, and the share of it
# that is left where no signature fits; of the severity, and more where no signature fits.
errors:
)";
constexpr const char* INDICATORS = R"(
# Indicators that the signatures are known for, in the order of the columns below, and their units.
indicators:
)";
constexpr const char* SOUND = R"(
# Values of the sound drive in the first motion, in these units.
sound:
)";
constexpr const char* CARRIED = R"(
# What the indicators of a sound drive less a model's differ by from one motion to another: [deviation in the
# indicator's unit, share of what drive and model differ by, degrees of freedom]. Not known of what is missing here.
carried:
)";
constexpr const char* OCCURRENCE = R"(
# How often a cause occurs, 1 ... 10 [-]: FMECA of C. Costantino, Politecnico di Torino, 2021, Table 3.7. What is
# missing here is not rated.
occurrence:
)";
constexpr const char* ROBOTS = R"(
# What faults change in friction by load and lag of a robot in closed loop, of any gear in any motion: [cause, severity,
# then, as shares of the sound values, load_friction, lag_ripple, lag_order_1, _2, _4]. By `lab/run faults_seen --fit`.
robots:
)";
constexpr const char* SIGNATURES = R"(
# A row each: cause, motion, speed of the motor [rad/s] and share of travel one way less the other [-] (magnitudes; 0 0:
# any motion), severity [-], then the change of each of the indicators; of stiffness, lost motion and loop, and of
# friction by thicker grease, as a share of the sound value [-].
signatures: |
)";

/// As short as can be: -2.44e-5.
std::string shortText(double value, int digits)
{
  const std::string text = roundedText(value, digits);
  const std::size_t exponent = text.find('e');
  if (exponent == std::string::npos)
  {
    return text;
  }
  const std::string sign = text[exponent + 1] == '-' ? "-" : "";
  return text.substr(0, exponent + 1) + sign + text.substr(text.find_first_not_of('0', exponent + 2));
}

void writeRow(const Signature& signature, const std::string& motion, const SignatureSet& set, TextStream& text)
{
  text << "  " << causeName(signature.cause) << ' ' << motion << ' ' << shortText(signature.motion.speed, 4) << ' '
       << shortText(signature.motion.direction, 2) << ' ' << numberText(signature.severity);
  for (std::size_t i = 0; i < SIGNATURE_SIZE; ++i)
  {
    if (set.fitted[i] && !isOfRobot(i))
    {
      text << ' ' << shortText(signature.change[i], 3);
    }
  }
  text << '\n';
}

void writeOccurrence(const SignatureSet& set, TextStream& text)
{
  text << OCCURRENCE;
  for (std::size_t i = 0; i < CAUSE_COUNT; ++i)
  {
    if (set.occurrence[i] > 0.0)
    {
      text << "  " << causeName(static_cast<Cause>(i)) << ": " << numberText(set.occurrence[i]) << '\n';
    }
  }
}
}  // namespace

std::string signatureText(const SignatureSet& set, const std::vector<std::string>& motions)
{
  TextStream text;
  text << HEAD << SIGNATURE_FORMAT << "\ngear: " << set.gear << '\n' << ERRORS;
  for (const SignatureErrorRow& row : SIGNATURE_ERRORS)
  {
    text << "  " << row.key << ": " << numberText(set.*row.value) << '\n';
  }
  text << INDICATORS;
  const std::array<std::size_t, SIGNATURE_SIZE> indicators = indicatorsOfNumbers();
  for (std::size_t i = 0; i < SIGNATURE_SIZE; ++i)
  {
    if (set.fitted[i] && !isOfRobot(i))
    {
      const std::string unit = indicatorUnit(indicators[i]);
      text << "  " << indicatorName(indicators[i]) << ": " << (unit == "-" ? "\"-\"" : unit) << '\n';
    }
  }
  text << SOUND;
  for (std::size_t i = 0; i < SCALAR_COUNT; ++i)
  {
    if (!std::isnan(set.sound[i]))
    {
      text << "  " << indicatorName(i) << ": " << numberText(*decimalNumber(roundedText(set.sound[i], 3))) << '\n';
    }
  }
  text << CARRIED;
  for (std::size_t i = 0; i < INDICATOR_COUNT; ++i)
  {
    const CarriedError& error = set.carried[i];
    if (error.deviation < CarriedError{}.deviation)
    {
      text << "  " << indicatorName(i) << ": [" << numberText(error.deviation) << ", " << numberText(error.share)
           << ", " << numberText(error.freedom) << "]\n";
    }
  }
  writeOccurrence(set, text);
  if (!set.of_robots.empty())
  {
    text << ROBOTS;
  }
  for (const RobotSignature& signature : set.of_robots)
  {
    text << "  - [" << causeName(signature.cause) << ", " << numberText(signature.severity);
    for (const double share : signature.share)
    {
      text << ", " << numberText(share);
    }
    text << "]\n";
  }
  text << SIGNATURES;
  for (std::size_t i = 0; i < set.signatures.size(); ++i)
  {
    writeRow(set.signatures[i], motions[i], set, text);
  }
  return text.str();
}

std::string withRowsOf(const std::string& text, const std::string& path, const std::string& added)
{
  if (parseSignatures(text, path).fitted != parseSignatures(added, "those to add").fitted)
  {
    throw ParameterError(path + ": its indicators are not those of the signatures to add");
  }
  std::string all = text + (text.back() == '\n' ? "" : "\n");
  std::istringstream rows(added.substr(added.find(SIGNATURES) + std::string(SIGNATURES).size()));
  for (std::string row; std::getline(rows, row);)
  {
    all += row.find(KINEMATICS) == std::string::npos ? row + '\n' : "";
  }
  return all;
}
}  // namespace hjt
