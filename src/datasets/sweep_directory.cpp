// SPDX-License-Identifier: BSD-3-Clause
#include "datasets/sweep_directory.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <set>

#include "datasets/file_seal.hpp"
#include "datasets/run_file.hpp"

#include "base/hash.hpp"
#include "base/number_text.hpp"
#include "base/text.hpp"
#include "base/whole_file.hpp"
#include "harmonic_joint_twin/base/errors.hpp"

namespace hjt
{
namespace
{
namespace fs = std::filesystem;
/// Version of the software and hash of its code. A data set that other code made is not extended.
std::string softwareVersion()
{
  return std::string(HJT_VERSION "+") + sourceHash();
}

constexpr const char* FORMAT = "harmonic_joint_twin data set 1";
/// Byte of plan.json that is locked while this file is written. Byte N is locked while run N is simulated.
constexpr std::uint64_t PLAN_LOCK = 1ull << 62;

std::string hexadecimal(std::uint64_t number)
{
  TextStream text;
  text << std::hex << number;
  return text.str();
}

/// Text of a value in a cell of the index: texts are in quotes, and a missing value is empty.
std::string cell(const OrderedJson& value)
{
  if (value.is_null())
  {
    return "";
  }
  if (value.is_number_float())
  {
    return numberText(value.get<double>());
  }
  if (!value.is_string())
  {
    return value.is_array() ? "\"" + value.dump() + "\"" : value.dump();
  }
  std::string text = value.get<std::string>();
  for (std::size_t at = 0; (at = text.find_first_of("\"\n", at)) != std::string::npos; at += 2)
  {
    text.replace(at, 1, text[at] == '"' ? "\"\"" : "; ");
  }
  return "\"" + text + "\"";
}

/// Hash of the parameters of all drives in a run.
std::uint64_t hashOf(const RunSpec& spec)
{
  if (!spec.arm)
  {
    return parametersHash(spec.parameters);
  }
  std::uint64_t hash = textHash("");
  for (const Parameters& drive : spec.arm->drives)
  {
    hash = textHash(hexadecimal(parametersHash(drive)), hash);
  }
  return hash;
}

/// Names of the columns that describe a fault in the index.
std::vector<std::string> faultKeys(const Plan& plan)
{
  std::vector<std::string> keys{ "kind", "severity", "place", "onset", "ramp" };
  if (plan.isOfArms())
  {
    keys.insert(keys.begin(), "joint");
  }
  return keys;
}

/// Row of the index for a run that has no file.
OrderedJson missingRun(std::uint64_t run)
{
  return {
    { "run", run }, { "status", "missing" }, { "faults", OrderedJson::array() }, { "variables", OrderedJson::object() }
  };
}

/// Words for the first part in which the document of a directory differs from that of a plan.
std::string otherThan(const OrderedJson& found, const OrderedJson& wanted)
{
  const std::array<std::pair<const char*, const char*>, 5> parts{ { { "format", "another format" },
                                                                    { "version", "another version of the software" },
                                                                    { "plan", "another plan" },
                                                                    { "tables", "other tables of the plan" },
                                                                    { "configuration", "another configuration" } } };
  for (const auto& [key, what] : parts)
  {
    if (!found.is_object() || found.value(key, OrderedJson()) != wanted.at(key))
    {
      return what;
    }
  }
  return "something else";
}

/// Locks or unlocks one byte of a file; the byte need not exist. @returns false if another process has locked the byte.
/// A file system without locks accepts every lock.
bool lockByte(int file, std::uint64_t place, int command, short kind)
{
  struct flock lock
  {
  };
  lock.l_type = kind;
  lock.l_whence = SEEK_SET;
  lock.l_start = static_cast<off_t>(place);
  lock.l_len = 1;
  return fcntl(file, command, &lock) == 0 || (errno != EAGAIN && errno != EACCES);
}
}  // namespace

SweepDirectory::~SweepDirectory()
{
  if (plan_file_ >= 0)
  {
    close(plan_file_);
  }
}

void SweepDirectory::open()
{
  const std::string name = path_ + "/plan.json";
  std::error_code error;
  fs::create_directories(path_ + "/runs", error);
  if (error)
  {
    throw InputError(path_ + " cannot be made: " + error.message());
  }
  OrderedJson document{ { "format", FORMAT }, { "version", softwareVersion() } };
  document.update(plan_.snapshot());
  const std::string text = document.dump(1) + '\n';
  // Another shard may write the plan and then a run just now. So this function looks for runs before the plan.
  const bool empty = fs::is_empty(path_ + "/runs");
  plan_file_ = ::open(name.c_str(), O_RDWR | O_CLOEXEC | (empty ? O_CREAT : 0), 0666);
  if (plan_file_ < 0)
  {
    throw InputError(errno == ENOENT ? path_ +
                                           "/runs contains other files, and there is no plan.json; give "
                                           "another --out" :
                                       name + " cannot be opened: " + std::strerror(errno));
  }
  lockByte(plan_file_, PLAN_LOCK, F_OFD_SETLKW, F_WRLCK);
  const std::string found = wholeFile(name, MAX_BINARY).value_or("");
  if (found.empty() && fs::exists(index()))
  {
    fs::remove(name, error);
    throw InputError(
        path_ + "/index.csv belongs to something else, because there is no plan.json beside it; give another --out");
  }
  // The file is new, or a process that was killed has left it incomplete.
  if (found.size() < text.size() && text.compare(0, found.size(), found) == 0)
  {
    if (pwrite(plan_file_, text.data(), text.size(), 0) != static_cast<ssize_t>(text.size()) || fsync(plan_file_) != 0)
    {
      throw InputError(name + " cannot be written: " + std::strerror(errno));
    }
  }
  else if (found != text)
  {
    throw InputError(name + " belongs to " + otherThan(OrderedJson::parse(found, nullptr, false), document) +
                     "; give another --out");
  }
  lockByte(plan_file_, PLAN_LOCK, F_OFD_SETLK, F_UNLCK);
}

void SweepDirectory::claim(const std::vector<std::uint64_t>& runs) const
{
  std::set<std::string> names;
  for (const std::uint64_t run : runs)
  {
    if (!lockByte(plan_file_, run, F_OFD_SETLK, F_WRLCK))
    {
      throw InputError(runFile(run) + " is being written by another sweep into " + path_ +
                       "; wait for its end, or give each sweep its own shard");
    }
    names.insert(fs::path(runFileName(run)).filename().string());
  }
  std::vector<fs::path> leftovers;
  for (const fs::directory_entry& entry : fs::directory_iterator(path_ + "/runs"))
  {
    // Incomplete files of makeFileBeside have names RUN.NUMBER.part.
    if (entry.path().extension() == ".part" && names.count(entry.path().stem().stem().string()) > 0)
    {
      leftovers.push_back(entry.path());
    }
  }
  for (const fs::path& leftover : leftovers)
  {
    fs::remove(leftover);
  }
}

bool SweepDirectory::isFinished(std::uint64_t run) const
{
  return record(run).is_object() && isSealed(runFile(run));
}

std::string SweepDirectory::runFileName(std::uint64_t run) const
{
  char number[32];
  std::snprintf(number, sizeof(number), "%09llu", static_cast<unsigned long long>(run));
  return std::string("runs/run_") + number + runFileExtension(plan_.recording().format);
}

std::string SweepDirectory::runFile(std::uint64_t run) const
{
  return path_ + "/" + runFileName(run);
}

OrderedJson SweepDirectory::record(std::uint64_t run) const
{
  OrderedJson found = readRunRecord(plan_.recording().format, runFile(run));
  return found.is_object() && found.value("run", OrderedJson()) == run ? found : OrderedJson();
}

std::uint64_t SweepDirectory::finishedRuns() const
{
  std::uint64_t finished = 0;
  for (const fs::directory_entry& entry : fs::directory_iterator(path_ + "/runs"))
  {
    finished += entry.path().extension() == runFileExtension(plan_.recording().format) ? 1 : 0;
  }
  return finished;
}

std::string SweepDirectory::indexHeader() const
{
  std::string header = "run,file,file_hash,status,class,duty,repeat,duration";
  for (const std::string& key : faultKeys(plan_))
  {
    header += ",fault_" + key;
  }
  header += ",noise_seed,parameters_hash,version,rows_without_forces,error";
  header += plan_.isOfArms() ? std::string(",") + PROTECTIVE_STOP : std::string();
  for (const std::string& name : plan_.variableNames())
  {
    header += "," + name;
  }
  return header;
}

std::string SweepDirectory::indexRow(const OrderedJson& record) const
{
  std::string row = cell(record.at("run"));
  for (const char* key : { "file", FILE_HASH, "status", "class", "duty", "repeat", "duration" })
  {
    row += "," + cell(record.value(key, OrderedJson()));
  }
  for (const std::string& key : faultKeys(plan_))
  {
    const auto text = [&key](const OrderedJson& fault)
    { return fault.at(key).is_string() ? fault.at(key).get<std::string>() : cell(fault.at(key)); };
    row += "," + joined(record.at("faults"), ";", text);
  }
  for (const char* key : { "noise_seed", "parameters_hash", "version", ROWS_WITHOUT_FORCES, "error" })
  {
    row += "," + cell(record.value(key, OrderedJson()));
  }
  if (plan_.isOfArms())
  {
    row += "," + cell(record.value(PROTECTIVE_STOP, OrderedJson()));
  }
  for (const std::string& name : plan_.variableNames())
  {
    row += "," + cell(record.at("variables").value(name, OrderedJson()));
  }
  return row;
}

std::string SweepDirectory::index() const
{
  return path_ + "/index.csv";
}

void SweepDirectory::writeIndex() const
{
  // If another shard finishes a run during the loop, the loop repeats. So the last writer of the index read all runs.
  for (std::uint64_t seen = 0, now = finishedRuns(); seen != now; now = finishedRuns())
  {
    seen = now;
    std::string text = indexHeader() + '\n';
    for (std::uint64_t run = 0; run < plan_.runs(); ++run)
    {
      const OrderedJson found = record(run);
      text += indexRow(found.is_object() ? found : missingRun(run)) + '\n';
    }
    writeTextFile(index(), text);
  }
}

OrderedJson recordOf(const RunSpec& spec, const std::string& file)
{
  OrderedJson variables = OrderedJson::object();
  for (const auto& [name, value] : spec.variables)
  {
    variables[name] = jsonOf(value);
  }
  OrderedJson faults = OrderedJson::array();
  for (const RunFault& growing : spec.faults)
  {
    const Fault& fault = growing.fault;
    OrderedJson json = OrderedJson::object();
    if (spec.arm)
    {
      json["joint"] = spec.arm->arm.joints[growing.joint].short_name;
    }
    json.update({ { "kind", describe(fault.kind).name },
                  { "severity", fault.severity },
                  { "place", fault.place },
                  { "onset", fault.onset },
                  { "ramp", growing.ramp } });
    faults.push_back(json);
  }
  return { { "format", FORMAT },
           { "version", softwareVersion() },
           { "run", spec.run },
           { "file", file },
           { FILE_HASH, OPEN_SEAL },
           { "status", "ok" },
           { "error", "" },
           { "class", spec.fault_class },
           { "duty", spec.duty_name },
           { "repeat", spec.repeat },
           { "duration", spec.duration },
           { "faults", faults },
           { "variables", variables },
           { "noise_seed", spec.parameters.sensors.noise_seed },
           { "parameters_hash", hexadecimal(hashOf(spec)) } };
}
}  // namespace hjt
