// SPDX-License-Identifier: BSD-3-Clause
#include "fmu/drive_part.hpp"

#include <algorithm>
#include <memory>

#include "harmonic_joint_twin/params/parameter_map.hpp"
#include "surface/surface_cache.hpp"

namespace hjt::fmu
{
namespace
{
constexpr std::size_t KEPT_SURFACES = 8;

decltype(ParameterValue::value) valueOf(const FmuVariable& variable, const Value& value)
{
  switch (variable.type)
  {
    case Type::STRING:
      return value.text;
    case Type::BOOLEAN:
      return value.numbers[0] != 0.0;
    case Type::INT32:
      return static_cast<std::int64_t>(value.numbers[0]);
    case Type::FLOAT64:
      break;
  }
  if (variable.is_array)
  {
    return value.numbers;
  }
  return value.numbers[0];
}
}  // namespace

DrivePart::DrivePart(const std::vector<FmuVariable>& variables, std::size_t first, const std::string& prefix)
  : variables_(&variables), first_(first), end_(first + 1), prefix_size_(prefix.size())
{
  while (end_ < variables.size() && variables[end_].name.compare(0, prefix.size(), prefix) == 0)
  {
    ++end_;
  }
}

Parameters DrivePart::parameters(const Parameters& base, const Values& values) const
{
  ParameterMap changes;
  for (std::size_t i = first_ + placeReference(FAULT_KINDS); i < end_; ++i)
  {
    const FmuVariable& variable = (*variables_)[i];
    if (values[i].text != variable.start.text || values[i].numbers != variable.start.numbers)
    {
      changes[variable.name.substr(prefix_size_)] = { valueOf(variable, values[i]), "parameters of the instance" };
    }
  }
  Parameters parameters = base;
  parameters.input.temperature = values[first_ + TEMPERATURE].numbers[0];
  parameters.brake.engaged_at_start = values[first_ + BRAKE].numbers[0] != 0.0;
  changeFaults(values, parameters);
  changeParameters(parameters, changes);
  return parameters;
}

void DrivePart::changeFaults(const Values& values, Parameters& parameters) const
{
  for (std::size_t kind = 0; kind < FAULT_KINDS; ++kind)
  {
    const auto was = [&](std::size_t reference) { return (*variables_)[first_ + reference].start.numbers[0]; };
    const auto is = [&](std::size_t reference) { return values[first_ + reference].numbers[0]; };
    const std::size_t place = placeReference(kind);
    const Fault before{ static_cast<FaultKind>(kind), was(FIRST_FAULT + kind), static_cast<int>(was(place)) };
    const Fault now{ before.kind, is(FIRST_FAULT + kind), static_cast<int>(is(place)) };
    if (now.severity == before.severity && now.place == before.place)
    {
      continue;
    }
    std::vector<Fault>& faults = parameters.faults;
    faults.erase(std::remove_if(faults.begin(), faults.end(),
                                [&](const Fault& fault)
                                {
                                  return fault.kind == now.kind && fault.isActiveAtStart() &&
                                         (fault.place == before.place || fault.place == now.place);
                                }),
                 faults.end());
    if (now.severity > 0.0)
    {
      faults.push_back(now);
    }
  }
}

void DrivePart::begin(const Values& values, bool brake_engaged)
{
  given_.clear();
  for (std::size_t i = 0; i < FIRST_OUTPUT; ++i)
  {
    given_.push_back(values[first_ + i].numbers[0]);
  }
  given_[LOAD_TORQUE] = 0.0;
  given_[BRAKE] = brake_engaged ? 1.0 : 0.0;
}

void DrivePart::giveInputs(Stamp instant, const Values& values, Twin& twin)
{
  for (std::size_t i = LOAD_TORQUE; i < FIRST_OUTPUT; ++i)
  {
    const double value = values[first_ + i].numbers[0];
    if (value == given_[i])
    {
      continue;
    }
    given_[i] = value;
    if (i >= FIRST_FAULT)
    {
      const std::size_t kind = i - FIRST_FAULT;
      const auto place = static_cast<int>(values[first_ + placeReference(kind)].numbers[0]);
      twin.injectFault(instant, { static_cast<FaultKind>(kind), value, place });
      continue;
    }
    constexpr InputKind KINDS[]{ InputKind::LOAD_TORQUE, InputKind::TEMPERATURE, InputKind::BRAKE };
    twin.push({ instant, KINDS[i - LOAD_TORQUE], value });
  }
}

/// Reads an output. Indicators and assessment are computed only after the first reading of one of these outputs.
bool DrivePart::read(std::size_t reference, Twin& twin, Values& values)
{
  if ((*variables_)[reference].is_array)
  {
    return readTeeth(twin, values);
  }
  const ScalarOutput& output = scalar(reference);
  if (output.watches && !twin.watchesSignals())
  {
    twin.watchSignals(true);
  }
  values[reference].numbers[0] = output.of(twin, twin.outputs());
  return true;
}

bool DrivePart::marks(std::size_t reference, const Twin& twin) const
{
  return (*variables_)[reference].is_array ? !teeth_known_ : scalar(reference).watches && !twin.watchesSignals();
}

/// Reads the outputs of the teeth. On the response surface the twin solves a separate ring for these outputs.
bool DrivePart::readTeeth(Twin& twin, Values& values)
{
  if (teeth_known_)
  {
    return true;
  }
  if (!forces_)
  {
    forces_ = twin.makeToothForces();
  }
  teeth_known_ = true;
  const bool found = twin.toothForces(*forces_);
  std::size_t reference = first_ + FIRST_OUTPUT + scalarOutputs().size();
  for (const ToothOutput& output : toothOutputs())
  {
    values[reference++].numbers = (*forces_).*output.forces;
  }
  return found;
}

Parameters readParameters(const std::string& text, const std::string& folder)
{
  ParameterMap map;
  readDescription(text, PARAMETER_FILE, map);
  for (const char* key : FILE_PARAMETERS)
  {
    auto& name = std::get<std::string>(map.at(key).value);
    name = name == NO_FILE ? name : folder + name;
  }
  return parseParameters(map);
}

SurfaceSource unitSurfaces(const Notice& notice)
{
  static const auto POOL = std::make_shared<SurfacePool>(KEPT_SURFACES);
  SurfaceSource source;
  source.cache_directory = surfaceCacheDirectory();
  source.notice = notice;
  source.pool = POOL;
  return source;
}
}  // namespace hjt::fmu
