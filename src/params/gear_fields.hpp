// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// @file Rows of the table of parameters (params/field_table.hpp) for the gear, its stress and its faults.

#include <limits>

#include "base/range.hpp"
#include "harmonic_joint_twin/params/parameters.hpp"

namespace hjt
{
/// Response surfaces that a parameter changes.
enum class Shapes
{
  SURFACE,  ///< all surfaces: the parameter changes the ring's equilibrium, or friction that depends on the angle
  FAULTS,   ///< only the surfaces of a drive with faults
  OTHERS    ///< no surface, for example because a step of the twin adds the parameter's effect to the table's values
};

/// Meaning of a parameter, and the response surfaces that the parameter changes: by default all surfaces.
struct Meaning
{
  // not explicit, because most rows of the table give only the text
  Meaning(const char* meaning, Shapes shaped = Shapes::SURFACE) : text(meaning), shapes(shaped) {}

  const char* text;
  Shapes shapes;
};

inline Meaning ofFaults(const char* text)
{
  return { text, Shapes::FAULTS };
}

inline Meaning ofOthers(const char* text)
{
  return { text, Shapes::OTHERS };
}

constexpr double NO_LIMIT = std::numeric_limits<double>::max();
constexpr Range ERROR_SHIFT{ -1e-4, 1e-4 };  ///< range of errors of manufacture and of contact.fit [m]

template <class P, class Visitor>
void visitGear(P& p, Visitor& visit)
{
  visit("gear.teeth_flexspline", "-", p.gear.teeth_flexspline, Range{ 8, 4000 },
        "number of teeth of the flexspline, even");
  visit("gear.teeth_circular_spline", "-", p.gear.teeth_circular_spline, Range{ 10, 4002 },
        "number of teeth of the circular spline: gear.teeth_flexspline + 2");
  visit("gear.flexspline_inner_radius", "m", p.gear.flexspline_inner_radius, Range{ 1e-3, 1.0 },
        "inner radius of the undeformed flexspline, also the mean radius of the wave generator");
  visit("gear.wave_amplitude", "m", p.gear.wave_amplitude, Range{ 0.0, 1e-2 },
        "w0: the wave generator's semi-axes are the inner radius plus and minus w0");
  visit("gear.rim_thickness", "m", p.gear.rim_thickness, Range{ 1e-5, 1e-1 },
        "thickness of the flexspline's rim under the teeth");
  visit("gear.tooth_height_flexspline", "m", p.gear.tooth_height_flexspline, Range{ 1e-5, 1e-1 },
        "height of a flexspline tooth");
  visit("gear.tip_radius_circular_spline", "m", p.gear.tip_radius_circular_spline, Range{ 1e-3, 1.0 },
        "tip radius of the circular spline's teeth");
}

template <class P, class Visitor>
void visitManufacture(P& p, Visitor& visit)
{
  const Range pitch_deviation{ 0.0, 1e-4 };
  const Range seed{ 0, 99999 };
  visit("manufacture.flexspline_pitch_deviation", "m", p.manufacture.flexspline_pitch.deviation, pitch_deviation,
        "total cumulative pitch deviation Fp of the flexspline's teeth at mid-height (ISO 1328-1)");
  visit("manufacture.flexspline_pitch_seed", "-", p.manufacture.flexspline_pitch.seed, seed,
        "seed of the pitch deviations: each seed stands for one gear");
  visit("manufacture.flexspline_pitch_table", p.manufacture.flexspline_pitch.table,
        "none, or the absolute path of a CSV file (tooth, deviation [m]) that replaces deviation and seed");
  visit("manufacture.circular_spline_pitch_deviation", "m", p.manufacture.circular_spline_pitch.deviation,
        pitch_deviation, "total cumulative pitch deviation Fp of the circular spline's spaces at mid-height");
  visit("manufacture.circular_spline_pitch_seed", "-", p.manufacture.circular_spline_pitch.seed, seed,
        "seed of the pitch deviations: each seed stands for one gear");
  visit("manufacture.circular_spline_pitch_table", p.manufacture.circular_spline_pitch.table,
        "none, or the absolute path of a CSV file (space, deviation [m]) that replaces deviation and seed");
  visit("manufacture.flexspline_eccentricity", "m", p.manufacture.flexspline_eccentricity, ERROR_SHIFT,
        "x and y of the centre of the flexspline's teeth relative to its bore, in the axes of the housing");
  visit("manufacture.circular_spline_eccentricity", "m", p.manufacture.circular_spline_eccentricity, ERROR_SHIFT,
        "x and y of the centre of the circular spline's spaces, relative to the output's axis, at output angle 0");
  visit("manufacture.circular_spline_ellipticity", "m", p.manufacture.circular_spline_ellipticity, ERROR_SHIFT,
        "e1 and e2 of the bent circular spline, whose radius changes by e1 cos 2a + e2 sin 2a, a = angle from space 0");
  visit("manufacture.wave_generator_eccentricity", "m", p.manufacture.wave_generator_eccentricity, ERROR_SHIFT,
        "centre of the wave generator's ellipse, relative to the motor's axis, along the major and the minor axis");
  visit("manufacture.wave_generator_ellipticity", "m", p.manufacture.wave_generator_ellipticity, ERROR_SHIFT,
        "amplitude of the wave generator minus gear.wave_amplitude, to which the teeth were cut");
}

template <class P, class Visitor>
void visitRing(P& p, Visitor& visit)
{
  visit("ring.mass", "kg", p.ring.mass, Range{ 1e-9, 1e3 },
        ofOthers("mass of the toothed rim, spread evenly over the teeth; only the dynamic ring uses this mass"));
  visit("ring.tension_stiffness", "N/m", p.ring.tension_stiffness, Range{ 1.0, 1e13 },
        "axial stiffness of the rim between neighbouring teeth");
  visit("ring.tension_damping", "N.s/m", p.ring.tension_damping, Range{ 0.0, 1e6 },
        "damping of the rim between neighbouring teeth");
  visit("ring.tooth_damping", "N.s/m", p.ring.tooth_damping, Range{ 0.0, 1e6 },
        "damping of each tooth against the housing");
  visit("ring.bending_stiffness", "N.m/rad", p.ring.bending_stiffness, Range{ 0.0, 1e8 },
        "bending stiffness of a segment of the rim");
  visit("ring.bending_law", p.ring.bending_law,
        "rotation that bending resists; curvature: that between neighbouring segments; absolute: that of a segment "
        "from rest");
  visit("ring.loss_factor", "-", p.ring.loss_factor, Range{ 0.0, 1.0 },
        "loss factor of rim and outer race in bending: energy lost in a cycle over 2 pi times the largest stored "
        "energy; 0 = elastic");
}

template <class P, class Visitor>
void visitContact(P& p, Visitor& visit)
{
  visit("contact.support", p.contact.support,
        "springs: a spring at each tooth on a rigid ellipse; balls: the balls of the bearing by Hertz' law, spread "
        "evenly "
        "around the ring; single_balls: each ball at its own angle");
  visit("contact.stiffness", "N/m", p.contact.stiffness, Range{ 1.0, 1e12 },
        "stiffness between wave generator and flexspline for each tooth, with contact.support = springs");
  visit("contact.fit", "m", p.contact.fit, ERROR_SHIFT,
        "mean radius of the wave generator minus the flexspline's inner radius; > 0 interference, < 0 clearance");
  visit("contact.temperature_difference", "K", p.contact.temperature_difference, Range{ -100.0, 100.0 },
        "temperature of the wave generator minus that of the flexspline's rim; thermal expansion then changes the fit");
  visit("contact.damping", "N.s/m", p.contact.damping, Range{ 0.0, 1e6 },
        "damping between wave generator and flexspline for each tooth");
  visit("contact.law", p.contact.law,
        "direction of the contact force; normal: true normal of the ellipse; polar: normal at the polar angle of the "
        "tooth (an approximation of the thesis)");
  visit("contact.smoothing", "m", p.contact.smoothing, Range{ 0.0, 1e-4 },
        "depth over which the contact force sets in smoothly (C1), with contact.support = springs; 0 = no smoothing");
  visit("contact.friction_coefficient", "-", p.contact.friction_coefficient, Range{ 0.0, 2.0 },
        "coefficient of friction between the bearing's outer race and the flexspline");
  visit("contact.slip_lever", "m", p.contact.slip_lever, Range{ 0.0, 1e-1 },
        "distance between the neutral fibres of rim and outer race, the lever of the slip between them");
}

template <class P, class Visitor>
void visitMesh(P& p, Visitor& visit)
{
  visit("mesh.profile", p.mesh.profile, "shape of the tooth flanks (thesis section 3.2)");
  visit("mesh.stiffness", "N/m", p.mesh.stiffness, Range{ 0.0, 1e12 },
        "stiffness of a tooth pair along the flank normal");
  visit("mesh.flank_angle", "rad", p.mesh.flank_angle, Range{ 0.0, 1.4 }, "angle between flank and axis of the tooth");
  visit("mesh.tangent_angle", "rad", p.mesh.tangent_angle, Range{ 0.0, 1.4 },
        "double arc: angle between the common tangent of both arcs and the axis of the tooth");
  visit("mesh.tangent_length", "m", p.mesh.tangent_length, Range{ 0.0, 1e-2 },
        "double arc: part of the tooth's height, about mid-height, along which the common tangent is the flank");
  visit("mesh.flank_clearance", "m", p.mesh.flank_clearance, Range{ -1e-3, 1e-3 },
        "half the clearance of a tooth in its space at full engagement; < 0 interference");
  visit("mesh.engagement_depth", "m", p.mesh.engagement_depth, Range{ 1e-9, 1e-2 },
        "depth of engagement over which a tooth's stiffness grows from zero to mesh.stiffness");
  visit("mesh.smoothing", "m", p.mesh.smoothing, Range{ 0.0, 1e-4 },
        "depth over which the contact force sets in smoothly (C1); 0 = no smoothing");
  visit("mesh.friction_static", "-", p.mesh.friction_static, Range{ 0.0, 2.0 },
        "coefficient of flank friction at rest");
  visit("mesh.friction_kinetic", "-", p.mesh.friction_kinetic, Range{ 0.0, 2.0 },
        ofOthers("coefficient of flank friction in sliding"));
  visit("mesh.stribeck_velocity", "m/s", p.mesh.stribeck_velocity, Range{ 1e-9, 1e3 },
        ofOthers("sliding speed at which friction changes from static to kinetic (Stribeck)"));
}

template <class P, class Visitor>
void visitCup(P& p, Visitor& visit)
{
  visit("cup.torsion_stiffness", "N.m/rad", p.cup.torsion_stiffness, Range{ 1.0, 1e9 },
        "slopes of the cup's torque over its mean rotation, below, between and above the breakpoints");
  visit("cup.torsion_breakpoints", "N.m", p.cup.torsion_breakpoints, Range{ 0.0, 1e6 },
        "torques at which the slope of the cup changes, ascending");
  visit("cup.wall_stiffness", "N.m/rad", p.cup.wall_stiffness, Range{ 1.0, 1e9 },
        "stiffness of the cup's wall and diaphragm, which cracks and buckling of the cup reduce; more than "
        "cup.torsion_stiffness");
  visit("cup.friction_torque", "N.m", p.cup.friction_torque, Range{ 0.0, 1e4 },
        ofOthers("dry friction in parallel to the cup's spring: half the height of the hysteresis loop of the cup"));
  visit("cup.friction_angle", "rad", p.cup.friction_angle, Range{ 0.0, 1.0 },
        ofOthers("twist after a reversal over which cup.friction_torque builds up; 0 = at once"));
}

template <class P, class Visitor>
void visitBearing(P& p, Visitor& visit)
{
  visit("bearing.lubricant_factor", "-", p.bearing.lubricant_factor, Range{ 0.0, 100.0 },
        ofOthers("f0 of Palmgren's law of rolling friction"));
  visit("bearing.load_factor", "-", p.bearing.load_factor, Range{ 0.0, 1.0 },
        "f1 of Palmgren's law of rolling friction");
  visit("bearing.race_preload", "N", p.bearing.race_preload, Range{ 0.0, 1e6 },
        "sum of the ball forces that do not bend the rim: those by the fit of the bearing's outer race and, if "
        "race_bending_stiffness is 0, those that bend this race");
  visit("bearing.race_bending_stiffness", "N.m/rad", p.bearing.race_bending_stiffness, Range{ 0.0, 1e8 },
        "bending stiffness of the bearing's outer race over the length of a segment of the rim");
  visit("bearing.pitch_diameter", "m", p.bearing.pitch_diameter, Range{ 1e-3, 1.0 }, "pitch diameter of the balls");
  visit("bearing.balls", "-", p.bearing.balls, Range{ 3, 1000 }, "number of balls of the bearing");
  visit("bearing.ball_diameter", "m", p.bearing.ball_diameter, Range{ 1e-4, 1.0 },
        "diameter of a ball, less than bearing.pitch_diameter");
  visit("bearing.cage_slip", "-", p.bearing.cage_slip, Range{ 0.0, 0.2 },
        ofFaults("relative reduction of the speed of cage and balls by slip"));
  visit("bearing.viscosity", "m^2/s", p.bearing.viscosity, Range{ 1e-7, 1e-1 },
        ofOthers("effective kinematic viscosity of the grease at bearing.viscosity_temperature"));
  visit("bearing.oil_viscosity", "m^2/s", p.bearing.oil_viscosity, Range{ 1e-6, 1e-1 },
        ofOthers("kinematic viscosity of the grease's base oil at bearing.viscosity_temperature; with "
                 "bearing.viscosity_slope it determines the effect of the temperature"));
  visit("bearing.viscosity_temperature", "degC", p.bearing.viscosity_temperature, Range{ -60.0, 200.0 },
        ofOthers("temperature for which bearing.viscosity and bearing.oil_viscosity hold"));
  visit("bearing.viscosity_slope", "-", p.bearing.viscosity_slope, Range{ 0.0, 10.0 },
        ofOthers("slope m of the base oil in the viscosity-temperature chart (Walther, ASTM D341)"));
  visit("bearing.constant_share", "-", p.bearing.constant_share, Range{ 0.0, 1.0 },
        ofOthers("share of the viscous friction at bearing.viscosity_temperature that does not depend on temperature"));
}

template <class P, class Visitor>
void visitStress(P& p, Visitor& visit)
{
  visit("stress.tooth_base", "-", p.stress.tooth_base, Range{ 0.0, 0.99 },
        ofOthers("width of a flexspline tooth at its base over the tooth pitch"));
  visit("stress.wall_thickness", "m", p.stress.wall_thickness, Range{ 1e-5, 0.1 },
        ofOthers("thickness of the cup's wall"));
  visit("stress.cup_length", "m", p.stress.cup_length, Range{ 1e-3, 1.0 },
        ofOthers("length of the cup from the open end to the flange, with the teeth; more than life.face_width"));
  visit("stress.coning_restraint", "-", p.stress.coning_restraint, Range{ 0.0, 1.0 },
        ofOthers("restraint of the toothed rim's coning by the bearing; 0: none, 1: complete"));
  visit("stress.warping_restraint", "-", p.stress.warping_restraint, Range{ 0.0, 1.0 },
        ofOthers("restraint of the cup's warping by the flange; 0: none, 1: built in"));
  visit("stress.concentration", "-", p.stress.concentration, Range{ 1.0, 10.0 },
        ofOthers("largest over nominal stress at three places: tooth space, transition from the toothed rim to the "
                 "cup, flange"));
  visit("stress.notch_radius", "m", p.stress.notch_radius, Range{ 1e-6, 0.1 },
        ofOthers("radii of the fillets at the places of stress.concentration"));
}

template <class P, class Visitor>
void visitFaultScale(P& p, Visitor& visit)
{
  auto& scale = p.fault_scale;
  const Range depth{ 0.0, 1e-3 };
  const Range part{ 0.0, 1.0 };
  const Range factor{ 1.0, 100.0 };
  visit("fault_scale.interface_wear_depth", "m", scale.interface_wear_depth, depth,
        ofFaults("interface_wear at severity 1: sum of the radial wear of rim and outer race"));
  visit("fault_scale.interface_friction_factor", "-", scale.interface_friction_factor, factor,
        ofFaults("interface_wear at severity 1: factor on contact.friction_coefficient"));
  visit("fault_scale.cup_crack_fraction", "-", scale.cup_crack_fraction, Range{ 0.0, 0.99 },
        ofFaults("rear_section_crack, flange_crack at severity 1: cracked share of the circumference"));
  visit("fault_scale.rear_section_share", "-", scale.rear_section_share, part,
        ofFaults("share of the section behind the teeth in the torsional compliance of the cup's wall and diaphragm"));
  visit("fault_scale.flange_share", "-", scale.flange_share, part,
        ofFaults("share of the section at the flange in the torsional compliance of the cup's wall and diaphragm"));
  visit("fault_scale.cup_crack_friction_factor", "-", scale.cup_crack_friction_factor, factor,
        ofFaults("rear_section_crack, flange_crack at severity 1: factor on cup.friction_torque"));
  visit("fault_scale.viscosity_factor", "-", scale.viscosity_factor, Range{ 0.01, 100.0 },
        ofFaults("lubricant_degradation at severity 1: factor on the viscosity of the grease"));
  visit("fault_scale.boundary_friction_factor", "-", scale.boundary_friction_factor, factor,
        ofFaults("lubricant_degradation at severity 1: factor on the friction of the flanks and of the outer race"));
  visit("fault_scale.tooth_wear_depth", "m", scale.tooth_wear_depth, depth,
        ofFaults("tooth_wear at severity 1: wear of each flank along its normal"));
  visit("fault_scale.tooth_compliance_share", "-", scale.tooth_compliance_share, Range{ 0.01, 1.0 },
        ofFaults("share of the bending of the flexspline's tooth in the compliance of a tooth pair"));
  visit("fault_scale.pitted_fraction", "-", scale.pitted_fraction, part,
        ofFaults("pitting at severity 1: share of the flank's width that no longer carries load"));
  visit("fault_scale.pitted_friction_factor", "-", scale.pitted_friction_factor, factor,
        ofFaults("pitting at severity 1: factor on the friction of the pitted tooth's flanks"));
  visit("fault_scale.wave_generator_wear_depth", "m", scale.wave_generator_wear_depth, depth,
        ofFaults("wave_generator_wear at severity 1: reduction of the major semi-axis"));
  visit("fault_scale.race_fit_stiffness", "N/m", scale.race_fit_stiffness, Range{ 0.0, 1e12 },
        ofFaults("reduction of bearing.race_preload over reduction of the wave generator's mean radius"));
  visit("fault_scale.race_bending_preload", "N", scale.race_bending_preload, Range{ 0.0, 1e6 },
        ofFaults("part of bearing.race_preload that bends the race, which wear does not reduce"));
  visit("fault_scale.rim_crack_depth", "-", scale.rim_crack_depth, Range{ 0.0, 0.99 },
        ofFaults("crack of the rim at severity 1: depth of the crack over the thickness of the rim"));
  visit("fault_scale.rim_crack_segments", "-", scale.rim_crack_segments, Range{ 1, 100 },
        ofFaults("flexspline_crack: number of segments on each side of the crack over which its depth falls to zero"));
  visit("fault_scale.buckling_stiffness_loss", "-", scale.buckling_stiffness_loss, Range{ 0.0, 0.99 },
        ofFaults("buckling at severity 1: relative reduction of the stiffness of the cup's wall"));
  visit("fault_scale.buckling_out_of_round", "m", scale.buckling_out_of_round, depth,
        ofFaults("buckling at severity 1: radial amplitude of the permanent waves of the free rim"));
  visit("fault_scale.buckling_waves", "-", scale.buckling_waves, Range{ 2, 20 },
        ofFaults("number of waves around the buckled rim"));
  visit("fault_scale.ratcheting_eccentricity", "m", scale.ratcheting_eccentricity, Range{ 0.0, 1e-4 },
        ofFaults(
            "ratcheting at severity 1: offset of the circular spline's centre from the drive's axis, towards space 0"));
  visit("fault_scale.ratcheting_tip_loss", "m", scale.ratcheting_tip_loss, depth,
        ofFaults("ratcheting at severity 1: reduction of the height of every tooth"));
  visit("fault_scale.spall_depth", "m", scale.spall_depth, depth,
        ofFaults("depth of a spall in the bearing at severity 1"));
  visit("fault_scale.spall_length", "m", scale.spall_length, Range{ 1e-5, 1e-2 },
        ofFaults("length of a spall in the bearing, along the race or on the ball"));
  visit("fault_scale.cage_deflection", "m", scale.cage_deflection, depth,
        ofFaults("bearing_cage at severity 1: deflection of the outer race at the ball that carries no load"));
}
}  // namespace hjt
