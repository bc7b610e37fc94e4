// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/joint_comparison.hpp"

#include <filesystem>
#include <optional>
#include <utility>

#include "messages/conversions.hpp"

namespace hjt
{
namespace
{
namespace fs = std::filesystem;

const std::vector<Column<JudgedWindow>> WINDOW_COLUMNS{
  { "time", [](const JudgedWindow& window) { return 1e-9 * static_cast<double>(window.indicators.stamp); } },
  { "speed", [](const JudgedWindow& window) { return window.indicators.point.speed; } },
  { "load", [](const JudgedWindow& window) { return window.indicators.point.load; } },
  { "level", [](const JudgedWindow& window) { return static_cast<int>(window.assessment.level); } },
  { "cause", [](const JudgedWindow& window) { return static_cast<int>(window.assessment.cause); } },
  { "confidence", [](const JudgedWindow& window) { return window.assessment.confidence; } },
  { "largest_score", [](const JudgedWindow& window) { return window.assessment.largest_score; } }
};
}  // namespace

JointComparison::JointComparison(const ArmRecording& recording, std::size_t joint, const std::string& directory,
                                 SoundJoint sound, bool is_identified)
  : AssessedJoint(std::move(sound.own), is_identified)
  , source_(recording.source(joint))
  , is_file_(recording.isFile())
  , directory_(directory)
  , comparison_(recording.parameters(joint), recording.loadOrigin(), std::move(sound.baseline),
                [this](const JudgedWindow& window)
                {
                  if (windows_)
                  {
                    windows_->write(window);
                  }
                })
{
  if (!directory_.empty())
  {
    windows_.emplace((fs::path(directory) / "windows.csv").string(), WINDOW_COLUMNS);
  }
}

ComparedJoint JointComparison::write(const Parameters& parameters, const MotionFindings& found,
                                     const JointContext& context, const std::string& twin_topic)
{
  if (windows_)
  {
    windows_->close();
  }
  ComparisonRecord record;
  record.recording = source_.path;
  record.joint = source_.joint;
  record.made_with = MADE_WITH;
  record.found = found;
  const MotionReach& reach = evidence().reach();
  if (is_file_)
  {
    record.contents =
        readContents(source_, twin_topic, found, reach.motor_rows, reach.temperature_rows, found.has_load);
    if (!directory_.empty())  // of the page alone
    {
      record.twin_states = readTwinStates(source_, twin_topic, toSeconds(found.start));
    }
  }
  record.verdict = judge(evidence(), context);
  record.friction = frictionFactor(evidence(), context);
  record.is_friction_judged = record.verdict.findings.front().level != VerdictLevel::NOT_JUDGED;
  ComparedJoint compared;
  compared.friction = record.is_friction_judged ? std::make_optional(record.friction) : std::nullopt;
  compared.contact = reach.touched_rows > 0 ? sentence(contactText(evidence().contact().largest())) : std::string();
  compared.document = writeComparison(directory_, comparison_, parameters, record);
  compared.temperature = evidence().temperature();
  compared.temperature_source = temperatureSource(evidence());
  compared.rows = reach.rows;
  compared.current_rms = evidence().currentRms();
  compared.residual_rms = evidence().residualRms();
  compared.contents = std::move(record.contents);
  compared.verdict = std::move(record.verdict);
  return compared;
}
}  // namespace hjt
