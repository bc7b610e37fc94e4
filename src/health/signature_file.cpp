// SPDX-License-Identifier: BSD-3-Clause
#include "health/signature_file.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <map>
#include <mutex>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include <yaml-cpp/yaml.h>

#include "base/number_text.hpp"
#include "base/range.hpp"
#include "base/text.hpp"
#include "base/whole_file.hpp"
#include "harmonic_joint_twin/base/errors.hpp"
#include "params/configuration_files.hpp"

namespace hjt
{
namespace
{
namespace fs = std::filesystem;

constexpr const char* TABLE = "\nsignatures: |\n";  // last key of the file; its rows are read as plain text
constexpr std::size_t ROW_START = 5;                // number of words in a row of the table before the changes

std::size_t lineOf(const YAML::Node& node)
{
  return static_cast<std::size_t>(node.Mark().line) + 1;
}

class SignatureReader
{
public:
  SignatureReader(const std::string& text, const std::string& path) : path_(path)
  {
    const std::size_t table = text.find(TABLE);
    readHeader(text.substr(0, table));
    if (table == std::string::npos)
    {
      fail(0, "the file has no table 'signatures'");
    }
    const std::string above = text.substr(0, table + 1);
    readTable(text.substr(table + std::string(TABLE).size()),
              static_cast<std::size_t>(std::count(above.begin(), above.end(), '\n')) + 2);
  }

  SignatureSet take()
  {
    for (Signature& signature : set_.signatures)
    {
      addOfRobots(signature);
    }
    return std::move(set_);
  }

private:
  /// Throws the error of this file. `line`: line of the error; 0: the error concerns the whole file.
  [[noreturn]] void fail(std::size_t line, const std::string& what) const
  {
    throw ParameterError("indicators.signatures: " + path_ + (line == 0 ? "" : ":" + std::to_string(line)) + ": " +
                         what);
  }

  void readHeader(const std::string& text)
  {
    try
    {
      const YAML::Node file = YAML::Load(text);
      if (!file.IsMap())
      {
        fail(0, "the file has no keys, so it is no file of signatures");
      }
      const YAML::Node format = section(file, "format");
      if (!format.IsScalar() || format.Scalar() != std::to_string(SIGNATURE_FORMAT))
      {
        fail(lineOf(format), "format: " + (format.IsScalar() ? format.Scalar() : "no number") + ", expected " +
                                 std::to_string(SIGNATURE_FORMAT) +
                                 ": another version of the software wrote the file; make the file again with "
                                 "`joint_twin signatures`");
      }
      set_.gear = section(file, "gear").as<std::string>();
      readErrors(section(file, "errors"));
      readIndicators(section(file, "indicators"));
      readSound(section(file, "sound"));
      readCarried(section(file, "carried"));
      readOccurrence(section(file, "occurrence"));
      readOfRobots(file["robots"]);
    }
    catch (const YAML::Exception& error)
    {
      fail(static_cast<std::size_t>(error.mark.line) + 1, error.msg);
    }
  }

  YAML::Node section(const YAML::Node& file, const char* key) const
  {
    const YAML::Node node = file[key];
    if (!node)
    {
      fail(0, std::string(key) + ": missing");
    }
    return node;
  }

  double number(const YAML::Node& node, const std::string& key, const Range& range) const
  {
    const auto before = [&] { return key + ": "; };
    return number(node.IsScalar() ? node.Scalar() : "no number", range, lineOf(node), before);
  }

  /// Number that a word states, within a range. `before`: function that returns the beginning of the error's message.
  template <class Text>
  double number(const std::string& word, const Range& range, std::size_t line, const Text& before) const
  {
    const std::optional<double> value = decimalNumber(word);
    if (!value || !isWithin(*value, range))
    {
      fail(line, before() + word + ", expected " + rangeText(range));
    }
    return *value;
  }

  void readErrors(const YAML::Node& errors)
  {
    for (const SignatureErrorRow& row : SIGNATURE_ERRORS)
    {
      set_.*row.value = number(section(errors, row.key), std::string("errors.") + row.key, { 0.0, 1e3 });
    }
  }

  /// Index, from `first` to `count` - 1, of the value with this name. `kind`: kind of value, for the message.
  template <class NameOf>
  std::size_t named(const std::string& name, const NameOf& name_of, std::size_t first, std::size_t count,
                    const std::string& kind, std::size_t line) const
  {
    std::vector<std::string> known;
    for (std::size_t i = first; i < count; ++i)
    {
      known.emplace_back(name_of(i));
      if (known.back() == name)
      {
        return i;
      }
    }
    fail(line, kind + " " + name + ": no such " + kind + didYouMean(name, known));
  }

  std::size_t indicatorNamed(const YAML::Node& node) const
  {
    return named(node.Scalar(), indicatorName, 0, INDICATOR_COUNT, "indicator", lineOf(node));
  }

  void readIndicators(const YAML::Node& indicators)
  {
    const std::array<std::size_t, SIGNATURE_SIZE> known = indicatorsOfNumbers();
    for (const auto& entry : indicators)
    {
      const std::size_t indicator = indicatorNamed(entry.first);
      const auto found = std::find(known.begin(), known.end(), indicator);
      const std::string key = "indicators." + entry.first.Scalar();
      if (found == known.end())
      {
        fail(lineOf(entry.first), key + ": is the cosine or sine part of a line; signatures have only its amplitude");
      }
      if (entry.second.Scalar() != indicatorUnit(indicator))
      {
        fail(lineOf(entry.second), key + ": unit " + entry.second.Scalar() + ", expected " + indicatorUnit(indicator));
      }
      columns_.push_back(static_cast<std::size_t>(found - known.begin()));
      set_.fitted[columns_.back()] = true;
    }
  }

  void readSound(const YAML::Node& sound)
  {
    for (const auto& entry : sound)
    {
      const std::size_t indicator = indicatorNamed(entry.first);
      if (indicator >= SCALAR_COUNT)
      {
        fail(lineOf(entry.first), "sound." + entry.first.Scalar() + ": is a line; 'sound' has only scalar indicators");
      }
      set_.sound[indicator] = number(entry.second, "sound." + entry.first.Scalar(), { -1e30, 1e30 });
    }
  }

  void readCarried(const YAML::Node& carried)
  {
    for (const auto& entry : carried)
    {
      const std::string key = "carried." + entry.first.Scalar();
      CarriedError& error = set_.carried[indicatorNamed(entry.first)];
      if (!entry.second.IsSequence() || entry.second.size() != 3)
      {
        fail(lineOf(entry.first), key + ": expected [deviation, share, degrees of freedom]");
      }
      error.deviation = number(entry.second[0], key, { 0.0, 1e30 });
      error.share = number(entry.second[1], key, { 0.0, 1e30 });
      error.freedom = number(entry.second[2], key, { 1.0, 1e9 });
    }
  }

  void readOccurrence(const YAML::Node& occurrence)
  {
    for (const auto& entry : occurrence)
    {
      const Cause cause = causeNamed(entry.first.Scalar(), lineOf(entry.first));
      set_.occurrence[static_cast<std::size_t>(cause)] =
          number(entry.second, "occurrence." + entry.first.Scalar(), { 1.0, 10.0 });
    }
  }

  void readOfRobots(const YAML::Node& robots)
  {
    for (const YAML::Node& row : robots)
    {
      if (!row.IsSequence() || row.size() != 2 + ROBOT_NUMBERS)
      {
        fail(lineOf(row), "robots: expected [cause, severity and " + std::to_string(ROBOT_NUMBERS) + " shares]");
      }
      RobotSignature signature{ causeNamed(row[0].Scalar(), lineOf(row)), number(row[1], "robots", { 0.0, 1.0 }), {} };
      for (std::size_t i = 0; i < ROBOT_NUMBERS; ++i)
      {
        signature.share[i] = number(row[2 + i], "robots", { -1e3, 1e3 });
      }
      set_.of_robots.push_back(signature);
      std::fill_n(set_.fitted.begin() + FIRST_OF_ROBOT, ROBOT_NUMBERS, true);
    }
  }

  /// Adds the changes of SignatureSet::of_robots to a signature, interpolated linearly over the severity from 0 on.
  void addOfRobots(Signature& signature) const
  {
    RobotSignature before{};
    for (const RobotSignature& after : set_.of_robots)
    {
      if (after.cause != signature.cause)
      {
        continue;
      }
      if (signature.severity > before.severity)
      {
        const double share = std::min((signature.severity - before.severity) / (after.severity - before.severity), 1.0);
        for (std::size_t i = 0; i < ROBOT_NUMBERS; ++i)
        {
          signature.change[FIRST_OF_ROBOT + i] = before.share[i] + share * (after.share[i] - before.share[i]);
        }
      }
      before = after;
    }
  }

  void readTable(const std::string& table, std::size_t first_line)
  {
    std::istringstream rows(table);
    std::string row;
    for (std::size_t line = first_line; std::getline(rows, row); ++line)
    {
      std::istringstream blanks(row);
      const std::vector<std::string> words{ std::istream_iterator<std::string>(blanks), {} };
      if (!words.empty())
      {
        readRow(words, line);
      }
    }
  }

  void readRow(const std::vector<std::string>& words, std::size_t line)
  {
    if (words.size() != ROW_START + columns_.size())
    {
      fail(line, "signatures: " + std::to_string(words.size()) + " words, expected " +
                     std::to_string(ROW_START + columns_.size()) +
                     ": cause, motion, speed, direction, severity and a number for each of 'indicators'");
    }
    Signature signature{};
    signature.cause = causeNamed(words[0], line);
    signature.motion.speed = rowNumber(words[2], "speed [rad/s]", { 0.0, 1e5 }, line);
    signature.motion.direction = rowNumber(words[3], "direction [-]", { 0.0, 1.0 }, line);
    signature.severity = rowNumber(words[4], "severity [-]", { 0.0, 1.0 }, line);
    for (std::size_t i = 0; i < columns_.size(); ++i)
    {
      signature.change[columns_[i]] = rowNumber(words[ROW_START + i], "change", { -1e30, 1e30 }, line);
    }
    set_.signatures.push_back(signature);
  }

  double rowNumber(const std::string& word, const char* key, const Range& range, std::size_t line) const
  {
    return number(word, range, line, [&] { return std::string("signatures: ") + key + " = "; });
  }

  Cause causeNamed(const std::string& name, std::size_t line) const
  {
    const auto name_of = [](std::size_t cause) { return causeName(static_cast<Cause>(cause)); };
    constexpr auto FIRST = static_cast<std::size_t>(Cause::FIRST_FAULT);
    return static_cast<Cause>(named(name, name_of, FIRST, CAUSE_COUNT, "cause", line));
  }

  const std::string path_;
  SignatureSet set_;
  std::vector<std::size_t> columns_;  // for each column of the table, index in the signature
};

std::string readText(const std::string& path)
{
  std::string reason;
  std::optional<std::string> text = wholeFile(path, MAX_TEXT, &reason);
  if (!text)
  {
    throw ParameterError("indicators.signatures = '" + path + "': cannot be read: " + reason +
                         "; give a file of signatures or " + NO_FILE);
  }
  return std::move(*text);
}

/// Adds a signature between every two successive severities, at their geometric mean, by linear interpolation. Without
/// the added signatures, an estimated severity would stay at one of the severities of the runs.
SignatureSet withSeveritiesBetween(SignatureSet set)
{
  const std::vector<Signature> known = std::move(set.signatures);
  set.signatures.clear();
  set.signatures.reserve(2 * known.size());
  for (std::size_t i = 0; i < known.size(); ++i)
  {
    set.signatures.push_back(known[i]);
    const bool follows = i + 1 < known.size() && known[i + 1].cause == known[i].cause &&
                         known[i + 1].motion.speed == known[i].motion.speed &&
                         known[i + 1].motion.direction == known[i].motion.direction;
    if (follows && known[i].severity > 0.0 && known[i + 1].severity > known[i].severity)
    {
      Signature between = known[i];
      between.severity = std::sqrt(known[i].severity * known[i + 1].severity);
      const double share = (between.severity - known[i].severity) / (known[i + 1].severity - known[i].severity);
      for (std::size_t k = 0; k < SIGNATURE_SIZE; ++k)
      {
        between.change[k] += share * (known[i + 1].change[k] - known[i].change[k]);
      }
      set.signatures.push_back(between);
    }
  }
  return set;
}
}  // namespace

std::array<std::size_t, SIGNATURE_SIZE> indicatorsOfNumbers()
{
  std::array<std::size_t, SIGNATURE_SIZE> indicators{};
  for (std::size_t i = 0; i < SCALAR_COUNT; ++i)
  {
    indicators[i] = i;
  }
  for (const LineSignal signal : ALL_LINE_SIGNALS)
  {
    for (std::size_t line = 0; line < LINE_COUNT && hasLine(signal, line); ++line)
    {
      indicators[signatureNumber(signal, line)] = amplitudeIndex(signal, line);
    }
  }
  return indicators;
}

SignatureSet parseSignatures(const std::string& text, const std::string& path)
{
  return SignatureReader(text, path).take();
}

std::shared_ptr<const SignatureSet> loadSignatures(const std::string& name)
{
  static std::mutex mutex;
  static std::map<std::pair<std::string, fs::file_time_type>, std::shared_ptr<const SignatureSet>> known;
  const std::string path =
      name == NO_FILE || fs::path(name).is_absolute() ? name : findConfiguration(name, configurationDirectory(""));
  std::error_code error;
  const fs::file_time_type written = name == NO_FILE ? fs::file_time_type{} : fs::last_write_time(path, error);
  const std::lock_guard<std::mutex> lock(mutex);
  std::shared_ptr<const SignatureSet>& set = known[{ path, written }];
  if (!set)
  {
    set = std::make_shared<SignatureSet>(
        name == NO_FILE ? SignatureSet{} : withSeveritiesBetween(parseSignatures(readText(path), path)));
  }
  return set;
}

namespace
{
constexpr const char* KINEMATICS = " kinematics ";  // name of the motion in rows that are calculated without runs
constexpr const char* HEAD = R"(# SPDX-License-Identifier: BSD-3-Clause
# Changes of the health indicators of a gear by faults, computed with runs of the twin
# (docs/indicators.md, "Signatures").
# Written by `joint_twin signatures`.
format: )";
constexpr const char* ERRORS = R"(
# Constants of the likelihood in docs/indicators.md [-]. number, motion: relative error of a change, additional error in
# unlike motions. line: share of a sound line that a fault changes. weight, misfit: factor on the evidence, least share
# of this factor. severity, severity_misfit: relative error of the severity, additional error if no signature fits.
errors:
)";
constexpr const char* INDICATORS = R"(
# Indicators in the columns of 'signatures', in their order, with their units.
indicators:
)";
constexpr const char* SOUND = R"(
# Values of the indicators of the sound drive in the first motion, in these units.
sound:
)";
constexpr const char* CARRIED = R"(
# How an indicator of a sound drive minus a model's differs between two motions: [rms in the indicator's unit,
# additional rms over |drive - model|, degrees of freedom]. For indicators that are missing here this is not known.
carried:
)";
constexpr const char* OCCURRENCE = R"(
# How often a cause occurs, 1 ... 10 [-]: FMECA of C. Costantino, Politecnico di Torino, 2021, Table 3.7. Causes
# that are missing here are not rated.
occurrence:
)";
constexpr const char* ROBOTS = R"(
# Changes of friction by load and lag of a robot in closed loop, for any gear in any motion: [cause, severity, then, as
# shares of the sound values, load_friction, lag_ripple, lag_order_1, _2, _4]. Source: `lab/run faults_seen --fit`.
robots:
)";
constexpr const char* SIGNATURES = R"(
# A row each: cause, motion, magnitudes of the motor's speed [rad/s] and of the share of travel forward minus that back
# [-] (0 0: any motion), severity [-], then the change of each indicator. Changes of stiffness, lost motion and loop,
# and of friction by thicker grease, are shares of the sound value [-].
signatures: |
)";

/// Text of a number with the shortest exponent, for example -2.44e-5 for -2.44e-05.
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
    throw ParameterError(path + ": the indicators of this file differ from those of the signatures to add");
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
