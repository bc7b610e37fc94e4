// SPDX-License-Identifier: BSD-3-Clause
#include "statics/analysed_faults.hpp"

#include <string>

#include "base/number_text.hpp"
#include "harmonic_joint_twin/base/errors.hpp"
#include "model/faults/fault_edits.hpp"

namespace hjt
{
namespace
{
/// The effect of a fault that an analysis lacks; nullptr if it has part of the effect.
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
                           " s, but this analysis has no time: give it onset 0 or leave it out");
    }
    const char* missing = missingFor(fault, parameters, analysis);
    if (missing != nullptr)
    {
      throw ParameterError(name + " cannot act here: this analysis leaves out " + missing);
    }
  }
}
}  // namespace hjt
