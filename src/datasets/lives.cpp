// SPDX-License-Identifier: BSD-3-Clause
#include "datasets/lives.hpp"

#include <algorithm>
#include <array>
#include <filesystem>

#include <boost/random/mersenne_twister.hpp>

#include "statics/flexspline_stress.hpp"

namespace hjt
{
namespace
{
constexpr std::size_t MAX_CHECK_UPS = 1'000'000;  // largest number of check-ups of all drives of a plan together
// Number of positions of the wave generator within a tooth pitch at which the loads of a turn are computed.
constexpr int POSITIONS = 8;
/// Parts of the bearing where its first spall can occur.
constexpr std::array SPALLED{ FaultKind::BEARING_OUTER_RACE, FaultKind::BEARING_INNER_RACE, FaultKind::BEARING_BALL };
}  // namespace

Lives::Lives(const PlanNode& node, const Parameters& nominal, const std::string& directory, std::uint32_t seed)
  : split_(node)
  , fatigue_law_(nominal.life, nominal.stress)
  , fault_scale_(nominal.fault_scale)
  , rim_thickness_(nominal.gear.rim_thickness)
{
  constexpr double LONGEST = 100'000.0;    // default limit for the length of a life [h]
  constexpr double GREASE_SEVERITY = 0.3;  // default severity of lubricant_degradation with old grease [-]
  allowOnly(node, { "drives", "every", "longest", "duties", "grease_changes", "grease_severity", "test" });
  const PlanValues values;
  const std::int64_t drives = values.whole(node, "drives", "-", { 1, DriveSplit::MAX_DRIVES });
  const double every = values.number(node, "every", "h", { 1e-3, 1e9 });
  const double longest = values.number(node, "longest", "h", { 1e-3, 1e9 }, LONGEST);
  grease_severity_ = values.number(node, "grease_severity", "-", { 0.0, 1.0 }, GREASE_SEVERITY);
  const bool grease_changes = node.find("grease_changes") == nullptr || values.flag(node, "grease_changes");
  RevolutionLoadMap load_map(nominal, POSITIONS);
  readDuties(required(node, "duties", PlanNode::Kind::LIST), directory);
  std::vector<DriveAgeing> ageing;
  for (const auto& [name, duty] : duties_)
  {
    load_map.cover(duty, [](double) {});
  }
  for (const auto& [name, duty] : duties_)
  {
    ageing.emplace_back(nominal, duty, load_map);
  }
  const BearingLife bearing(nominal.life);
  for (std::uint64_t i = 0; i < static_cast<std::uint64_t>(drives); ++i)
  {
    const auto drawn = [&](const char* what, std::size_t count)
    { return static_cast<int>(drawnWord(seed, std::string("lives.") + what, i) % count); };
    const auto places = [&](FaultKind kind) { return static_cast<std::size_t>(lastPlace(kind, nominal)) + 1; };
    Drive drive;
    boost::random::mt19937 random(drawnWord(seed, "lives.nature", i));
    drive.variation = drawVariation(nominal.life, bearing, random);
    drive.duty = static_cast<std::size_t>(drawn("duty", duties_.size()));
    drive.spall.kind = SPALLED[static_cast<std::size_t>(drawn("spall", SPALLED.size()))];
    drive.spall.place = drawn("spall_place", places(drive.spall.kind));
    drive.crack_place = drawn("crack_place", places(FaultKind::FLEXSPLINE_CRACK));
    const auto visit = [&](double hours, const DriveAge& age)
    {
      if (check_ups_.size() > MAX_CHECK_UPS)
      {
        required(node, "every")
            .refuse("[h] makes more than " + std::to_string(MAX_CHECK_UPS) + " check-ups in the first " +
                    std::to_string(i + 1) + " of " + std::to_string(drives) + " drives");
      }
      check_ups_.push_back({ i, hours, age, stressAt(load_map, duties_[drive.duty].second, age) });
    };
    drive.life = ageing[drive.duty].live(drive.variation, longest, every, grease_changes, visit);
    check_ups_.pop_back();  // at the last instant of a life the drive is out of use
    drives_.push_back(drive);
  }
}

void Lives::readDuties(const PlanNode& files, const std::string& directory)
{
  const PlanValues values;
  for (const auto& [key, file] : files.entries)
  {
    const std::string name = values.text(files, key);
    duties_.emplace_back(name, DutyCycle::fromFile((std::filesystem::path(directory) / name).string()));
  }
  if (duties_.empty())
  {
    files.refuse("must name at least one duty cycle");
  }
}

double Lives::stressAt(const RevolutionLoadMap& load_map, const DutyCycle& duty, const DriveAge& age) const
{
  double largest = 0.0;
  for (const DutyPhase& phase : duty.phases)
  {
    const RevolutionLoad load = load_map.at(phase.load_torque, age.meanFlank(), age.interface_wear);
    for (std::size_t place = 0; place < STRESS_PLACES; ++place)
    {
      largest = std::max(largest, fatigue_law_.equivalentAmplitude(place, load.stress[place]));
    }
  }
  return largest;
}

std::vector<GrowingFault> Lives::faultsAt(std::uint64_t check_up) const
{
  const CheckUp& now = check_ups_[check_up];
  const Drive& drive = drives_[now.drive];
  const FaultScaleParameters& scale = fault_scale_;
  std::vector<GrowingFault> faults;
  const auto add = [&](FaultKind kind, double severity, int place)
  {
    if (severity > 0.0)
    {
      faults.push_back({ { kind, std::min(severity, 1.0), place, 0.0 }, 0.0 });
    }
  };
  add(FaultKind::TOOTH_WEAR, now.age.meanFlank() / scale.tooth_wear_depth, WHOLE_MEMBER);
  add(FaultKind::INTERFACE_WEAR, now.age.interface_wear / scale.interface_wear_depth, WHOLE_MEMBER);
  add(FaultKind::LUBRICANT_DEGRADATION, grease_severity_ * now.age.grease, WHOLE_MEMBER);
  add(FaultKind::FLEXSPLINE_CRACK, now.age.flaw_depth / (rim_thickness_ * scale.rim_crack_depth), drive.crack_place);
  add(drive.spall.kind, spallSize(drive.variation, now.age.bearing_turns), drive.spall.place);
  return faults;
}

std::vector<std::string> Lives::labelNames()
{
  return { "life.drive",        "life.split",          "life.duty",
           "life.hours",        "life.remaining",      "life.length",
           "life.cause",        "life.flank_wear",     "life.interface_wear",
           "life.grease",       "life.filling_factor", "life.flaw_depth",
           "life.spall",        "life.bearing_used",   "life.fatigue",
           "life.stress",       "life.flank_factor",   "life.interface_factor",
           "life.bearing_life", "life.spall_growth",   "life.strength",
           "life.transition" };
}

Lives::Labels Lives::labelsAt(std::uint64_t check_up) const
{
  const CheckUp& now = check_ups_[check_up];
  const Drive& drive = drives_[now.drive];
  const UnitVariation& nature = drive.variation;
  const std::vector<decltype(ParameterValue::value)> values{ static_cast<std::int64_t>(now.drive),
                                                             std::string(split_.nameOf(now.drive)),
                                                             duties_[drive.duty].first,
                                                             now.hours,
                                                             drive.life.hours - now.hours,
                                                             drive.life.hours,
                                                             std::string(nameOf(drive.life.end)),
                                                             now.age.worstFlank(),
                                                             now.age.interface_wear,
                                                             now.age.grease,
                                                             now.age.filling_factor,
                                                             now.age.flaw_depth,
                                                             spallSize(nature, now.age.bearing_turns),
                                                             now.age.bearing_turns / nature.bearing_life,
                                                             *std::max_element(now.age.fatigue.begin(),
                                                                               now.age.fatigue.end()),
                                                             now.stress,
                                                             nature.flank_factor,
                                                             nature.interface_factor,
                                                             nature.bearing_life,
                                                             nature.spall_growth,
                                                             nature.strength,
                                                             nature.transition };
  const std::vector<std::string> names = labelNames();
  Labels labels;
  for (std::size_t i = 0; i < names.size(); ++i)
  {
    labels.push_back({ names[i], { values[i], "" } });
  }
  return labels;
}

OrderedJson Lives::duties() const
{
  OrderedJson json = OrderedJson::object();
  for (const auto& [name, duty] : duties_)
  {
    for (const DutyPhase& phase : duty.phases)
    {
      json[name].push_back({ phase.duration, phase.motor_speed, phase.load_torque, phase.temperature });
    }
  }
  return json;
}
}  // namespace hjt
