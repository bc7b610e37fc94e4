// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <iterator>
#include <optional>
#include <string>

#include "apps/common/configuration.hpp"
#include "output/output_file.hpp"
#include "output/process_end.hpp"
#include "output/progress.hpp"
#include "output/report.hpp"

#include <sensor_msgs/JointState.h>
#include <sensor_msgs/Temperature.h>

#include "bags/bag_writer.hpp"
#include "base/csv_table.hpp"
#include "gear/ratio.hpp"
#include "messages/conversions.hpp"
#include "messages/topics.hpp"

namespace hjt
{
namespace
{
constexpr int JOINTS = 6;
constexpr const char* TELEMETRY_TOPIC = "/joint_states";
constexpr Stamp TEMPERATURE_PERIOD = 1'000'000'000;  // time between two messages of temperatures [ns]
/// Gain of a UR5's large joints, measured at rest [N.m/A].
constexpr double DEFAULT_GAIN = 10.7;

struct ImportOptions : CommonOptions
{
  std::string csv;
  std::string joint;
  std::string out;
  double gain{ DEFAULT_GAIN };
  std::optional<double> ratio;
  double start_time{ static_cast<double>(SIMULATION_EPOCH) / 1e9 };
  std::string joint_namespace{ DEFAULT_NAMESPACE };
};

/// Columns of a UR controller's real-time interface that follow the timestamp. Each joint has
/// a column of each quantity. The temperature may be missing.
constexpr std::array<const char*, 5> QUANTITIES{ "actual_q", "actual_qd", "actual_current", "target_moment",
                                                 "joint_temperatures" };
enum Quantity
{
  POSITION,
  VELOCITY,
  CURRENT,
  MOMENT,
  TEMPERATURE
};
constexpr std::size_t ROW_COLUMNS = 1 + QUANTITIES.size() * JOINTS;
using Row = std::array<double, ROW_COLUMNS>;

constexpr std::size_t column(Quantity quantity, int joint)
{
  return 1 + static_cast<std::size_t>(quantity) * JOINTS + static_cast<std::size_t>(joint);
}

NumberTable<ROW_COLUMNS>::Names columnNames()
{
  NumberTable<ROW_COLUMNS>::Names names;
  names[0] = "timestamp";
  for (const Quantity quantity : { POSITION, VELOCITY, CURRENT, MOMENT, TEMPERATURE })
  {
    for (int joint = 0; joint < JOINTS; ++joint)
    {
      names[column(quantity, joint)] = std::string(QUANTITIES[quantity]) + "_" + std::to_string(joint);
    }
  }
  return names;
}

/// Converts rows to messages: telemetry and temperatures of all joints, and motor torque and load of one joint.
class RowWriter
{
public:
  RowWriter(const ImportOptions& options, const UrJoint& joint, double ratio, BagWriter& bag)
    : bag_(bag)
    , joint_(joint.number)
    , torque_per_current_(options.gain / ratio)
    , start_(static_cast<Stamp>(std::llround(options.start_time * 1e9)))
    , prefix_(options.joint_namespace + "/")
  {
    std::vector<std::string> names;
    for (int i = 0; i < JOINTS; ++i)
    {
      names.push_back(findUrJoint(std::to_string(i))->name);
    }
    telemetry_ = jointStatesOf(names);
    command_.name = { joint.name };
    command_.effort.resize(1);
    load_ = command_;
  }

  void write(const Row& row, const std::array<bool, JOINTS>& temperatures)
  {
    const Stamp stamp = start_ + static_cast<Stamp>(std::llround(row[0] * 1e9));
    for (int joint = 0; joint < JOINTS; ++joint)
    {
      const auto i = static_cast<std::size_t>(joint);
      telemetry_.position[i] = row[column(POSITION, joint)];
      telemetry_.velocity[i] = row[column(VELOCITY, joint)];
      telemetry_.effort[i] = row[column(CURRENT, joint)];  // current [A], which the driver of a UR publishes as effort
    }
    command_.effort[0] = row[column(CURRENT, joint_)] * torque_per_current_;
    load_.effort[0] = row[column(MOMENT, joint_)];
    writeTemperatures(row, temperatures, stamp);
    writeStamped(TELEMETRY_TOPIC, stamp, telemetry_);
    writeStamped(prefix_ + topics::COMMAND, stamp, command_);
    writeStamped(prefix_ + topics::LOAD, stamp, load_);
  }

private:
  void writeTemperatures(const Row& row, const std::array<bool, JOINTS>& temperatures, Stamp stamp)
  {
    if (stamp < next_temperatures_)
    {
      return;
    }
    next_temperatures_ = stamp + TEMPERATURE_PERIOD;
    for (int joint = 0; joint < JOINTS; ++joint)
    {
      const auto i = static_cast<std::size_t>(joint);
      if (temperatures[i])
      {
        temperature_.header.frame_id = telemetry_.name[i];
        temperature_.temperature = row[column(TEMPERATURE, joint)];
        writeStamped(std::string("/") + topics::JOINT_TEMPERATURES, stamp, temperature_);
      }
    }
  }

  template <class Message>
  void writeStamped(const std::string& topic, Stamp stamp, Message& message)
  {
    message.header.stamp = toRosTime(stamp);
    bag_.write(topic, stamp, message);
  }

  BagWriter& bag_;
  int joint_;
  double torque_per_current_;
  Stamp start_;
  std::string prefix_;
  Stamp next_temperatures_{};  // stamp of the next temperatures [ns]
  sensor_msgs::Temperature temperature_;
  sensor_msgs::JointState telemetry_;
  sensor_msgs::JointState command_;
  sensor_msgs::JointState load_;
};

double countLines(const std::string& path)
{
  std::ifstream file(path, std::ios::binary);
  return static_cast<double>(std::count(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>(), '\n'));
}

/// Writes all rows to the bag. @returns the number of rows. After an error the bag is readable, with the rows so far.
std::uint64_t importRows(const ImportOptions& options, const UrJoint& joint, double ratio,
                         NumberTable<ROW_COLUMNS>& table, BagWriter& bag)
{
  RowWriter writer(options, joint, ratio, bag);
  Progress progress("importing");
  const double lines = countLines(options.csv);
  Row row{};
  std::uint64_t rows = 0;
  std::array<bool, JOINTS> temperatures{};
  for (int i = 0; i < JOINTS; ++i)
  {
    temperatures[static_cast<std::size_t>(i)] = table.hasColumn(column(TEMPERATURE, i));
  }
  try
  {
    for (double last = -HUGE_VAL; interruptSignal() == 0 && table.read(row); last = row[0])
    {
      if (row[0] <= last)
      {
        throw InputError(table.place() + ": time goes back: timestamp " + shortNumber(row[0]) + " s after " +
                         shortNumber(last) + " s");
      }
      if (options.start_time + row[0] < 1e-9)
      {
        throw InputError(table.place() + ": timestamp " + shortNumber(row[0]) + " s is before the ROS epoch");
      }
      writer.write(row, temperatures);
      ++rows;
      progress.update(static_cast<double>(rows) / lines);
    }
  }
  catch (const InputError& error)
  {
    if (!bag.isOpen())
    {
      throw;  // the program could not write the output
    }
    bag.close();
    throw InputError(std::string(error.what()) + (rows == 0 ? "; nothing was written" :
                                                              "; " + options.out + " is readable and contains the " +
                                                                  std::to_string(rows) + " rows before the error"));
  }
  bag.close();
  return rows;
}

int import(const ImportOptions& options)
{
  const Parameters parameters = loadParameters(options);
  const UrJoint joint = *findUrJoint(options.joint);
  const double ratio = options.ratio.value_or(nominalRatio(parameters.gear));
  requireWritable(options.out, options.force, options.csv);
  NumberTable<ROW_COLUMNS> table(options.csv, columnNames(), JOINTS, JOINTS);
  const InterruptScope interrupts;
  BagWriter bag(options.out);
  const std::uint64_t rows = importRows(options, joint, ratio, table, bag);
  if (rows == 0 && interruptSignal() == 0)
  {
    throw InputError(options.csv + " has no rows; nothing was written");
  }
  printReport(options.json, { { "output", "", options.out },
                              { "joint", "joint", joint.name },
                              { "rows", "rows", rows },
                              { "messages", "", bag.messages() } });
  return reportWritten(options.out, options.json);
}

void declare(OptionTable& table, ImportOptions& options)
{
  table.add("csv", options.csv, "the recording").required().type("FILE.csv");
  table.add("--joint", options.joint, "joint: base, shoulder, elbow, wrist_1 ..., or its number from 0")
      .required()
      .check(
          [](const std::string& name)
          {
            return findUrJoint(name) ? std::string() :
                                       "'" + name +
                                           "' is not a joint; the joints are base, shoulder, elbow, wrist_1, wrist_2, "
                                           "wrist_3, or 0 to 5";
          });
  table.add("--out", options.out, "file for the bag").required().type("FILE.bag").endsIn({ ".bag" });
  table.add("--gain", options.gain, "torque at the joint per ampere of motor current [N.m/A]");
  table.add("--ratio", options.ratio, "ratio of the recorded gear [-]; default: that of the configured gear")
      .positive();
  table.add("--start-time", options.start_time, "ROS time that timestamp 0 gets [s]").range(0.0, 4e9);
  addNamespaceOption(table, options.joint_namespace);
  addCommonOptions(table, options);
}

const Subcommand IMPORT{ Subject::RECORDING, "import",
                         "convert a UR controller's CSV recording (columns timestamp, actual_q_N, actual_qd_N, "
                         "actual_current_N, target_moment_N) to a bag for replay",
                         declare, import };
}  // namespace
}  // namespace hjt
