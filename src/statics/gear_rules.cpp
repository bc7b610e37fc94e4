// SPDX-License-Identifier: BSD-3-Clause
#include "statics/gear_rules.hpp"

#include <cmath>
#include <string>

#include "base/number_text.hpp"
#include "harmonic_joint_twin/base/errors.hpp"
#include "harmonic_joint_twin/statics/loss_analysis.hpp"
#include "harmonic_joint_twin/statics/static_analysis.hpp"
#include "model/faults/joint_faults.hpp"
#include "params/variants.hpp"

namespace hjt
{
namespace
{
/// Parts that the analysis lacks and without which the fault has no effect; null if the fault has an effect.
const char* missingFor(const Fault& fault, const Parameters& parameters, Analysis analysis)
{
  const unsigned changed = partsOf(fault, parameters.gear);
  switch (analysis)
  {
    case Analysis::INSERTION:
      return (changed & (RIM_PART | GENERATOR_PART)) != 0 ? nullptr : "the circular spline, load and friction";
    case Analysis::RING:
      return (changed & ~FRICTION_PART) != 0 ? nullptr : "friction";
    case Analysis::WITH_FRICTION:
      break;
  }
  return nullptr;
}
}  // namespace

void requireFaultsAct(const Parameters& parameters, Analysis analysis)
{
  for (const Fault& fault : parameters.faults)
  {
    const std::string name = std::string("faults: ") + describe(fault.kind).name;
    if (fault.severity > 0.0 && fault.onset > 0.0)
    {
      throw ParameterError(name + " sets in at " + numberText(fault.onset) +
                           " s, but this analysis has no time; set its onset to 0 or remove the fault");
    }
    const char* missing = missingFor(fault, parameters, analysis);
    if (missing != nullptr)
    {
      throw ParameterError(name + " cannot act in this analysis, which does not contain " + missing);
    }
  }
}

namespace
{
constexpr int EFFICIENCY_POSITIONS = 4;  // number of wave generator angles in a tooth pitch for the efficiency

std::string shortNumber(double value)
{
  return roundedText(value, 5);
}

/// Parameters of the drive to be checked, without its configured faults and errors of manufacture.
Parameters soundGear(const Parameters& parameters)
{
  Parameters sound = withoutHeat(withoutWeight(withoutErrors(parameters)));
  sound.faults.clear();
  sound.contact.law = ContactLaw::NORMAL;
  return sound;
}

/// Adds a warning if a parameter differs from its expected value by more than a given factor.
class Nearness
{
public:
  explicit Nearness(std::vector<std::string>& warnings) : warnings_(warnings) {}

  void check(const std::string& key, double value, const std::string& unit, double expected, double factor,
             const std::string& reason)
  {
    if (value > factor * expected || expected > factor * value)
    {
      warnings_.push_back(key + " = " + shortNumber(value) + " [" + unit + "] should be near " + shortNumber(expected) +
                          " [" + unit + "]: " + reason);
    }
  }

private:
  std::vector<std::string>& warnings_;
};
/// Message about the jam that `fit`, the check of a sound gear's teeth, shows; empty if the teeth do not jam.
std::string jamText(const Parameters& sound, const FitCheck& fit)
{
  if (!fit.jams())
  {
    return "";
  }
  const GearParameters& gear = sound.gear;
  return "the teeth jam without load: " + std::to_string(fit.teeth_loaded) + " of " +
         std::to_string(gear.teeth_flexspline) + " teeth are loaded, and the wave generator carries " +
         shortNumber(fit.wave_generator_force) + " N instead of " + shortNumber(fit.wave_generator_force_insertion) +
         " N without the circular spline. gear.wave_amplitude = " + shortNumber(gear.wave_amplitude) +
         " [m] should be near " + shortNumber(fittingWaveAmplitude(gear)) +
         " [m], gear.tip_radius_circular_spline = " + shortNumber(gear.tip_radius_circular_spline) + " [m] near " +
         shortNumber(fittingTipRadius(gear)) +
         " [m] for this number of teeth, radius, rim and tooth height; mesh.flank_clearance = " +
         shortNumber(sound.mesh.flank_clearance) + " [m]";
}
}  // namespace

std::string jamOf(const Parameters& parameters)
{
  const Parameters sound = soundGear(parameters);
  return jamText(sound, checkFit(sound));
}

std::vector<std::string> gearWarnings(const Parameters& parameters)
{
  const Parameters sound = soundGear(parameters);
  const FitCheck fit = checkFit(sound);
  if (fit.jams())
  {
    return { jamText(sound, fit) };
  }
  const GearParameters& gear = sound.gear;
  std::vector<std::string> warnings;
  Nearness near(warnings);
  near.check("gear.wave_amplitude", gear.wave_amplitude, "m", fittingWaveAmplitude(gear), 1.03,
             "the value at which the teeth roll in their spaces");
  near.check("gear.tip_radius_circular_spline", gear.tip_radius_circular_spline, "m", fittingTipRadius(gear),
             1.0 + 0.25 * gear.tooth_height_flexspline / fittingTipRadius(gear),
             "the sum of bore radius, rim and tooth height, at which the teeth engage to the depth of the wave");
  near.check("ring.bending_stiffness", sound.ring.bending_stiffness, "N.m/rad", rimBendingStiffness(sound), 2.0,
             "the value that follows from gear.rim_thickness, life.face_width and the number of teeth");
  near.check("ring.tension_stiffness", sound.ring.tension_stiffness, "N/m", 2.5 * rimTensionStiffness(sound), 2.5,
             "2.5 times the stiffness of the rim under the teeth, because the teeth carry a part of the tension");
  if (!fit.status.ok())
  {
    warnings.push_back("there is no equilibrium without load: " + explanationOf(fit.status));
    return warnings;
  }
  if (fit.teeth_loaded == 0)
  {
    warnings.push_back("mesh.flank_clearance = " + shortNumber(sound.mesh.flank_clearance) +
                       " [m] leaves no tooth in contact without load, so that the output has backlash. In a preloaded "
                       "gear about 5 % of the teeth are in contact");
  }
  if (const LossRow row =
          analyseLosses(sound, { sound.life.rated_speed }, { sound.life.rated_torque }, EFFICIENCY_POSITIONS, nullptr)
              .front();
      row.status.ok() && (row.gear_efficiency < 0.55 || row.gear_efficiency > 0.92))
  {
    warnings.push_back("the efficiency of the gear at life.rated_torque = " + shortNumber(sound.life.rated_torque) +
                       " [N.m] is " + shortNumber(row.gear_efficiency) +
                       " [-], but harmonic drives have 0.55 ... 0.92; check bearing.race_preload, "
                       "bearing.viscosity, mesh.friction_kinetic and life.rated_torque");
  }
  return warnings;
}
}  // namespace hjt
