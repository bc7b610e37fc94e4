// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <limits>

#include "base/number_text.hpp"
#include "messages/conversions.hpp"
#include "messages/time.hpp"

namespace hjt
{
namespace
{
/// A number that may be missing: 0 and false where it is.
template <class Flag>
void fillOptional(double value, double& field, Flag& valid) noexcept
{
  valid = std::isfinite(value);
  field = std::isfinite(value) ? value : 0.0;
}

double optionalValue(double field, bool valid) noexcept
{
  return valid ? field : std::numeric_limits<double>::quiet_NaN();
}
}  // namespace

std::size_t writeEvidence(const Assessment& assessment, char* text, std::size_t size) noexcept
{
  std::size_t length = 0;
  for (std::size_t i = 0; i < assessment.evidence_count && length < size; ++i)
  {
    const Evidence& evidence = assessment.evidence[i];
    // Short texts are not allocated.
    const std::string value = roundedText(evidence.value, 3);
    const std::string expected = roundedText(evidence.expected, 3);
    const std::string score = fixedText(std::min(evidence.score, 1e9), 1);
    const int written = std::snprintf(text + length, size - length, "%s%s %s %s, healthy %s (score %s)",
                                      i == 0 ? "" : "; ", indicatorName(evidence.indicator), value.c_str(),
                                      indicatorUnit(evidence.indicator), expected.c_str(), score.c_str());
    length = std::min(length + static_cast<std::size_t>(std::max(written, 0)), size - 1);
  }
  return length;
}

std::size_t writeAlternatives(const Assessment& assessment, char* text, std::size_t size) noexcept
{
  std::size_t length = 0;
  for (std::size_t i = 0; i < assessment.alternative_count && length < size; ++i)
  {
    const Alternative& alternative = assessment.alternatives[i];
    const int written = std::snprintf(text + length, size - length, "%s%s %.0f %%", i == 0 ? "" : "; ",
                                      causeName(alternative.cause), 100.0 * alternative.confidence);
    length = std::min(length + static_cast<std::size_t>(std::max(written, 0)), size - 1);
  }
  return length;
}

harmonic_joint_twin::Assessment makeAssessment(const Parameters& parameters)
{
  auto message = makeMessage<harmonic_joint_twin::Assessment>(parameters);
  message.cause.assign(EVIDENCE_LENGTH, ' ');
  message.alternatives.assign(EVIDENCE_LENGTH, ' ');
  message.evidence.assign(EVIDENCE_LENGTH, ' ');
  return message;
}

void fillAssessment(Stamp stamp, const Assessment& assessment, harmonic_joint_twin::Assessment& message) noexcept
{
  message.header.stamp = toRosTime(stamp);
  message.window_end = toRosTime(assessment.stamp);
  message.windows = assessment.windows;
  message.state = static_cast<std::uint8_t>(assessment.state);
  message.windows_here = static_cast<std::uint32_t>(assessment.windows_here);
  message.windows_needed = static_cast<std::uint32_t>(assessment.windows_needed);
  message.level = static_cast<std::uint8_t>(assessment.level);
  message.cause.assign(causeName(assessment.cause));
  message.confidence = assessment.confidence;
  message.severity = assessment.severity;
  message.severity_deviation = assessment.severity_deviation;
  message.largest_score = assessment.largest_score;
  std::array<char, EVIDENCE_LENGTH> text{};
  message.evidence.assign(text.data(), writeEvidence(assessment, text.data(), text.size()));
  message.alternatives.assign(text.data(), writeAlternatives(assessment, text.data(), text.size()));
}

harmonic_joint_twin::Indicators makeIndicators(const Parameters& parameters)
{
  auto message = makeMessage<harmonic_joint_twin::Indicators>(parameters);
  for (std::size_t i = 0; i < INDICATOR_COUNT; ++i)
  {
    message.names.emplace_back(indicatorName(i));
  }
  message.values.resize(INDICATOR_COUNT);
  message.valid.resize(INDICATOR_COUNT);
  message.errors.resize(INDICATOR_COUNT);
  return message;
}

void fillIndicators(Stamp stamp, const SignalIndicators& indicators, harmonic_joint_twin::Indicators& message) noexcept
{
  message.header.stamp = toRosTime(stamp);
  message.window_end = toRosTime(indicators.stamp);
  message.windows = indicators.windows;
  message.turns = indicators.turns;
  message.speed = indicators.point.speed;
  message.direction = indicators.point.direction;
  fillOptional(indicators.point.load, message.load, message.load_valid);
  message.load_constant = message.load_valid ? indicators.point.load_constant : 0.0;
  message.load_sine = message.load_valid ? indicators.point.load_sine : 0.0;
  message.load_cosine = message.load_valid ? indicators.point.load_cosine : 0.0;
  fillOptional(indicators.point.temperature, message.temperature, message.temperature_valid);
  message.inertia = indicators.point.inertia;
  for (std::size_t i = 0; i < INDICATOR_COUNT; ++i)
  {
    fillOptional(indicators.values[i], message.values[i], message.valid[i]);
    message.errors[i] = indicators.uncertainty[i];
  }
}

SignalIndicators readIndicators(const harmonic_joint_twin::Indicators& message)
{
  SignalIndicators indicators;
  indicators.stamp = fromRosTime(message.window_end);
  indicators.windows = message.windows;
  indicators.turns = message.turns;
  indicators.point = { message.speed,
                       message.direction,
                       optionalValue(message.load, message.load_valid),
                       optionalValue(message.temperature, message.temperature_valid),
                       optionalValue(message.load_constant, message.load_valid),
                       optionalValue(message.load_sine, message.load_valid),
                       optionalValue(message.load_cosine, message.load_valid),
                       message.inertia };
  const std::size_t count = std::min({ message.names.size(), message.values.size(), message.valid.size() });
  for (std::size_t i = 0; i < INDICATOR_COUNT; ++i)
  {
    const auto name = std::find(message.names.begin(), message.names.end(), indicatorName(i));
    const auto place = static_cast<std::size_t>(name - message.names.begin());
    if (place < count)
    {
      indicators.values[i] = optionalValue(message.values[place], message.valid[place] != 0);
      indicators.uncertainty[i] = place < message.errors.size() ? message.errors[place] : 0.0;
    }
  }
  return indicators;
}
}  // namespace hjt
