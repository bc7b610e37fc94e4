// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/recorded_windows.hpp"

#include <array>
#include <filesystem>
#include <tuple>

#include <rosbag/bag.h>
#include <rosbag/view.h>

#include "datasets/run_file.hpp"

#include "bags/bag_file.hpp"
#include "harmonic_joint_twin/base/errors.hpp"
#include "messages/conversions.hpp"

namespace hjt
{
namespace
{
// MD5 sum of Indicators.msg in versions without the field `errors`.
constexpr const char* MD5_WITHOUT_ERRORS = "091d07ef25dd2e390a74058313d996a8";

bool isRun(const std::string& recording)
{
  return std::filesystem::path(recording).extension() == ".h5";
}

/// Whether two configurations give the same windows. Parameters of reference and assessment do not affect windows.
bool makeSameWindows(Parameters one, const Parameters& other)
{
  one.indicators.baseline_windows = other.indicators.baseline_windows;
  one.indicators.least_spread = other.indicators.least_spread;
  one.indicators.false_alarm_rate = other.indicators.false_alarm_rate;
  one.indicators.evidence_windows = other.indicators.evidence_windows;
  one.indicators.signatures = other.indicators.signatures;
  one.indicators.error_factor = other.indicators.error_factor;
  return describeParameters(one) == describeParameters(other);
}

/// Indicators of a message in a bag; none if the message has another type.
std::optional<harmonic_joint_twin::Indicators> readMessage(const rosbag::MessageInstance& instance)
{
  if (instance.getMD5Sum() != MD5_WITHOUT_ERRORS)
  {
    const auto message = instance.instantiate<harmonic_joint_twin::Indicators>();
    return message ? std::make_optional(*message) : std::nullopt;
  }
  std::vector<std::uint8_t> bytes(instance.size() + sizeof(std::uint32_t));  // an empty list of errors is appended
  ros::serialization::OStream out(bytes.data(), instance.size());
  instance.write(out);
  ros::serialization::IStream in(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  harmonic_joint_twin::Indicators message;
  ros::serialization::deserialize(in, message);
  return message;
}
}  // namespace

RecordingParameters recordingParameters(const SignalOptions& options, const std::string& recording)
{
  RecordingParameters parameters;
  ParameterMap map = defaultParameterMap(options);
  const bool changed = !options.isDefault();
  parameters.origin = "configuration";
  if (const std::string text = isRun(recording) ? readRunParameters(recording) : std::string(); !text.empty())
  {
    readDescription(text, recording + ": parameters", map);
    parameters.run = parseParameters(map);
    parameters.origin = changed ? "run, under those of the command line" : "run";
  }
  addOverlays(options, map);
  parameters.values = parseParameters(map);
  return parameters;
}

std::optional<std::vector<SignalIndicators>> windowsOfRun(const std::string& recording, const SignalOptions& options,
                                                          const RecordingParameters& parameters)
{
  const bool plain = !options.torque_scale && options.joint.empty() && !namesColumn(options);
  if (!parameters.run || !plain || !makeSameWindows(*parameters.run, parameters.values))
  {
    return std::nullopt;
  }
  const Columns columns = readRunColumns(recording, { "window_end" });
  if (columns.empty())
  {
    return std::nullopt;
  }
  const auto column = [&](const std::string& name) -> const std::vector<double>&
  {
    const auto found = columns.find(name);
    if (found == columns.end() || found->second.size() != columns.at("window_end").size())
    {
      throw InputError(recording + ": the group indicators has no column '" + name + "' as long as window_end");
    }
    return found->second;
  };
  std::vector<SignalIndicators> windows(column("window_end").size());
  const auto read = [&](const char* name, const auto& put)
  {
    const std::vector<double>& values = column(name);
    for (std::size_t i = 0; i < windows.size(); ++i)
    {
      put(windows[i], values[i]);
    }
  };
  using W = SignalIndicators&;
  read("window_end", [](W w, double value) { w.stamp = toStampLength(value); });
  read("window_turns", [](W w, double value) { w.turns = value; });
  read("window_speed", [](W w, double value) { w.point.speed = value; });
  read("window_direction", [](W w, double value) { w.point.direction = value; });
  read("window_load", [](W w, double value) { w.point.load = value; });
  read("window_load_constant", [](W w, double value) { w.point.load_constant = value; });
  read("window_load_sine", [](W w, double value) { w.point.load_sine = value; });
  read("window_load_cosine", [](W w, double value) { w.point.load_cosine = value; });
  read("window_inertia", [](W w, double value) { w.point.inertia = value; });
  read("window_temperature", [](W w, double value) { w.point.temperature = value; });
  for (std::size_t i = 0; i < INDICATOR_COUNT; ++i)
  {
    read(indicatorName(i), [i](W w, double value) { w.values[i] = value; });
  }
  for (std::size_t i = SCALAR_COUNT; i < INDICATOR_COUNT; ++i)
  {
    if (columns.count(errorColumn(i)) > 0)  // files of earlier versions lack this column
    {
      read(errorColumn(i).c_str(), [i](W w, double value) { w.uncertainty[i] = value; });
    }
  }
  for (std::size_t i = 0; i < windows.size(); ++i)
  {
    windows[i].windows = i + 1;
  }
  return windows;
}

std::vector<SignalIndicators> publishedWindows(const std::string& path, const std::string& topic)
{
  rosbag::Bag bag;
  openForReading(bag, path);
  std::vector<SignalIndicators> windows;
  for (const rosbag::MessageInstance& instance : rosbag::View(bag, rosbag::TopicQuery(topic)))
  {
    const auto message = readMessage(instance);
    if (message && message->windows > (windows.empty() ? 0 : windows.back().windows))
    {
      windows.push_back(readIndicators(*message));
    }
  }
  return windows;
}

void ClosestAssessment::take(const Assessment& assessment)
{
  const auto nearness = [](const Assessment& of)
  {
    constexpr std::array BY_STATE{ 0, 1, 3, 1, 2, 1 };
    return std::tuple(BY_STATE[static_cast<std::size_t>(of.state)], of.windows_here);
  };
  closest_ = nearness(assessment) >= nearness(closest_) ? assessment : closest_;
}

std::string ClosestAssessment::whyNotJudged(const std::string& recording) const
{
  return recording + ": " + (closest_.windows == 0 ? "no whole window of steady motion" : hjt::whyNotJudged(closest_));
}
}  // namespace hjt
