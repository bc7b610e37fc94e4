// SPDX-License-Identifier: BSD-3-Clause
#include "harmonic_joint_twin/params/parameter_map.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <type_traits>

#include "base/number_text.hpp"
#include "base/text.hpp"
#include "params/field_reader.hpp"
#include "params/field_table.hpp"

namespace hjt
{
namespace
{
constexpr double NANOSECONDS_PER_SECOND = 1e9;

/// Whether `of` is a whole multiple of `rate`.
bool divides(double rate, double of)
{
  const double times = std::round(of / rate);
  return times >= 1.0 && std::abs(times * rate - of) <= 1e-9 * of;
}

/// Text that names the rates nearest to `rate` that divide `of`.
std::string nearestDivisors(double rate, double of)
{
  const double times = std::floor(of / rate);
  return times < 1.0 ? "does: " + numberText(of) :
                       "do: " + numberText(of / (times + 1.0)) + ", " + numberText(of / times);
}

/// Collector of messages about contradictions between parameters, with the origins of their keys.
class Contradictions
{
public:
  explicit Contradictions(const ParameterMap& map) : map_(map) {}

  /// Adds a message if `holds` is false. `what`: function that returns the message.
  template <class What>
  void require(bool holds, const std::vector<std::string>& keys, const What& what)
  {
    const auto place = [this](const std::string& key)
    {
      const auto found = map_.find(key);
      return found == map_.end() ? key : found->second.origin;
    };
    if (!holds)
    {
      texts_.push_back(joined(keys, ", ", place) + ": " + what());
    }
  }

  std::vector<std::string> take() { return std::move(texts_); }

private:
  const ParameterMap& map_;
  std::vector<std::string> texts_;
};

void checkGear(const Parameters& p, Contradictions& check)
{
  const std::string flexspline = "gear.teeth_flexspline = " + std::to_string(p.gear.teeth_flexspline) + " [-]";
  check.require(p.gear.teeth_flexspline % 2 == 0, { "gear.teeth_flexspline" },
                [&] { return flexspline + " must be even"; });
  check.require(p.gear.teeth_circular_spline == p.gear.teeth_flexspline + 2,
                { "gear.teeth_circular_spline", "gear.teeth_flexspline" },
                [&]
                {
                  return "gear.teeth_circular_spline = " + std::to_string(p.gear.teeth_circular_spline) +
                         " [-] must be two more than " + flexspline;
                });
  check.require(
      p.gear.wave_amplitude < p.gear.flexspline_inner_radius, { "gear.wave_amplitude", "gear.flexspline_inner_radius" },
      [&]
      {
        return "gear.wave_amplitude = " + numberText(p.gear.wave_amplitude) +
               " [m] must be less than gear.flexspline_inner_radius = " + numberText(p.gear.flexspline_inner_radius) +
               " [m]";
      });
}

void checkPitch(const PitchParameters& pitch, const std::string& member, Contradictions& check)
{
  const std::string table_key = "manufacture." + member + "_pitch_table";
  const std::string deviation_key = "manufacture." + member + "_pitch_deviation";
  const bool from_table = pitch.table != NO_FILE;
  // The path must be absolute, because a node does not know the directory of its configuration.
  check.require(!from_table || pitch.table.front() == '/', { table_key },
                [&] { return table_key + " = '" + pitch.table + "' must be an absolute path, or " + NO_FILE; });
  check.require(!from_table || pitch.deviation == 0.0, { table_key, deviation_key },
                [&]
                {
                  return deviation_key + " = " + numberText(pitch.deviation) + " [m] must be 0 if " + table_key +
                         " gives the deviations";
                });
}

void checkElements(const Parameters& p, Contradictions& check)
{
  const auto& breakpoints = p.cup.torsion_breakpoints;
  check.require(breakpoints[0] < breakpoints[1], { "cup.torsion_breakpoints" },
                [&]
                {
                  return "cup.torsion_breakpoints = [" + numberText(breakpoints[0]) + ", " +
                         numberText(breakpoints[1]) + "] [N.m] must be ascending";
                });
  const auto& slopes = p.cup.torsion_stiffness;
  const double steepest = *std::max_element(slopes.begin(), slopes.end());
  check.require(p.cup.wall_stiffness > steepest, { "cup.wall_stiffness", "cup.torsion_stiffness" },
                [&]
                {
                  return "cup.wall_stiffness = " + numberText(p.cup.wall_stiffness) +
                         " [N.m/rad] must exceed the steepest slope of cup.torsion_stiffness, " + numberText(steepest) +
                         " [N.m/rad], because the wall is only a part of the cup's compliance";
                });
  check.require(p.mesh.profile == ProfileKind::TRAPEZOID || p.gear.engagementDepth() > 0.0,
                { "mesh.profile", "gear.tip_radius_circular_spline" },
                [&]
                {
                  return "mesh.profile needs teeth that reach into the circular spline, but the teeth end " +
                         numberText(-p.gear.engagementDepth()) + " [m] short of the circular spline";
                });
  check.require(p.mesh.friction_kinetic <= p.mesh.friction_static, { "mesh.friction_kinetic", "mesh.friction_static" },
                [&]
                {
                  return "mesh.friction_kinetic = " + numberText(p.mesh.friction_kinetic) +
                         " [-] must not exceed mesh.friction_static = " + numberText(p.mesh.friction_static) + " [-]";
                });
  check.require(
      p.bearing.ball_diameter < p.bearing.pitch_diameter, { "bearing.ball_diameter", "bearing.pitch_diameter" },
      [&]
      {
        return "bearing.ball_diameter = " + numberText(p.bearing.ball_diameter) +
               " [m] must be less than bearing.pitch_diameter = " + numberText(p.bearing.pitch_diameter) + " [m]";
      });
  check.require(p.contact.support != SupportKind::SINGLE_BALLS || p.bearing.balls <= p.gear.teeth_flexspline,
                { "contact.support", "bearing.balls" },
                [&]
                {
                  return "contact.support = single_balls allows at most one ball for each tooth, but bearing.balls = " +
                         std::to_string(p.bearing.balls);
                });
}

void checkLife(const Parameters& p, Contradictions& check)
{
  check.require(p.life.use_record == NO_FILE || p.life.use_record.front() == '/', { "life.use_record" },
                [&]
                { return "life.use_record = '" + p.life.use_record + "' must be an absolute path, or " + NO_FILE; });
  check.require(p.life.bearing_l10 < p.life.bearing_l50, { "life.bearing_l10", "life.bearing_l50" },
                [&]
                {
                  return "life.bearing_l10 = " + numberText(p.life.bearing_l10) +
                         " [h] must be less than life.bearing_l50 = " + numberText(p.life.bearing_l50) + " [h]";
                });
  check.require(p.life.endurance_limit < p.life.ultimate_strength, { "life.endurance_limit", "life.ultimate_strength" },
                [&]
                {
                  return "life.endurance_limit = " + numberText(p.life.endurance_limit) +
                         " [Pa] must be less than life.ultimate_strength = " + numberText(p.life.ultimate_strength) +
                         " [Pa]";
                });
  check.require(p.life.face_width < p.stress.cup_length, { "life.face_width", "stress.cup_length" },
                [&]
                {
                  return "life.face_width = " + numberText(p.life.face_width) +
                         " [m] must be less than stress.cup_length = " + numberText(p.stress.cup_length) + " [m]";
                });
  const auto check_limit = [&](const std::string& limit_key, double limit, const std::string& scale_key, double scale)
  {
    check.require(limit <= scale, { limit_key, scale_key },
                  [&]
                  {
                    return limit_key + " = " + numberText(limit) + " [m] must not exceed " + scale_key + " = " +
                           numberText(scale) + " [m]";
                  });
  };
  check_limit("life.flank_wear_limit", p.life.flank_wear_limit, "fault_scale.tooth_wear_depth",
              p.fault_scale.tooth_wear_depth);
  check_limit("life.interface_wear_limit", p.life.interface_wear_limit, "fault_scale.interface_wear_depth",
              p.fault_scale.interface_wear_depth);
}

void checkFaults(const Parameters& p, Contradictions& check)
{
  for (std::size_t i = 0; i < p.faults.size(); ++i)
  {
    const std::string key = faultKey(static_cast<int>(i)) + '.';
    const std::string errors = faultErrors(p.faults[i], p, key);
    check.require(errors.empty(), { key + "kind" }, [&] { return errors; });
  }
  check.require(p.faults.size() <= MAX_FAULTS, { faultKey(static_cast<int>(MAX_FAULTS)) + ".kind" },
                [&] { return "more than " + std::to_string(MAX_FAULTS) + " faults"; });
}

void checkRates(const Parameters& p, Contradictions& check)
{
  // If a step were not a whole number of nanoseconds, the times of the steps would drift from the messages' clock.
  const double step = std::round(NANOSECONDS_PER_SECOND / p.solver.rate);
  check.require(step * p.solver.rate == NANOSECONDS_PER_SECOND, { "solver.rate" },
                [&]
                {
                  return "solver.rate = " + numberText(p.solver.rate) +
                         " [Hz] must make a step of whole nanoseconds, as for example 1000, 8000 or 10000";
                });

  const auto check_rate = [&](const std::string& key, double rate)
  {
    check.require(divides(rate, p.solver.rate), { key, "solver.rate" },
                  [&]
                  {
                    return key + " = " + numberText(rate) +
                           " [Hz] must divide solver.rate = " + numberText(p.solver.rate) + " [Hz]; the nearest that " +
                           nearestDivisors(rate, p.solver.rate) + " [Hz]";
                  });
  };
  check_rate("indicators.sample_rate", p.indicators.sample_rate);
  // Every number in section publish is the rate of a topic.
  visitFields(p,
              [&check_rate](const std::string& key, const auto&... rest)
              {
                if constexpr (sizeof...(rest) == 4)  // unit, value, range, meaning
                {
                  const auto& value = std::get<1>(std::tie(rest...));
                  if constexpr (std::is_same_v<std::decay_t<decltype(value)>, double>)
                  {
                    if (key.rfind("publish.", 0) == 0)
                    {
                      check_rate(key, value);
                    }
                  }
                }
              });
}

/// Messages about contradictions between parameters that are all in range. `map` gives the origins of the parameters.
std::vector<std::string> contradictions(const Parameters& parameters, const ParameterMap& map)
{
  Contradictions check(map);
  checkGear(parameters, check);
  checkPitch(parameters.manufacture.flexspline_pitch, "flexspline", check);
  checkPitch(parameters.manufacture.circular_spline_pitch, "circular_spline", check);
  checkElements(parameters, check);
  checkLife(parameters, check);
  checkRates(parameters, check);
  checkFaults(parameters, check);
  return check.take();
}
}  // namespace

std::optional<double> numberOf(const decltype(ParameterValue::value)& value)
{
  struct
  {
    std::optional<double> operator()(std::int64_t whole) const { return static_cast<double>(whole); }
    std::optional<double> operator()(double number) const { return number; }
    std::optional<double> operator()(const std::string& text) const { return decimalNumber(text); }
    std::optional<double> operator()(bool) const { return std::nullopt; }
    std::optional<double> operator()(const std::vector<double>&) const { return std::nullopt; }
  } read;
  return std::visit(read, value);
}

std::string valueText(const ParameterValue& configured)
{
  struct
  {
    std::string operator()(bool value) const { return value ? "true" : "false"; }
    std::string operator()(std::int64_t value) const { return std::to_string(value); }
    std::string operator()(double value) const { return numberText(value); }
    std::string operator()(const std::string& value) const { return "'" + value + "'"; }
    std::string operator()(const std::vector<double>& value) const
    {
      return "[" + joined(value, ", ", numberText) + "]";
    }
  } write;
  return std::visit(write, configured.value);
}

Parameters parseParameters(const ParameterMap& map)
{
  Parameters parameters;
  FieldReader reader(map);
  visitFields(parameters, reader);
  reader.readFaults(parameters.faults);
  reader.refuseUnknownKeys();
  throwIfAny(reader.errors());
  // Contradictions are checked only if all values are in range.
  throwIfAny(contradictions(parameters, map));
  return parameters;
}

void changeParameters(Parameters& parameters, const ParameterMap& changes)
{
  FieldReader reader(changes);
  visitFields(parameters,
              [&](const std::string& key, auto&&... field)
              {
                if (changes.count(key) > 0)
                {
                  reader(key, field...);
                }
              });
  reader.readFaults(parameters.faults);
  reader.refuseUnknownKeys();
  throwIfAny(reader.errors());
  throwIfAny(contradictions(parameters, changes));
}
}  // namespace hjt
