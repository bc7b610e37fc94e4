// SPDX-License-Identifier: BSD-3-Clause
#include "datasets/variable.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include <boost/random/normal_distribution.hpp>
#include <boost/random/uniform_int_distribution.hpp>
#include <boost/random/uniform_real_distribution.hpp>

#include "datasets/plan_values.hpp"

#include "base/number_text.hpp"
#include "base/philox.hpp"
#include "base/text_hash.hpp"

namespace hjt
{
namespace
{
PhiloxStream wordsOf(std::uint32_t seed, const std::string& name, std::uint64_t run)
{
  const std::uint64_t hash = textHash(name);
  return PhiloxStream({ static_cast<std::uint32_t>(run), static_cast<std::uint32_t>(run >> 32), 0 },
                      { seed ^ static_cast<std::uint32_t>(hash), static_cast<std::uint32_t>(hash >> 32) });
}

constexpr double MIN_SHARE = 1e-3;  // least share of a normal distribution within its limits: others are redrawn
constexpr double MAX_WHOLE = 1e15;  // which a double holds exactly

/// Of a normal distribution {mean, standard deviation, lowest, highest}, what lies between its limits.
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
        list.refuse("must leave at least " + numberText(MIN_SHARE) +
                    " of the distribution between lowest and highest; for one value, write it");
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
      element.refuse("must be a plain value");
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
