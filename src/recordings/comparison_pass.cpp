// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/comparison_pass.hpp"

#include <algorithm>
#include <deque>
#include <filesystem>

#include "harmonic_joint_twin/base/errors.hpp"
#include "recordings/report_page.hpp"
#include "tracking/sound_joint.hpp"

namespace hjt
{
namespace
{
namespace fs = std::filesystem;

/// @throws InputError if one of the files that the page is made of cannot be written to `directory`.
void prepareDirectory(const ComparisonOptions& options, const std::string& directory, const char* data_file)
{
  std::error_code error;
  fs::create_directories(directory, error);
  if (error)
  {
    throw InputError(directory + " cannot be made a directory: " + error.message());
  }
  for (const char* name : { data_file, REPORT_PAGE })
  {
    requireWritable((fs::path(directory) / name).string(), options.force, options.recording);
  }
}

/// The directory of a joint's report, or of its reference, in that of the whole.
std::string directoryOf(const ArmRecording& recording, const std::string& whole, std::size_t joint)
{
  return recording.isArm() && !whole.empty() ? (fs::path(whole) / recording.joints()[joint].short_name).string() :
                                               whole;
}

std::vector<std::unique_ptr<JointComparison>> prepareJoints(const ComparisonOptions& options,
                                                            const ArmRecording& recording)
{
  const LoadOrigin load = recording.usesRecordedLoad() ? LoadOrigin::RECORDED :
                          recording.isArm()            ? LoadOrigin::ARM :
                                                         LoadOrigin::CONFIGURED;
  if (recording.isArm())
  {
    prepareDirectory(options, options.report, ARM_FILE);
  }
  std::vector<std::unique_ptr<JointComparison>> joints;
  for (std::size_t i = 0; i < recording.joints().size(); ++i)
  {
    const std::string directory = directoryOf(recording, options.report, i);
    prepareDirectory(options, directory, COMPARISON_FILE);
    std::vector<std::string> references;
    for (const std::string& reference : options.references)
    {
      references.push_back(directoryOf(recording, reference, i));
    }
    joints.push_back(
        std::make_unique<JointComparison>(recording, i, load, directory, references, !options.identified.empty()));
  }
  return joints;
}

/// Where no joint has a reference of its own, and the controller's is that of sound joints.
void holdAgainstController(const std::vector<std::unique_ptr<JointComparison>>& joints)
{
  std::vector<const JointEvidence*> evidences;
  for (const auto& joint : joints)
  {
    if (joint->hasReference())
    {
      return;
    }
    evidences.push_back(&joint->evidence());
  }
  if (controllerIsReference(evidences))
  {
    for (const auto& joint : joints)
    {
      joint->holdAgainstController();
    }
  }
}

/// Of samples that come by joints: all of one time at once.
class PayloadCollector
{
public:
  explicit PayloadCollector(const ArmRecording& recording)
    : fit_(recording.arm(), gainsOf(recording)), waiting_(recording.joints().size())
  {
  }

  void add(std::size_t joint, const MotionSample& sample, const JointEvidence& evidence)
  {
    waiting_[joint].push_back({ sample, evidence.predicted().current, evidence.isTouched() });
    while (std::none_of(waiting_.begin(), waiting_.end(), [](const std::deque<Row>& rows) { return rows.empty(); }))
    {
      samples_.clear();
      predicted_.clear();
      bool is_touched = false;
      for (std::deque<Row>& rows : waiting_)
      {
        samples_.push_back(rows.front().sample);
        predicted_.push_back(rows.front().predicted);
        is_touched = is_touched || rows.front().is_touched;
        rows.pop_front();
      }
      if (!is_touched)
      {
        fit_.add(samples_, predicted_);
      }
    }
  }

  IdentifiedPayload solve() { return fit_.solve(); }

private:
  struct Row
  {
    MotionSample sample;
    double predicted{};  // [A]
    bool is_touched{};
  };

  static std::vector<double> gainsOf(const ArmRecording& recording)
  {
    std::vector<double> gains;
    for (const Parameters& parameters : recording.parameters())
    {
      gains.push_back(parameters.telemetry.torque_per_current);
    }
    return gains;
  }

  PayloadFit fit_;
  std::vector<std::deque<Row>> waiting_;
  std::vector<MotionSample> samples_;
  std::vector<double> predicted_;
};
}  // namespace

ComparisonPass passThrough(const ComparisonOptions& options, const ArmRecording& recording)
{
  ComparisonPass pass;
  pass.joints = prepareJoints(options, recording);
  std::optional<PayloadCollector> payload;
  if (recording.isArm() && !recording.usesRecordedLoad())
  {
    payload.emplace(recording);
  }
  RecordingFit fit(recording.parameters());
  pass.found = recording.readSamples(
      [&](std::size_t i, const MotionSample& sample)
      {
        pass.joints[i]->update(sample);
        if (payload)
        {
          payload->add(i, sample, pass.joints[i]->evidence());
        }
      },
      fit);
  pass.misfits = recording.isArm() ? fit.whyNotJudged() : std::vector<Misfit>{ pass.found.misfit };
  if (options.beside_controller)
  {
    holdAgainstController(pass.joints);
  }
  std::vector<MeasuredFriction> frictions;
  for (std::size_t i = 0; i < pass.joints.size(); ++i)
  {
    frictions.push_back(pass.joints[i]->friction(pass.misfits[i]));
  }
  pass.friction = commonFriction(frictions, recording.parameters(0).comparison.repeat_tolerance);
  const bool fits =
      std::all_of(pass.misfits.begin(), pass.misfits.end(), [](const Misfit& misfit) { return !misfit.exists(); });
  for (Misfit& misfit : pass.misfits)
  {
    misfit = misfit.exists() ? misfit : pass.friction.misfit;
  }
  if (payload && fits && !pass.friction.misfit.exists() && !options.watch.stopped())
  {
    pass.payload = payload->solve();
  }
  return pass;
}
}  // namespace hjt
