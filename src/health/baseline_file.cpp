// SPDX-License-Identifier: BSD-3-Clause
#include "health/baseline_file.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <vector>

#include <yaml-cpp/yaml.h>

#include "base/number_text.hpp"
#include "base/whole_file.hpp"
#include "harmonic_joint_twin/base/errors.hpp"
#include "health/reference_fit.hpp"

namespace hjt
{
namespace
{
constexpr int FORMAT = 4;       // changes if the meaning or the stored numbers of the indicators change
constexpr int OWN_NUMBERS = 6;  // count of an indicator's numbers before those of the regression

std::size_t indicatorNamed(const std::string& name)
{
  for (std::size_t i = 0; i < INDICATOR_COUNT; ++i)
  {
    if (name == indicatorName(i))
    {
      return i;
    }
  }
  throw InputError("unknown indicator " + name);
}

template <std::size_t N>
std::array<double, N> readNumbers(const YAML::Node& list)
{
  if (!list.IsSequence() || list.size() != N)
  {
    throw YAML::TypedBadConversion<std::array<double, N>>(list.Mark());
  }
  std::array<double, N> numbers{};
  std::transform(list.begin(), list.end(), numbers.begin(), [](const YAML::Node& node) { return yamlNumber(node); });
  return numbers;
}

ReferenceBin readBin(const YAML::Node& node)
{
  ReferenceBin bin;
  bin.bin = { node["speed"].as<int>(), node["direction"].as<int>(), node["load"].as<int>(),
              node["temperature"].as<int>() };
  bin.windows = node["windows"].as<int>();
  bin.runs = node["runs"].as<int>();
  bin.mean_place = readNumbers<PLACES>(node["place"]);
  bin.tail = readNumbers<TAILS>(node["tail"]);
  if (node["information"].size() != PLACES)
  {
    throw InputError("'information' must have as many rows as 'place' has numbers");
  }
  std::transform(node["information"].begin(), node["information"].end(), bin.information.begin(), readNumbers<PLACES>);
  const bool tails_in_range =
      std::all_of(bin.tail.begin(), bin.tail.end(), [](double tail) { return tail >= 0.0 && tail <= MOST_TAIL; });
  if (!mapped(bin.mean_place).allFinite() || !mapped(bin.information).allFinite() || !tails_in_range)
  {
    throw InputError("'place' and 'information' must be finite, tail within 0 ... " + numberText(MOST_TAIL));
  }
  for (const auto& entry : node["indicators"])
  {
    std::vector<double> numbers;
    std::transform(entry.second.begin(), entry.second.end(), std::back_inserter(numbers),
                   [](const YAML::Node& number) { return yamlNumber(number); });
    const auto name = entry.first.as<std::string>();
    const bool fitted = numbers.size() == OWN_NUMBERS + 2 + PLACES + COMMON_CAUSES;
    const bool in_range =
        std::all_of(numbers.begin(), numbers.end(), [](double number) { return std::isfinite(number); }) &&
        (numbers.size() == OWN_NUMBERS || fitted) && numbers[0] >= 1.0 &&
        std::all_of(numbers.begin() + 2, numbers.begin() + OWN_NUMBERS + (fitted ? 2 : 0),
                    [](double number) { return number >= 0.0; });
    if (!in_range || (fitted && !(numbers[OWN_NUMBERS] > 0.0)))
    {
      throw InputError(
          name +
          " must be [windows >= 1, mean, spread >= 0, spread from window to window >= 0, standard error "
          ">= 0, magnitude >= 0]; a list with a regression continues with ridge > 0, degrees of freedom >= 0, "
          "slopes over 'place' and shares of common causes");
    }
    Reference& reference = bin.references[indicatorNamed(name)];
    reference.count = static_cast<int>(numbers[0]);
    reference.mean = numbers[1];
    reference.variance = numbers[2] * numbers[2];
    reference.within = numbers[3] * numbers[3];
    reference.relative_square = numbers[4] * numbers[4];
    reference.scale = numbers[5];
    reference.fitted = fitted;
    if (fitted)
    {
      reference.ridge = numbers[OWN_NUMBERS];
      reference.slopes_freedom = numbers[OWN_NUMBERS + 1];
      std::copy_n(numbers.begin() + OWN_NUMBERS + 2, PLACES, reference.slopes.begin());
      std::copy_n(numbers.begin() + OWN_NUMBERS + 2 + PLACES, COMMON_CAUSES, reference.common.begin());
    }
  }
  return bin;
}
}  // namespace

std::vector<ReferenceBin> readBaseline(const std::string& path, const Parameters& parameters, bool less_model)
{
  std::vector<ReferenceBin> bins;
  try
  {
    const YAML::Node file = YAML::LoadFile(path);
    const YAML::Node list = file["baseline"];
    if (!list.IsSequence() || list.size() == 0)
    {
      throw InputError("it has no list 'baseline' of operating points");
    }
    if (!file["format"] || file["format"].as<int>() != FORMAT)
    {
      throw InputError("another version of the software wrote the file; save the file again");
    }
    const double step = file["load_step"] ? yamlNumber(file["load_step"]) : 0.0;
    if (std::abs(step - loadStep(parameters)) > 1e-6 * loadStep(parameters))
    {
      throw InputError("its load_step is " + numberText(step) + " [N.m], expected " + numberText(loadStep(parameters)) +
                       ", which is three eighths of life.rated_torque; save the file again with "
                       "this gear's parameters");
    }
    if ((file["model"] && file["model"].as<bool>()) != less_model)
    {
      throw InputError(less_model ? "it was saved without --model, so it serves only without --model" :
                                    "it was saved with --model, so it serves only with --model");
    }
    for (const YAML::Node& node : list)
    {
      bins.push_back(readBin(node));
    }
  }
  catch (const YAML::Exception& error)
  {
    throw InputError(path + " is no baseline: " + error.what());
  }
  catch (const InputError& error)
  {
    throw InputError(path + " is no baseline: " + error.what());
  }
  return bins;
}

void writeBaseline(const std::string& path, const Baseline& baseline, bool less_model)
{
  TextStream text;
  const auto list = [](const auto& numbers)
  {
    std::string text;
    for (const double number : numbers)
    {
      text += (text.empty() ? "" : ", ") + numberText(number);
    }
    return text;
  };
  text << "# Healthy indicators by operating point. speed: octave of the motor's speed; load: in steps of load_step;\n"
          "# temperature: in steps of 10 K.\n"
          "# place: mean covariates of the windows: temperature, its square, mean magnitude of the load, constant part "
          "of the load,\n# its factors of sine and cosine of the output angle, inertia.\n"
          "# information: information on the slopes over the covariates. tail: 1 / degrees of freedom of scalars and "
          "of lines,\n# 0: normal. indicators: [windows, mean, spread, spread from window to window, standard error of "
          "a line over the\n# least of its signal (0: not known), mean magnitude, ridge and degrees of freedom of the "
          "slopes, slopes over the\n# covariates, loadings of the spread on the common causes], units as in "
          "docs/indicators.md.\n"
          "format: "
       << FORMAT << "\nload_step: " << numberText(baseline.loadStep()) << "\nmodel: " << (less_model ? "true" : "false")
       << "  # whether the indicators of a model were subtracted\nbaseline:\n";
  FitRoom room;
  for (std::size_t b = 0; b < baseline.bins().size(); ++b)
  {
    ReferenceBin bin = baseline.bins()[b];
    if (!baseline.given())
    {
      fitReference(bin, baseline.sums()[b], baseline.bins(), baseline.sums(), baseline.repeatability(), room);
    }
    text << "  - speed: " << bin.bin.speed << "\n    direction: " << bin.bin.direction << "\n    load: " << bin.bin.load
         << "\n    temperature: " << bin.bin.temperature << "\n    windows: " << bin.windows
         << "\n    runs: " << bin.runs << "\n    place: [" << list(bin.mean_place) << "]\n    tail: [" << list(bin.tail)
         << "]\n    information:\n";
    for (const Place& row : bin.information)
    {
      text << "      - [" << list(row) << "]\n";
    }
    text << "    indicators:\n";
    for (std::size_t i = 0; i < INDICATOR_COUNT; ++i)
    {
      const Reference& reference = bin.references[i];
      if (reference.count > 0)
      {
        text << "      " << indicatorName(i) << ": [" << reference.count << ", " << numberText(reference.mean) << ", "
             << numberText(std::sqrt(reference.variance)) << ", " << numberText(std::sqrt(reference.within)) << ", "
             << numberText(std::sqrt(reference.relative_square)) << ", " << numberText(reference.scale);
        if (reference.fitted)
        {
          text << ", " << numberText(reference.ridge) << ", " << numberText(reference.slopes_freedom) << ", "
               << list(reference.slopes) << ", " << list(reference.common);
        }
        text << "]\n";
      }
    }
  }
  writeTextFile(path, text.str());
}
}  // namespace hjt
