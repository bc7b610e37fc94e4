// SPDX-License-Identifier: BSD-3-Clause
#include "statics/gear_design.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <boost/math/tools/roots.hpp>

#include "base/number_text.hpp"
#include "harmonic_joint_twin/base/errors.hpp"
#include "harmonic_joint_twin/statics/loss_analysis.hpp"
#include "harmonic_joint_twin/statics/static_analysis.hpp"
#include "params/variants.hpp"
#include "statics/gear_rules.hpp"

namespace hjt
{
namespace
{
/// One size of the catalogue. Source of stiffness and ratings: Harmonic Drive, CSF/HFUS. Source of the friction at
/// ratio 100: Schaeffler TPI 275 (RT1-H-CS), which lacks sizes 11 and 32. The figures for size 11 are not verified.
struct CatalogueSize
{
  double size;
  std::array<double, 2> breakpoints;       // T1, T2 [N.m]
  std::array<double, 3> stiffness_of_50;   // K1, K2, K3 at ratios below 80 [N.m/rad]
  std::array<double, 3> stiffness;         // K1, K2, K3 at ratios of 80 or more [N.m/rad]
  double starting_torque, no_load_torque;  // torques at the wave generator [N.m]
};

struct CatalogueRating
{
  double size;
  int ratio;
  double repeated_peak, average, rated, momentary_peak;  // [N.m]
};

inline constexpr std::array<CatalogueSize, 6> CATALOGUE_SIZES{ {
    { 11.0, { 0.8, 2.0 }, { 2.2e3, 3.0e3, 3.2e3 }, { 2.7e3, 3.4e3, 4.4e3 }, 0.0, 0.0 },
    { 14.0, { 2.0, 6.9 }, { 3.4e3, 4.7e3, 5.7e3 }, { 4.7e3, 6.1e3, 7.1e3 }, 0.021, 0.035 },
    { 17.0, { 3.9, 12.0 }, { 8.1e3, 11e3, 13e3 }, { 10e3, 14e3, 16e3 }, 0.029, 0.051 },
    { 20.0, { 7.0, 25.0 }, { 13e3, 18e3, 23e3 }, { 16e3, 25e3, 29e3 }, 0.037, 0.105 },
    { 25.0, { 14.0, 48.0 }, { 25e3, 34e3, 44e3 }, { 31e3, 50e3, 57e3 }, 0.069, 0.195 },
    { 32.0, { 29.0, 108.0 }, { 54e3, 78e3, 98e3 }, { 67e3, 110e3, 120e3 }, 0.0, 0.0 },
} };

inline constexpr std::array<CatalogueRating, 24> CATALOGUE_RATINGS{ {
    { 11.0, 50, 8.3, 5.5, 3.5, 17.0 },         { 11.0, 100, 11.0, 8.9, 5.0, 25.0 },
    { 14.0, 50, 18.0, 6.9, 5.4, 35.0 },        { 14.0, 80, 23.0, 11.0, 7.8, 47.0 },
    { 14.0, 100, 28.0, 11.0, 7.8, 54.0 },      { 17.0, 50, 34.0, 26.0, 16.0, 70.0 },
    { 17.0, 80, 43.0, 27.0, 22.0, 87.0 },      { 17.0, 100, 54.0, 39.0, 24.0, 110.0 },
    { 17.0, 120, 54.0, 39.0, 24.0, 86.0 },     { 20.0, 50, 56.0, 34.0, 25.0, 98.0 },
    { 20.0, 80, 74.0, 47.0, 34.0, 127.0 },     { 20.0, 100, 82.0, 49.0, 40.0, 147.0 },
    { 20.0, 120, 87.0, 49.0, 40.0, 147.0 },    { 20.0, 160, 92.0, 49.0, 40.0, 147.0 },
    { 25.0, 50, 98.0, 55.0, 39.0, 186.0 },     { 25.0, 80, 137.0, 87.0, 63.0, 255.0 },
    { 25.0, 100, 157.0, 108.0, 67.0, 284.0 },  { 25.0, 120, 167.0, 108.0, 67.0, 304.0 },
    { 25.0, 160, 176.0, 108.0, 67.0, 314.0 },  { 32.0, 50, 216.0, 108.0, 76.0, 382.0 },
    { 32.0, 80, 304.0, 167.0, 118.0, 568.0 },  { 32.0, 100, 333.0, 216.0, 137.0, 647.0 },
    { 32.0, 120, 353.0, 216.0, 137.0, 686.0 }, { 32.0, 160, 372.0, 216.0, 137.0, 686.0 },
} };

constexpr double CONFIGURED_SIZE = 25.0;
constexpr double TORSION_ERROR = 1e-4;  // largest relative error of a fitted torsion [-]
constexpr int TORSION_TRIALS = 30;
constexpr int FITTED_BITS = 12;          // number of correct bits of a parameter that is fitted to a torque
constexpr double LEAST_OF_START = 1e-3;  // least value that the fit tries, over its start value [-]
constexpr int CATALOGUE_RATIO = 100;     // ratio for which the catalogue states friction
constexpr const char* ORIGIN = "gear";
constexpr const char* PRELOAD = "bearing.race_preload";
constexpr const char* VISCOSITY = "bearing.viscosity";

/// Sets parameters by their keys, and records the rule that gave each value.
class Designer
{
public:
  explicit Designer(const ParameterMap& configured) { design_.map = configured; }

  void set(const std::string& key, std::int64_t value, const std::string& rule) { put(key, value, rule); }
  void set(const std::string& key, double value, const std::string& rule) { put(key, value, rule); }
  void set(const std::string& key, std::vector<double> values, const std::string& rule)
  {
    put(key, std::move(values), rule);
  }

  void scale(const std::string& key, double factor, const std::string& rule)
  {
    const auto& value = design_.map.at(key).value;
    if (const auto* list = std::get_if<std::vector<double>>(&value))
    {
      std::vector<double> scaled = *list;
      std::transform(scaled.begin(), scaled.end(), scaled.begin(), [&](double part) { return factor * part; });
      set(key, std::move(scaled), rule);
    }
    else
    {
      set(key, factor * numberOf(value).value(), rule);
    }
  }

  Parameters parameters() const { return parseParameters(design_.map); }
  GearDesign take() { return std::move(design_); }

private:
  template <class Value>
  void put(const std::string& key, Value value, const std::string& rule)
  {
    design_.map[key] = { std::move(value), ORIGIN };
    const auto is_key = [&](const DesignedParameter& parameter) { return parameter.key == key; };
    const auto found = std::find_if(design_.parameters.begin(), design_.parameters.end(), is_key);
    if (found == design_.parameters.end())
    {
      design_.parameters.push_back({ key, rule });
    }
    else
    {
      found->rule = rule;
    }
  }

  GearDesign design_;
};

void requireInRange(const GearRequest& request)
{
  if (!(request.size >= 5.0 && request.size <= 100.0) || request.ratio < 30 || request.ratio > 320)
  {
    throw ParameterError("gear: size = " + numberText(request.size) + " [-], ratio = " + std::to_string(request.ratio) +
                         " [-] is out of range, allowed: size 5 ... 100, ratio 30 ... 320");
  }
}

/// Checks the figures of a request. @throws ParameterError if a figure is impossible for a gear.
void requireFigures(const GearRequest& request)
{
  const auto require = [](const std::vector<double>& values, std::size_t count, bool rising, const char* what)
  {
    const bool positive =
        std::all_of(values.begin(), values.end(), [](double value) { return value > 0.0 && std::isfinite(value); });
    if (!values.empty() &&
        (values.size() != count || !positive ||
         (rising && std::adjacent_find(values.begin(), values.end(), std::greater_equal<>()) != values.end())))
    {
      throw ParameterError(std::string("gear: ") + what);
    }
  };
  require(request.stiffness, 3, false, "stiffness needs three values > 0: K1, K2 and K3 [N.m/rad]");
  require(request.breakpoints, 2, true, "breakpoints needs two values with 0 < T1 < T2: T1 and T2 [N.m]");
  require(request.ratings, 4, false,
          "ratings needs four values > 0: rated, average, repeated peak and momentary peak torque [N.m]");
  for (const std::optional<double>& torque : { request.starting_torque, request.no_load_torque })
  {
    require(torque ? std::vector<double>{ *torque } : std::vector<double>{}, 1, false,
            "starting and no-load torque must be > 0 [N.m]");
  }
}

void applyRules(const Parameters& from, const GearRequest& request, Designer& designer)
{
  const double size = request.size / CONFIGURED_SIZE;
  GearParameters gear = from.gear;
  gear.teeth_flexspline = 2 * request.ratio;
  gear.teeth_circular_spline = gear.teeth_flexspline + 2;
  gear.flexspline_inner_radius = request.bore_radius.value_or(size * from.gear.flexspline_inner_radius);
  gear.rim_thickness = request.rim_thickness.value_or(size * from.gear.rim_thickness);
  const double face_width = request.face_width.value_or(size * from.life.face_width);
  const double teeth = static_cast<double>(gear.teeth_flexspline) / from.gear.teeth_flexspline;
  const double radius = gear.flexspline_inner_radius / from.gear.flexspline_inner_radius;
  const double rim = gear.rim_thickness / from.gear.rim_thickness;
  const double face = face_width / from.life.face_width;
  const double pitch = radius / teeth;
  gear.tooth_height_flexspline = pitch * from.gear.tooth_height_flexspline;
  gear.tip_radius_circular_spline =
      fittingTipRadius(gear) + pitch * (from.gear.tip_radius_circular_spline - fittingTipRadius(from.gear));
  gear.wave_amplitude = from.gear.wave_amplitude * fittingWaveAmplitude(gear) / fittingWaveAmplitude(from.gear);
  const double section = gear.rim_thickness + 0.5 * gear.tooth_height_flexspline;
  const double from_section = from.gear.rim_thickness + 0.5 * from.gear.tooth_height_flexspline;
  const double cube = std::pow(radius, 3);
  const char* by_size = "scaled by the size";
  const auto given = [](const std::optional<double>& value, const char* rule) { return value ? "given" : rule; };

  designer.set("gear.teeth_flexspline", std::int64_t{ gear.teeth_flexspline }, "twice the ratio");
  designer.set("gear.teeth_circular_spline", std::int64_t{ gear.teeth_circular_spline },
               "two more teeth than the flexspline");
  designer.set("gear.flexspline_inner_radius", gear.flexspline_inner_radius, given(request.bore_radius, by_size));
  designer.set("gear.rim_thickness", gear.rim_thickness, given(request.rim_thickness, by_size));
  designer.set("gear.tooth_height_flexspline", gear.tooth_height_flexspline, "in proportion to the tooth pitch");
  designer.set("gear.tip_radius_circular_spline", gear.tip_radius_circular_spline, "bore radius + rim + tooth height");
  designer.set("gear.wave_amplitude", gear.wave_amplitude, "amplitude at which the teeth roll in their spaces");
  designer.scale("ring.mass", radius * face * section / from_section,
                 "in proportion to the rim's circumference, face width and thickness");
  designer.scale("ring.tension_stiffness", face * rim / pitch, "in proportion to rim section over segment length");
  designer.scale("ring.bending_stiffness", face * std::pow(rim, 3) / pitch,
                 "in proportion to face width * rim thickness^3 / segment length");
  designer.scale("contact.stiffness", face / teeth, "in proportion to face width over number of teeth");
  designer.scale("contact.fit", radius, by_size);
  designer.set("contact.slip_lever",
               0.5 * gear.rim_thickness + radius * (from.contact.slip_lever - 0.5 * from.gear.rim_thickness),
               "half the thickness of the rim plus half the thickness of the race");
  designer.scale("mesh.stiffness", face, "in proportion to the face width");
  designer.scale("mesh.tangent_length", pitch, "in proportion to the tooth pitch");
  designer.scale("mesh.engagement_depth", pitch, "in proportion to the tooth pitch");
  designer.scale("mesh.flank_clearance", radius, by_size);
  designer.scale("cup.torsion_stiffness", cube, "in proportion to the cube of the size");
  designer.scale("cup.wall_stiffness", cube, "in proportion to the cube of the size");
  designer.scale("bearing.pitch_diameter", radius, by_size);
  designer.scale("bearing.ball_diameter", radius, by_size);
  designer.scale("bearing.race_bending_stiffness", cube * teeth, "in proportion to number of teeth times size cubed");
  designer.scale(PRELOAD, radius * radius, "in proportion to the square of the size");
  designer.scale("motor.wave_generator_inertia", std::pow(radius, 5), "in proportion to the fifth power of the size");
  designer.scale("output.circular_spline_inertia", std::pow(radius, 5), "in proportion to the fifth power of the size");
  designer.scale("stress.wall_thickness", radius, by_size);
  designer.scale("stress.cup_length", radius, by_size);
  designer.scale("stress.notch_radius", radius, by_size);
  designer.set("life.face_width", face_width, given(request.face_width, by_size));
}

void applyRatings(const Parameters& from, const GearRequest& request, const GearFigures& figures, Designer& designer)
{
  const auto rule_of = [&](const std::vector<double>& given) { return given.empty() ? figures.source : "given"; };
  const std::string rule = rule_of(request.ratings);
  designer.set("cup.torsion_breakpoints", { figures.breakpoints[0], figures.breakpoints[1] },
               rule_of(request.breakpoints));
  // The ratio of cup friction to T1 is that of the configured gear.
  designer.scale("cup.friction_torque", figures.breakpoints[0] / from.cup.torsion_breakpoints[0],
                 "in proportion to T1, at which gears have about equal torsion");
  designer.set("life.rated_torque", figures.rated_torque, rule);
  designer.set("life.repeated_peak_torque", figures.repeated_peak_torque, rule);
  designer.set("life.momentary_peak_torque", figures.momentary_peak_torque, rule);
  designer.set("output.load_torque_limit", figures.momentary_peak_torque, "momentary peak torque");
  designer.set("health.stiffness_torque_span", 0.1 * figures.average_torque, "a tenth of the average torque");
  designer.set("indicators.stiffness_torque", figures.breakpoints[0], "T1");
  designer.set("indicators.lost_motion_torque", 0.04 * figures.rated_torque, "4 % of the rated torque");
}

/// Fits the three stiffnesses of the cup to the gear's torsion in the catalogue. Cup, rim and teeth are in series, so
/// the cup gets the compliance that rim and teeth do not have.
void fitTorsion(const GearFigures& figures, Designer& designer)
{
  const std::vector<double> torques{ figures.breakpoints[0], figures.breakpoints[1], figures.repeated_peak_torque };
  for (int trial = 0; trial < TORSION_TRIALS; ++trial)
  {
    const Parameters parameters = designer.parameters();
    const std::vector<StiffnessRow> rows = analyseStiffness(parameters, 0.0, torques);
    std::vector<double> slopes(torques.size());
    double worst = 0.0;
    double wanted_before = 0.0;
    double found_before = 0.0;
    double torque_before = 0.0;
    for (std::size_t i = 0; i < torques.size(); ++i)
    {
      if (!rows[i].status.ok())
      {
        throw ParameterError("there is no equilibrium under a load of " + numberText(torques[i]) +
                             " N.m: " + explanationOf(rows[i].status));
      }
      const double wanted = figures.torsion(torques[i]);
      const double found = -rows[i].output_angle;
      worst = std::max(worst, std::abs(found / wanted - 1.0));
      const double missing = ((wanted - wanted_before) - (found - found_before)) / (torques[i] - torque_before);
      const double compliance = 1.0 / parameters.cup.torsion_stiffness[i] + missing;
      const double stiffest = 0.99 * parameters.cup.wall_stiffness;
      slopes[i] = compliance > 1.0 / stiffest ? 1.0 / compliance : stiffest;
      wanted_before = wanted;
      found_before = found;
      torque_before = torques[i];
    }
    if (worst < TORSION_ERROR)
    {
      return;
    }
    designer.set("cup.torsion_stiffness", std::move(slopes), "fitted to the torsion of the gear in the catalogue");
  }
  throw ParameterError(
      "the cup cannot be fitted to the torsion of the catalogue, because rim and teeth alone exceed this torsion");
}

/// Fits a parameter > 0 so that a torque has the value `wanted` [N.m]. `torque`: this torque as a function of all
/// parameters [N.m], which increases with the fitted parameter. `start`: start value of the fit.
template <class Torque>
void fitTorque(const std::string& key, double start, double wanted, const std::string& rule, Torque&& torque,
               Designer& designer)
{
  const auto miss = [&](double value)
  {
    designer.set(key, value, rule);
    Parameters parameters = withoutHeat(designer.parameters());
    parameters.input.temperature = CATALOGUE_TEMPERATURE;
    return torque(parameters) - wanted;
  };
  const double least = wanted + miss(LEAST_OF_START * start);
  if (least > wanted)
  {
    throw ParameterError("gear: " + key + " cannot be fitted to " + numberText(wanted) +
                         " N.m, because the other friction of the gear alone is " + roundedText(least, 4) + " N.m");
  }
  std::uintmax_t trials = 60;
  const auto [low, high] = boost::math::tools::bracket_and_solve_root(
      miss, start, 2.0, true, boost::math::tools::eps_tolerance<double>(FITTED_BITS), trials);
  designer.set(key, 0.5 * (low + high), rule);
}

double startingTorque(const Parameters& parameters)
{
  const Breakaway breakaway = analyseBreakaway(parameters, FRICTION_POSITIONS);
  if (!breakaway.status.ok())
  {
    throw ParameterError("no load drives the gear back: " + explanationOf(breakaway.status));
  }
  return breakaway.starting;
}

double noLoadTorque(const Parameters& parameters)
{
  const LossRow row = analyseLosses(parameters, { CATALOGUE_SPEED }, { 0.0 }, FRICTION_POSITIONS, nullptr).front();
  if (!row.status.ok())
  {
    throw ParameterError("there is no equilibrium without load: " + explanationOf(row.status));
  }
  return row.loss.gear();
}
}  // namespace

double GearFigures::torsion(double torque) const
{
  const double first = std::min(torque, breakpoints[0]);
  const double second = std::clamp(torque - breakpoints[0], 0.0, breakpoints[1] - breakpoints[0]);
  const double third = std::max(torque - breakpoints[1], 0.0);
  return first / stiffness[0] + second / stiffness[1] + third / stiffness[2];
}

GearFigures gearFigures(const GearRequest& request)
{
  requireFigures(request);
  const auto& ratings = CATALOGUE_RATINGS;
  const bool size_known = std::any_of(ratings.begin(), ratings.end(),
                                      [&](const CatalogueRating& rating) { return rating.size == request.size; });
  const double from_size = size_known ? request.size : CONFIGURED_SIZE;
  const auto distance = [&](const CatalogueRating& rating)
  { return std::pair(rating.size != from_size, std::abs(rating.ratio - request.ratio)); };
  const CatalogueRating& rating = *std::min_element(
      ratings.begin(), ratings.end(), [&](const auto& a, const auto& b) { return distance(a) < distance(b); });
  const CatalogueSize& size = *std::find_if(CATALOGUE_SIZES.begin(), CATALOGUE_SIZES.end(),
                                            [&](const CatalogueSize& other) { return other.size == rating.size; });
  const bool listed = size_known && rating.ratio == request.ratio;
  GearFigures figures;
  figures.source = listed ?
                       "HFUS/CSF, TPI 275" :
                       "size " + roundedText(rating.size, 4) + ", ratio " + std::to_string(rating.ratio) + " scaled";
  const double cube = std::pow(request.size / rating.size, 3);
  const auto take = [&](const std::vector<double>& given, const auto& known, auto& into)
  {
    for (std::size_t i = 0; i < into.size(); ++i)
    {
      into[i] = given.empty() ? cube * known[i] : given[i];
    }
  };
  take(request.stiffness, rating.ratio < 80 ? size.stiffness_of_50 : size.stiffness, figures.stiffness);
  take(request.breakpoints, size.breakpoints, figures.breakpoints);
  std::array<double, 4> torques{};
  take(request.ratings, std::array{ rating.rated, rating.average, rating.repeated_peak, rating.momentary_peak },
       torques);
  figures.rated_torque = torques[0];
  figures.average_torque = torques[1];
  figures.repeated_peak_torque = torques[2];
  figures.momentary_peak_torque = torques[3];
  const bool friction_known = listed && rating.ratio == CATALOGUE_RATIO;
  figures.starting_torque = request.starting_torque.value_or(friction_known ? size.starting_torque : 0.0);
  figures.no_load_torque = request.no_load_torque.value_or(friction_known ? size.no_load_torque : 0.0);
  return figures;
}

GearDesign designGear(const ParameterMap& configured, const GearRequest& request, const GearFigures& figures)
{
  requireInRange(request);
  const Parameters from = parseParameters(configured);
  Designer designer(configured);
  applyRules(from, request, designer);
  applyRatings(from, request, figures, designer);
  if (const std::string jam = jamOf(designer.parameters()); !jam.empty())
  {
    throw ParameterError(jam);
  }
  fitTorsion(figures, designer);
  const bool has_friction = figures.starting_torque > 0.0 && figures.no_load_torque > 0.0;
  GearRequest known = request;
  known.ratio = CATALOGUE_RATIO;
  known.stiffness = known.breakpoints = known.ratings = {};
  known.starting_torque = known.no_load_torque = std::nullopt;
  if (const GearFigures known_figures = gearFigures(known); !has_friction && known_figures.starting_torque > 0.0)
  {
    const Parameters fitted = parseParameters(designGear(configured, known, known_figures).map);
    designer.set(PRELOAD, fitted.bearing.race_preload, "the value for ratio 100, because the bearing is the same");
    designer.set(VISCOSITY, fitted.bearing.viscosity, "the value for ratio 100, because the bearing is the same");
  }
  if (figures.starting_torque > 0.0)
  {
    fitTorque(PRELOAD, designer.parameters().bearing.race_preload, figures.starting_torque,
              "fitted to the starting torque of the catalogue", startingTorque, designer);
  }
  if (figures.no_load_torque > 0.0)
  {
    fitTorque(VISCOSITY, designer.parameters().bearing.viscosity, figures.no_load_torque,
              "fitted to the no-load torque of the catalogue, 2000 rpm and 20 degC", noLoadTorque, designer);
  }
  return designer.take();
}
}  // namespace hjt
