// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <iostream>
#include <string>
#include <vector>

#include <rosbag/view.h>

#include "apps/common/configuration.hpp"
#include "apps/common/surface_source.hpp"
#include "output/interrupt.hpp"
#include "output/output_file.hpp"
#include "output/progress.hpp"
#include "output/run_summary.hpp"
#include "output/text_table.hpp"
#include "recordings/recording_options.hpp"

#include "bags/bag_file.hpp"
#include "bags/bag_inputs.hpp"
#include "bags/bag_recorder.hpp"
#include "base/joined.hpp"
#include "harmonic_joint_twin/base/errors.hpp"

namespace hjt
{
namespace
{
/// Of a recording; more is a damaged time of recording, and the twin would simulate years [s].
constexpr double MAX_RECORDING = 1e6;

struct ReplayOptions : CommonOptions
{
  std::string bag;
  std::string out;
  std::string joint_namespace{ DEFAULT_NAMESPACE };
  bool without_command{};
};

/// The response surface is off by less than the topics' sensors resolve, and a hundred times as fast: replayed on it
/// unless a file or --set says otherwise. Each Health message tells which it was.
ParameterMap replayedMap(const ReplayOptions& options)
{
  ParameterMap map = defaultParameterMap(options);
  readAssignment("solver.scene=auto", map);
  addOverlays(options, map);
  return map;
}

/// True if a file or --set other than the default configuration names the joint.
bool jointIsChosen(const ReplayOptions& options, const ParameterMap& map)
{
  CommonOptions defaults;
  defaults.config_dir = options.config_dir;
  return map.at("joint.name").origin != loadParameterMap(defaults).at("joint.name").origin;
}

[[noreturn]] void failWithoutInputs(const rosbag::Bag& bag, const ReplayOptions& options, const BagInputs& found,
                                    const std::string& joint)
{
  if (!found.other_joints.empty())
  {
    throw InputError(options.bag + " commands other joints (" + joined(found.other_joints) + ") than joint.name = " +
                     joint + "; choose one with --set joint.name=NAME or an overlay of config/joints");
  }
  throw InputError(options.bag + " has no motor torque on an input topic (" +
                   joined(inputTopics(options.joint_namespace)) +
                   "); --without-command replays other inputs alone, `joint_twin follow --bag` the motion of a "
                   "robot. It holds:" +
                   listTopics(bag));
}

/// Whether the bag holds what is replayed: a motor torque, or any input if that is left out on purpose.
bool suffices(const BagInputs& found, const ReplayOptions& options)
{
  return std::any_of(found.inputs.begin(), found.inputs.end(),
                     [&](const TwinInput& input)
                     {
                       const auto* value = std::get_if<Input>(&input);
                       return options.without_command || (value != nullptr && value->kind == InputKind::MOTOR_TORQUE);
                     });
}

/// @throws InputError where damage makes the recording last for years.
void checkSpan(const rosbag::Bag& bag, const std::string& path)
{
  rosbag::View view(bag);
  const double span = toSeconds(fromRosTime(view.getEndTime()) - fromRosTime(view.getBeginTime()));
  if (span > MAX_RECORDING)
  {
    throw InputError(path + ": the times of recording span " + shortNumber(span) + " s, allowed: at most " +
                     shortNumber(MAX_RECORDING) + " s; one of them is damaged");
  }
}

/// The torques of the bag. If it commands one joint only and the user has not named one, `parameters` takes its name.
BagInputs requireInputs(const rosbag::Bag& bag, const ReplayOptions& options, const ParameterMap& map,
                        Parameters& parameters)
{
  BagInputs found = readBagInputs(bag, options.joint_namespace, parameters);
  if (found.inputs.empty() && found.other_joints.size() == 1 && !jointIsChosen(options, map))
  {
    parameters.joint.name = *found.other_joints.begin();
    std::cerr << "joint_twin: joint.name = " << parameters.joint.name << ", the one joint that " << options.bag
              << " commands\n";
    found = readBagInputs(bag, options.joint_namespace, parameters);
  }
  if (!suffices(found, options))
  {
    failWithoutInputs(bag, options, found, parameters.joint.name);
  }
  warn(found.without_effort, "messages name " + parameters.joint.name + " but give no effort for it; ignored");
  warn(found.damaged, "damaged messages on input topics; ignored");
  warn(found.refused_faults, "faults of unknown kind or out of range; ignored");
  if (!found.other_joints.empty())
  {
    std::cerr << "joint_twin: messages for other joints ignored: " << joined(found.other_joints) << '\n';
  }
  return found;
}

/// The twin beside the recording: copies each original message, and up to its time the simulated ones.
class Replay
{
public:
  Replay(const rosbag::Bag& bag, Twin& twin, const std::vector<TwinInput>& inputs, const ReplayOptions& options)
    : view_(bag), twin_(twin), inputs_(inputs), writer_(options.out), recorder_(twin, options.joint_namespace, writer_)
  {
    // The last input may be stamped after the last message was recorded, but the recording ends there.
    end_ = fromRosTime(view_.getEndTime());
    begin_ = twin.stamp();
  }

  void run()
  {
    Progress progress("replaying");
    for (const rosbag::MessageInstance& message : view_)
    {
      advance(fromRosTime(message.getTime()), progress);
      if (interruptSignal() != 0)
      {
        break;
      }
      writer_.copy(message);
    }
    writer_.close();
  }

  bool isOpen() const { return writer_.isOpen(); }
  void close() { writer_.close(); }

private:
  void advance(Stamp until, Progress& progress)
  {
    feed();
    while (interruptSignal() == 0 && twin_.step(until))
    {
      recorder_.record(twin_);
      progress.update(static_cast<double>(twin_.stamp() - begin_) / static_cast<double>(end_ - begin_));
      feed();
    }
  }

  /// Feeds the messages that are due at the twin's next instant.
  void feed()
  {
    const Stamp instant = twin_.stamp() + twin_.stepLength();
    for (; next_ < inputs_.size() && stampOf(inputs_[next_]) <= instant; ++next_)
    {
      twin_.push(inputs_[next_]);
    }
  }

  rosbag::View view_;
  Twin& twin_;
  const std::vector<TwinInput>& inputs_;
  BagWriter writer_;
  BagRecorder recorder_;
  std::size_t next_{};
  Stamp begin_{};
  Stamp end_{};
};

int replay(const ReplayOptions& options)
{
  const ParameterMap map = replayedMap(options);
  Parameters parameters = parseParameters(map);
  addFaults(options, parameters);
  requireWritable(options.out, options.force, options.bag);
  rosbag::Bag bag;
  openForReading(bag, options.bag);
  refuseTopics(bag, options.bag, outputTopics(options.joint_namespace));
  checkSpan(bag, options.bag);
  const BagInputs found = requireInputs(bag, options, map, parameters);
  Twin twin(parameters, surfaceSource());
  twin.watchSignals(true);
  twin.reset(stampOf(found.inputs.front()));
  const RunSummary summary{ options.out, twin.stamp() };
  const InterruptScope interrupts;
  Replay run(bag, twin, found.inputs, options);
  try
  {
    run.run();
  }
  catch (const std::exception& error)
  {
    if (!run.isOpen())
    {
      throw;  // the output itself
    }
    run.close();
    throw InputError(options.bag + ": replay stopped: " + error.what() + "; " + options.out +
                     " is readable and holds what came before");
  }
  return summary.report(twin, options.json);
}

void declare(OptionTable& table, ReplayOptions& options)
{
  table.add("bag", options.bag, "the recording").required().type("IN.bag");
  table.add("--out", options.out, "the bag with the simulated topics added")
      .required()
      .type("OUT.bag")
      .endsIn({ ".bag" });
  table.flag("--without-command", options.without_command,
             "replay a bag without motor torque: its load torques and faults alone");
  addNamespaceOption(table, options.joint_namespace);
  addFaultOption(table, options);
  addCommonOptions(table, options);
}

const Subcommand REPLAY{ Subject::RECORDING, "replay",
                         "run the twin through a bag; every original message is kept as it is", declare, replay };
}  // namespace
}  // namespace hjt
