// SPDX-License-Identifier: BSD-3-Clause
/// The FMI unit of one drive.

#include <utility>

#include "base/whole_file.hpp"
#include "fmu/drive_part.hpp"
#include "fmu/unit.hpp"

namespace hjt::fmu
{
namespace
{
class DriveSimulation : public Simulation
{
public:
  DriveSimulation(Twin twin, DrivePart part) : twin_(std::move(twin)), part_(std::move(part)) {}

  std::unique_ptr<Simulation> copy() const override { return std::make_unique<DriveSimulation>(twin_, part_); }

  bool step(const Values& values, double end) override
  {
    const std::uint64_t failures = twin_.counters().solver_failures;
    const Stamp until = stampAt(end) + twin_.stepLength() / 1000;  // with a tolerance for rounded sums of steps
    const Stamp last = until - twin_.stepLength();                 // last instant at which a step can begin
    if (twin_.stamp() <= last)
    {
      part_.giveInputs(twin_.stamp(), values, twin_);
    }
    while (twin_.stamp() <= last)
    {
      // The torque is commanded at every step, so that it does not time out.
      twin_.commandMotorTorque(twin_.stamp(), part_.motorTorque(values));
      twin_.step(until);
    }
    part_.moved();
    return twin_.counters().solver_failures == failures;
  }

  bool read(std::size_t reference, Values& values) override { return part_.read(reference, twin_, values); }
  bool marks(std::size_t reference) const override { return part_.marks(reference, twin_); }

private:
  Twin twin_;
  DrivePart part_;
};

class DriveUnit : public Unit
{
public:
  explicit DriveUnit(Parameters parameters) : parameters_(std::move(parameters))
  {
    variables_ = driveVariables(parameters_);
  }

  std::unique_ptr<Simulation> start(const Values& values, double start, const Notice& notice) const override
  {
    DrivePart part(variables_, TIME + 1, "");
    const Parameters parameters = part.parameters(parameters_, values);
    Twin twin(parameters, unitSurfaces(notice));
    twin.reset(stampAt(start));
    part.begin(values, parameters.brake.engaged_at_start);
    return std::make_unique<DriveSimulation>(std::move(twin), std::move(part));
  }

private:
  Parameters parameters_;
};
}  // namespace

std::unique_ptr<Unit> openUnit(const std::string& resources, const std::string& token)
{
  const std::string text = readFile(resources + PARAMETER_FILE);
  requireToken(token, text);
  return std::make_unique<DriveUnit>(readParameters(text, resources));
}
}  // namespace hjt::fmu
