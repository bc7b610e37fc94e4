// SPDX-License-Identifier: BSD-3-Clause
#include "datasets/plan_values.hpp"

#include <algorithm>
#include <cmath>

#include <yaml-cpp/yaml.h>
#include <boost/random/normal_distribution.hpp>
#include <boost/random/uniform_int_distribution.hpp>
#include <boost/random/uniform_real_distribution.hpp>

#include "base/hash.hpp"
#include "base/number_text.hpp"
#include "base/philox.hpp"
#include "base/text.hpp"
#include "harmonic_joint_twin/base/errors.hpp"

namespace hjt
{
namespace
{
// An alias in YAML can refer to itself, or multiply copies of other nodes. Therefore depth and size are limited.
constexpr int DEEPEST = 32;
constexpr std::size_t MAX_NODES = 100'000;

PlanNode convert(const YAML::Node& from, const std::string& file, const std::string& path, int depth,
                 std::size_t& nodes)
{
  PlanNode node;
  node.path = path;
  node.origin = file + ":" + std::to_string(from.Mark().line + 1);
  if (depth > DEEPEST || ++nodes > MAX_NODES)
  {
    node.refuse("makes the plan too large; allowed are at most " + std::to_string(DEEPEST) + " levels and " +
                std::to_string(MAX_NODES) + " values, where each alias counts");
  }
  const auto below = [&](const YAML::Node& entry, const std::string& key)
  { return convert(entry, file, path.empty() ? key : path + "." + key, depth + 1, nodes); };
  if (from.IsScalar())
  {
    node.kind = PlanNode::Kind::SCALAR;
    node.scalar = parseScalar(from.Scalar(), from.Tag() == "!", path, node.origin);
  }
  else if (from.IsSequence())
  {
    node.kind = PlanNode::Kind::LIST;
    for (const YAML::Node& element : from)
    {
      const std::string key = std::to_string(node.entries.size());
      node.entries.emplace_back(key, below(element, key));
    }
  }
  else if (from.IsMap())
  {
    node.kind = PlanNode::Kind::MAP;
    for (const auto& entry : from)
    {
      const std::string key = entry.first.as<std::string>();
      if (node.find(key) != nullptr)
      {
        node.find(key)->refuse("occurs twice");
      }
      node.entries.emplace_back(key, below(entry.second, key));
    }
  }
  else
  {
    node.refuse("has no value");
  }
  return node;
}
}  // namespace

const PlanNode* PlanNode::find(std::string_view key) const
{
  const auto found =
      std::find_if(entries.begin(), entries.end(), [&](const Entry& entry) { return entry.first == key; });
  return found == entries.end() ? nullptr : &found->second;
}

void PlanNode::refuse(const std::string& what) const
{
  const std::string value = kind == Kind::SCALAR ? " = " + valueText(scalar) : "";
  throw InputError(origin + ": " + (path.empty() ? "the plan" : path + value) + " " + what);
}

std::optional<double> numberIn(const ParameterValue& value)
{
  if (const auto* whole = std::get_if<std::int64_t>(&value.value))
  {
    return static_cast<double>(*whole);
  }
  const auto* number = std::get_if<double>(&value.value);
  return number != nullptr ? std::optional<double>(*number) : std::nullopt;
}

OrderedJson jsonOf(const ParameterValue& value)
{
  return std::visit([](const auto& content) { return OrderedJson(content); }, value.value);
}

OrderedJson jsonOf(const PlanNode& node)
{
  if (node.kind == PlanNode::Kind::SCALAR)
  {
    return jsonOf(node.scalar);
  }
  OrderedJson json = node.kind == PlanNode::Kind::MAP ? OrderedJson::object() : OrderedJson::array();
  for (const auto& [key, below] : node.entries)
  {
    if (node.kind == PlanNode::Kind::MAP)
    {
      json[key] = jsonOf(below);
    }
    else
    {
      json.push_back(jsonOf(below));
    }
  }
  return json;
}

PlanNode readPlanFile(const std::string& path)
{
  try
  {
    std::size_t nodes = 0;
    const PlanNode root = convert(YAML::LoadFile(path), path, "", 0, nodes);
    if (root.kind != PlanNode::Kind::MAP)
    {
      root.refuse("must be a mapping of keys to values");
    }
    return root;
  }
  catch (const YAML::BadFile&)
  {
    throw InputError(path + " cannot be read");
  }
  catch (const YAML::Exception& error)
  {
    throw InputError(path + ":" + std::to_string(error.mark.line + 1) + ": " + error.msg);
  }
}

namespace
{
[[noreturn]] void refuse(const PlanNode& node, const ParameterValue& value, const std::string& what)
{
  throw InputError(node.origin + ": " + node.path + " = " + valueText(value) + " " + what);
}

template <class T>
const T& contentOf(const PlanNode& node, const ParameterValue& value, const std::string& kind)
{
  const T* content = std::get_if<T>(&value.value);
  if (content == nullptr)
  {
    refuse(node, value, "must be " + kind);
  }
  return *content;
}

const char* kindName(PlanNode::Kind kind)
{
  return kind == PlanNode::Kind::SCALAR ? "a value" : kind == PlanNode::Kind::LIST ? "a list" : "a mapping";
}
}  // namespace

ParameterValue PlanValues::value(const PlanNode& node) const
{
  const auto drawn = drawn_.find(&node);
  if (drawn != drawn_.end())
  {
    return drawn->second;
  }
  if (node.kind == PlanNode::Kind::SCALAR)
  {
    return node.scalar;
  }
  if (node.kind == PlanNode::Kind::MAP)
  {
    node.refuse("must be a value or one of grid, uniform, log_uniform, normal, integer, choice");
  }
  std::vector<double> numbers;
  for (const auto& [key, element] : node.entries)
  {
    const std::optional<double> number = numberIn(value(element));
    if (!number)
    {
      element.refuse("must be a number");
    }
    numbers.push_back(*number);
  }
  return { numbers, node.origin };
}

double PlanValues::number(const PlanNode& map, const std::string& key, const char* unit, const Range& range,
                          std::optional<double> otherwise) const
{
  if (otherwise && map.find(key) == nullptr)
  {
    return *otherwise;
  }
  const PlanNode& node = required(map, key);
  const ParameterValue found = value(node);
  const std::string with_unit = "[" + std::string(unit) + "]";
  const std::optional<double> number = numberIn(found);
  if (!number)
  {
    refuse(node, found, "must be a number " + with_unit + ", " + rangeText(range));
  }
  // The negated comparison also rejects NaN.
  if (!(*number >= range.min && *number <= range.max))
  {
    refuse(node, found, with_unit + " is out of range, allowed: " + rangeText(range) + " " + with_unit);
  }
  return *number;
}

std::int64_t PlanValues::whole(const PlanNode& map, const std::string& key, const char* unit, const Range& range,
                               std::optional<std::int64_t> otherwise) const
{
  if (otherwise && map.find(key) == nullptr)
  {
    return *otherwise;
  }
  const PlanNode& node = required(map, key);
  number(map, key, unit, range);
  return contentOf<std::int64_t>(node, value(node), "a whole number [" + std::string(unit) + "], " + rangeText(range));
}

std::string PlanValues::text(const PlanNode& map, const std::string& key,
                             const std::optional<std::string>& otherwise) const
{
  if (otherwise && map.find(key) == nullptr)
  {
    return *otherwise;
  }
  const PlanNode& node = required(map, key);
  const std::string text = contentOf<std::string>(node, value(node), "a text");
  if (text.empty())
  {
    node.refuse("must be a text");
  }
  return text;
}

bool PlanValues::flag(const PlanNode& map, const std::string& key) const
{
  const PlanNode* node = map.find(key);
  return node != nullptr && contentOf<bool>(*node, value(*node), "true or false");
}

const PlanNode& required(const PlanNode& map, std::string_view key)
{
  const PlanNode* node = map.find(key);
  if (node == nullptr)
  {
    map.refuse("needs the key '" + std::string(key) + "'");
  }
  return *node;
}

const PlanNode& required(const PlanNode& map, std::string_view key, PlanNode::Kind kind)
{
  const PlanNode& node = required(map, key);
  if (node.kind != kind)
  {
    node.refuse(std::string("must be ") + kindName(kind));
  }
  return node;
}

void allowOnly(const PlanNode& map, const std::vector<std::string>& keys)
{
  if (map.kind != PlanNode::Kind::MAP)
  {
    map.refuse("must be a mapping with some of these keys: " + joined(keys));
  }
  for (const auto& [key, node] : map.entries)
  {
    if (std::find(keys.begin(), keys.end(), key) == keys.end())
    {
      node.refuse("is unknown; allowed: " + joined(keys));
    }
  }
}

namespace
{
PhiloxStream wordsOf(std::uint32_t seed, const std::string& name, std::uint64_t run)
{
  const std::uint64_t hash = textHash(name);
  return PhiloxStream({ static_cast<std::uint32_t>(run), static_cast<std::uint32_t>(run >> 32), 0 },
                      { seed ^ static_cast<std::uint32_t>(hash), static_cast<std::uint32_t>(hash >> 32) });
}

// Least probability that a drawn normal value is within its limits [-]. Values outside of the limits are drawn again.
constexpr double MIN_SHARE = 1e-3;
constexpr double MAX_WHOLE = 1e15;  // largest whole number that a double represents exactly

/// Probability that a normal distribution {mean, standard deviation, lowest, highest} gives a value within its limits.
double shareWithin(const std::array<double, 4>& normal)
{
  const auto [mean, deviation, lowest, highest] = normal;
  if (deviation == 0.0)
  {
    return 1.0;
  }
  const double scale = deviation * std::sqrt(2.0);
  return 0.5 * (std::erf((highest - mean) / scale) - std::erf((lowest - mean) / scale));
}

double numberOf(const PlanNode& node)
{
  const auto number = node.kind == PlanNode::Kind::SCALAR ? numberIn(node.scalar) : std::nullopt;
  if (number && std::isfinite(*number))
  {
    return *number;
  }
  node.refuse("must be a finite number");
}
}  // namespace

bool Variable::stands(const PlanNode& node)
{
  if (node.kind != PlanNode::Kind::MAP || node.entries.size() != 1)
  {
    return false;
  }
  const std::string& key = node.entries.front().first;
  return key == "grid" || key == "uniform" || key == "log_uniform" || key == "normal" || key == "integer" ||
         key == "choice";
}

Variable::Variable(const PlanNode& node) : node_(&node)
{
  static const std::map<std::string, Distribution> NAMES{ { "grid", Distribution::GRID },
                                                          { "uniform", Distribution::UNIFORM },
                                                          { "log_uniform", Distribution::LOG_UNIFORM },
                                                          { "normal", Distribution::NORMAL },
                                                          { "integer", Distribution::INTEGER },
                                                          { "choice", Distribution::CHOICE } };
  const auto& [name, list] = node.entries.front();
  distribution_ = NAMES.at(name);
  switch (distribution_)
  {
    case Distribution::GRID:
    case Distribution::CHOICE:
      readChoices(list);
      break;
    case Distribution::NORMAL:
      readNumbers(list, 4);
      if (numbers_[1] < 0.0 || numbers_[2] > numbers_[0] || numbers_[3] < numbers_[0])
      {
        list.refuse("must be [mean, standard deviation >= 0, lowest <= mean, highest >= mean]");
      }
      if (shareWithin(numbers_) < MIN_SHARE)
      {
        list.refuse("must contain at least " + numberText(MIN_SHARE) +
                    " of the distribution between lowest and highest; for a constant value, write a number");
      }
      break;
    default:
      readNumbers(list, 2);
      if (numbers_[0] >= numbers_[1] || !std::isfinite(numbers_[1] - numbers_[0]))
      {
        list.refuse("must be [lowest, highest], the second larger than the first");
      }
  }
  if (distribution_ == Distribution::LOG_UNIFORM && numbers_[0] <= 0.0)
  {
    list.refuse("must be [lowest, highest], both above zero");
  }
  if (distribution_ == Distribution::INTEGER &&
      (std::floor(numbers_[0]) != numbers_[0] || std::floor(numbers_[1]) != numbers_[1] ||
       std::max(-numbers_[0], numbers_[1]) > MAX_WHOLE))
  {
    list.refuse("must be two whole numbers, -" + numberText(MAX_WHOLE) + " ... " + numberText(MAX_WHOLE));
  }
}

void Variable::readNumbers(const PlanNode& list, std::size_t count)
{
  if (list.kind != PlanNode::Kind::LIST || list.entries.size() != count)
  {
    list.refuse("must be a list of " + std::to_string(count) + " numbers");
  }
  for (std::size_t i = 0; i < count; ++i)
  {
    numbers_[i] = numberOf(list.entries[i].second);
  }
}

void Variable::readChoices(const PlanNode& list)
{
  if (list.kind != PlanNode::Kind::LIST || list.entries.empty())
  {
    list.refuse("must be a list of values");
  }
  for (const auto& [key, element] : list.entries)
  {
    if (element.kind != PlanNode::Kind::SCALAR)
    {
      element.refuse("must be a value, not a list or mapping");
    }
    choices_.push_back(element.scalar);
  }
}

ParameterValue Variable::value(std::uint32_t seed, std::uint64_t run, std::size_t digit) const
{
  PhiloxStream words = wordsOf(seed, node_->path, run);
  const auto [a, b, lowest, highest] = numbers_;
  switch (distribution_)
  {
    case Distribution::GRID:
      return choices_[digit];
    case Distribution::UNIFORM:
      return { boost::random::uniform_real_distribution<double>(a, b)(words), node_->origin };
    case Distribution::LOG_UNIFORM:
      return { std::exp(boost::random::uniform_real_distribution<double>(std::log(a), std::log(b))(words)),
               node_->origin };
    case Distribution::NORMAL:
    {
      boost::random::normal_distribution<double> normal(a, b);
      double drawn = a;
      do
      {
        drawn = normal(words);
      } while (drawn < lowest || drawn > highest);
      return { drawn, node_->origin };
    }
    case Distribution::INTEGER:
      return { boost::random::uniform_int_distribution<std::int64_t>(static_cast<std::int64_t>(a),
                                                                     static_cast<std::int64_t>(b))(words),
               node_->origin };
    case Distribution::CHOICE:
      return choices_[boost::random::uniform_int_distribution<std::size_t>(0, choices_.size() - 1)(words)];
  }
  return {};
}

std::uint32_t drawnWord(std::uint32_t seed, const std::string& name, std::uint64_t run)
{
  return wordsOf(seed, name, run)();
}

std::vector<std::string> textsOf(const PlanNode& map, const std::string& key)
{
  const PlanNode& node = required(map, key);
  if (!Variable::stands(node))
  {
    return { PlanValues().text(map, key) };
  }
  std::vector<std::string> texts;
  const PlanNode& list = node.entries.front().second;
  for (const auto& [number, element] : list.entries)
  {
    texts.push_back(PlanValues().text(list, number));
  }
  return texts;
}
}  // namespace hjt
