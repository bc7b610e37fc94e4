// SPDX-License-Identifier: BSD-3-Clause
#include "model/faults/joint_faults.hpp"

#include <array>
#include <cmath>
#include <cstdlib>

#include "gear/angle.hpp"
#include "harmonic_joint_twin/model/faults/fault_list.hpp"

namespace hjt
{
namespace
{
/// Applies `change` to values[place], or to all values if `place` is WHOLE_MEMBER.
template <class Change>
void atPlace(int place, Eigen::VectorXd& values, const Change& change) noexcept
{
  for (Eigen::Index i = 0; i < values.size(); ++i)
  {
    if (place == WHOLE_MEMBER || place == i)
    {
      change(values[i]);
    }
  }
}

/// Cracks a segment of the rim to the depth of `severity` times fault_scale.rim_crack_depth of the rim's thickness.
void crackRim(int segment, double severity, const Parameters& parameters, RingModel& ring) noexcept
{
  const double left = 1.0 - severity * parameters.fault_scale.rim_crack_depth;
  ring.edit<RimTension>().stiffness()[segment] *= left;
  ring.edit<RimBending>().stiffness()[segment] *= left * left * left;
}

void crackFlexspline(const Fault& fault, const Parameters& parameters, JointModel& joint) noexcept
{
  const int teeth = parameters.gear.teeth_flexspline;
  const int reach = parameters.fault_scale.rim_crack_segments;
  for (int i = 0; i < teeth; ++i)
  {
    const int apart = std::abs(i - fault.place);
    const int away = apart < teeth - apart ? apart : teeth - apart;
    if (away < reach)
    {
      crackRim(i, fault.severity * (1.0 - static_cast<double>(away) / reach), parameters, joint.ring);
    }
  }
}

/// Wear leaves a gap between rim and race and increases the friction between them. Wear of a single segment increases
/// the friction in proportion to the segment's share of the circumference.
void wearInterface(const Fault& fault, const Parameters& parameters, JointModel& joint) noexcept
{
  const double part = fault.place == WHOLE_MEMBER ? 1.0 : 1.0 / parameters.gear.teeth_flexspline;
  atPlace(fault.place, joint.ring.edit<WaveGeneratorContact>().gap(),
          [&](double& gap) { gap += fault.severity * parameters.fault_scale.interface_wear_depth; });
  joint.interface_friction.scale(1.0 +
                                 fault.severity * part * (parameters.fault_scale.interface_friction_factor - 1.0));
}

/// A buckled rim without forces has waves e cos(n psi), which change the curvature by (n^2 - 1) e cos(n psi) / r^2,
/// with the amplitude e, n waves in a turn, the angle psi of a tooth and the radius r of the rim.
void buckle(const Fault& fault, const Parameters& parameters, JointModel& joint) noexcept
{
  const FaultScaleParameters& scale = parameters.fault_scale;
  const int teeth = parameters.gear.teeth_flexspline;
  const int waves = scale.buckling_waves;
  const double radius = parameters.gear.flexspline_inner_radius;
  const double amplitude = fault.severity * scale.buckling_out_of_round * (waves * waves - 1.0) / radius;
  Eigen::VectorXd& natural_angle = joint.ring.edit<RimBending>().naturalAngle();
  for (int i = 0; i < teeth; ++i)
  {
    natural_angle[i] += amplitude * TWO_PI / teeth * std::cos(TWO_PI * waves * i / teeth);
  }
  joint.ring.edit<CupTorsion>().scaleWall(1.0 - fault.severity * scale.buckling_stiffness_loss);
}

/// Cracks the cup around the share x of its circumference. The remaining circumference carries the torque, so that the
/// compliance of the cracked section of the wall is multiplied by 1/(1 - x). `share`: compliance of this section over
/// that of the whole wall, both without the crack [-]. The faces of the crack rub on each other.
void crackCup(const Fault& fault, double share, const Parameters& parameters, JointModel& joint) noexcept
{
  const double cracked = fault.severity * parameters.fault_scale.cup_crack_fraction;
  joint.ring.edit<CupTorsion>().scaleWall(1.0 / (1.0 + share * cracked / (1.0 - cracked)));
  joint.cup_friction.scale(1.0 + fault.severity * (parameters.fault_scale.cup_crack_friction_factor - 1.0));
}

void crackRearSection(const Fault& fault, const Parameters& parameters, JointModel& joint) noexcept
{
  crackCup(fault, parameters.fault_scale.rear_section_share, parameters, joint);
}

void crackFlange(const Fault& fault, const Parameters& parameters, JointModel& joint) noexcept
{
  crackCup(fault, parameters.fault_scale.flange_share, parameters, joint);
}

void degradeLubricant(const Fault& fault, const Parameters& parameters, JointModel& joint) noexcept
{
  const double friction = 1.0 + fault.severity * (parameters.fault_scale.boundary_friction_factor - 1.0);
  joint.bearing.scaleViscosity(1.0 + fault.severity * (parameters.fault_scale.viscosity_factor - 1.0));
  joint.mesh_friction.scale(friction);
  joint.interface_friction.scale(friction);
}

/// Stiffness of a tooth pair over that of a sound pair [-]. `bending`: bending stiffness of the flexspline's tooth over
/// that of a sound tooth; `share`: share of the tooth's bending in the compliance of a sound pair [-].
double softened(double bending, double share) noexcept
{
  return bending / (bending + share * (1.0 - bending));
}

/// Bending stiffness of a tooth that lost the share `loss` of its thickness over that of a sound tooth, as cantilevers.
double thinned(double loss) noexcept
{
  const double left = loss < 1.0 ? 1.0 - loss : 0.0;
  return left * left * left;
}

/// Bending stiffness of a tooth over that of a sound tooth [-], if a crack along the middle has split the tooth from
/// the tip over the share `length` of its height. Two leaves of half the thickness bend four times as much as a tooth.
double split(double length) noexcept
{
  return 1.0 / (1.0 + 3.0 * length * length * length);
}
void wearTeeth(const Fault& fault, const Parameters& parameters, JointModel& joint) noexcept
{
  const GearParameters& gear = parameters.gear;
  const double across =
      fault.severity * parameters.fault_scale.tooth_wear_depth / std::cos(parameters.mesh.flank_angle);
  // At mid-height the thickness of a tooth is half of the tooth pitch.
  const double thickness = PI * (gear.flexspline_inner_radius + gear.toothMidHeight()) / gear.teeth_flexspline;
  const double factor = softened(thinned(2.0 * across / thickness), parameters.fault_scale.tooth_compliance_share);
  ToothMesh& mesh = joint.ring.edit<ToothMesh>();
  atPlace(fault.place, mesh.clearance(), [&](double& clearance) { clearance += across; });
  atPlace(fault.place, mesh.stiffness(), [&](double& stiffness) { stiffness *= factor; });
}

void crackToothRoot(const Fault& fault, const Parameters& parameters, JointModel& joint) noexcept
{
  if (rootCrackRunsThroughTooth(parameters.gear))
  {
    joint.ring.edit<ToothMesh>().stiffness()[fault.place] *=
        softened(thinned(fault.severity), parameters.fault_scale.tooth_compliance_share);
  }
  else
  {
    crackRim(fault.place, fault.severity, parameters, joint.ring);
  }
}

void crackToothTip(const Fault& fault, const Parameters& parameters, JointModel& joint) noexcept
{
  joint.ring.edit<ToothMesh>().stiffness()[fault.place] *=
      softened(split(fault.severity), parameters.fault_scale.tooth_compliance_share);
}

void pit(const Fault& fault, const Parameters& parameters, JointModel& joint) noexcept
{
  const double width = 1.0 - fault.severity * parameters.fault_scale.pitted_fraction;
  const double friction = 1.0 + fault.severity * (parameters.fault_scale.pitted_friction_factor - 1.0);
  atPlace(fault.place, joint.ring.edit<ToothMesh>().stiffness(), [&](double& stiffness) { stiffness *= width; });
  atPlace(fault.place, joint.mesh_friction.toothFactor(), [&](double& factor) { factor *= friction; });
}

/// Adds the damage by a jump of the teeth: worn tips, and a circular spline off the axis of the drive.
void ratchet(const Fault& fault, const Parameters& parameters, JointModel& joint) noexcept
{
  ToothMesh& mesh = joint.ring.edit<ToothMesh>();
  mesh.moveSpaces(fault.severity * parameters.fault_scale.ratcheting_eccentricity);
  mesh.tipLoss().array() += fault.severity * parameters.fault_scale.ratcheting_tip_loss;
}

/// The lobes wear, because they carry the largest force. Wear reduces the mean radius and loosens the bearing's races.
void wearWaveGenerator(const Fault& fault, const Parameters& parameters, JointModel& joint) noexcept
{
  const FaultScaleParameters& scale = parameters.fault_scale;
  const double depth = fault.severity * scale.wave_generator_wear_depth;
  const double lobe = fault.place == WHOLE_MEMBER || fault.place == 0 ? depth : 0.0;
  const double other_lobe = fault.place == WHOLE_MEMBER || fault.place == 1 ? depth : 0.0;
  joint.ring.edit<WaveGeneratorContact>().wear(lobe, other_lobe);
  joint.bearing.reducePreload(0.25 * (lobe + other_lobe) * scale.race_fit_stiffness, scale.race_bending_preload);
}

double placeOnRace(const Fault& fault, const Parameters& parameters) noexcept
{
  return TWO_PI * fault.place / parameters.gear.teeth_flexspline;
}

double spallDepth(const Fault& fault, const Parameters& parameters) noexcept
{
  return fault.severity * parameters.fault_scale.spall_depth;
}

RaceDeflection& bearingOf(JointModel& joint) noexcept
{
  return joint.ring.edit<WaveGeneratorContact>().bearing();
}

void spallInnerRace(const Fault& fault, const Parameters& parameters, JointModel& joint) noexcept
{
  bearingOf(joint).addInnerSpall(placeOnRace(fault, parameters), spallDepth(fault, parameters),
                                 parameters.fault_scale.spall_length);
}

void spallOuterRace(const Fault& fault, const Parameters& parameters, JointModel& joint) noexcept
{
  bearingOf(joint).addOuterSpall(placeOnRace(fault, parameters), spallDepth(fault, parameters),
                                 parameters.fault_scale.spall_length);
}

void spallBall(const Fault& fault, const Parameters& parameters, JointModel& joint) noexcept
{
  bearingOf(joint).addBallSpall(fault.place, spallDepth(fault, parameters), parameters.fault_scale.spall_length);
}

void breakCage(const Fault& fault, const Parameters& parameters, JointModel& joint) noexcept
{
  bearingOf(joint).addIdleBall(fault.place, fault.severity * parameters.fault_scale.cage_deflection);
}

struct Edit
{
  FaultKind kind;
  void (*edit)(const Fault& fault, const Parameters& parameters, JointModel& joint) noexcept;
  unsigned parts;  // parts of the joint that the fault changes, as bits of FaultPart
};
constexpr std::array EDITS{
  Edit{ FaultKind::INTERFACE_WEAR, wearInterface, GENERATOR_PART | FRICTION_PART },
  Edit{ FaultKind::REAR_SECTION_CRACK, crackRearSection, CUP_PART | FRICTION_PART },
  Edit{ FaultKind::LUBRICANT_DEGRADATION, degradeLubricant, FRICTION_PART },
  Edit{ FaultKind::TOOTH_WEAR, wearTeeth, MESH_PART },
  Edit{ FaultKind::TOOTH_ROOT_CRACK, crackToothRoot, MESH_PART },
  Edit{ FaultKind::FLANGE_CRACK, crackFlange, CUP_PART | FRICTION_PART },
  Edit{ FaultKind::TOOTH_TIP_CRACK, crackToothTip, MESH_PART },
  Edit{ FaultKind::PITTING, pit, MESH_PART | FRICTION_PART },
  Edit{ FaultKind::WAVE_GENERATOR_WEAR, wearWaveGenerator, GENERATOR_PART | FRICTION_PART },
  Edit{ FaultKind::FLEXSPLINE_CRACK, crackFlexspline, RIM_PART },
  Edit{ FaultKind::BUCKLING, buckle, RIM_PART | CUP_PART },
  Edit{ FaultKind::RATCHETING, ratchet, MESH_PART },
  Edit{ FaultKind::BEARING_INNER_RACE, spallInnerRace, GENERATOR_PART },
  Edit{ FaultKind::BEARING_OUTER_RACE, spallOuterRace, GENERATOR_PART },
  Edit{ FaultKind::BEARING_BALL, spallBall, GENERATOR_PART },
  Edit{ FaultKind::BEARING_CAGE, breakCage, GENERATOR_PART },
};
static_assert(hasRowsInOrder(EDITS), "one edit for each FaultKind, in its order");
}  // namespace

bool rootCrackRunsThroughTooth(const GearParameters& gear) noexcept
{
  return gear.rim_thickness > gear.tooth_height_flexspline;
}

unsigned partsOf(const Fault& fault, const GearParameters& gear) noexcept
{
  const bool into_rim = fault.kind == FaultKind::TOOTH_ROOT_CRACK && !rootCrackRunsThroughTooth(gear);
  return into_rim ? static_cast<unsigned>(RIM_PART) : EDITS[static_cast<std::size_t>(fault.kind)].parts;
}

void addFault(const Fault& fault, const Parameters& parameters, JointModel& joint) noexcept
{
  EDITS[static_cast<std::size_t>(fault.kind)].edit(fault, parameters, joint);
}

namespace
{
bool before(const Fault& a, const Fault& b) noexcept
{
  return a.kind != b.kind ? a.kind < b.kind : a.place < b.place;
}
}  // namespace

bool FaultList::set(const Fault& fault, std::int64_t since) noexcept
{
  std::size_t place = 0;
  while (place < size_ && before(faults_[place].fault, fault))
  {
    ++place;
  }
  const bool known = place < size_ && !before(fault, faults_[place].fault);
  if (fault.severity == 0.0)
  {
    if (known)
    {
      ++version_;
      for (--size_; place < size_; ++place)
      {
        faults_[place] = faults_[place + 1];
      }
    }
    return true;
  }
  if (known && faults_[place].fault.severity == fault.severity)
  {
    return true;
  }
  if (!known)
  {
    if (size_ == faults_.size())
    {
      return false;
    }
    for (std::size_t i = size_++; i > place; --i)
    {
      faults_[i] = faults_[i - 1];
    }
  }
  ++version_;
  faults_[place] = { fault, since };
  return true;
}
}  // namespace hjt
