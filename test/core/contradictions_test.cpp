// SPDX-License-Identifier: BSD-3-Clause
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/number_text.hpp"
#include "harmonic_joint_twin/base/errors.hpp"
#include "harmonic_joint_twin/params/parameter_map.hpp"
#include "params/field_table.hpp"
#include "test/core/parameters_support.hpp"
#include "test/support/temporary_folder.hpp"

namespace hjt
{
namespace
{
/// One check of parameter_map.cpp: what breaks it and nothing else, what is said, and what just keeps to it.
struct Contradiction
{
  std::vector<std::string> broken;
  std::string text;
  std::vector<std::string> kept;
};

std::vector<Contradiction> gearContradictions()
{
  return {
    { { "gear.teeth_flexspline=201", "gear.teeth_circular_spline=203" },
      "gear.teeth_flexspline = 201 [-] must be even",
      { "gear.teeth_flexspline=202", "gear.teeth_circular_spline=204" } },
    { { "gear.teeth_circular_spline=204" }, "gear.teeth_circular_spline = 204 [-] must be two more than", {} },
    { { "gear.teeth_circular_spline=201" }, "gear.teeth_circular_spline = 201 [-] must be two more than", {} },
    { { "gear.wave_amplitude=4.0e-3", "gear.flexspline_inner_radius=4.0e-3", "gear.tip_radius_circular_spline=8.0e-3" },
      "gear.wave_amplitude = 0.004 [m] must be less than",
      { "gear.wave_amplitude=3.9e-3", "gear.flexspline_inner_radius=4.0e-3",
        "gear.tip_radius_circular_spline=8.0e-3" } },
    { { "manufacture.flexspline_pitch_table=pitch.csv" },
      "manufacture.flexspline_pitch_table = 'pitch.csv' must be an absolute path",
      { "manufacture.flexspline_pitch_table=/pitch.csv" } },
    { { "manufacture.flexspline_pitch_table=/pitch.csv", "manufacture.flexspline_pitch_deviation=1e-9" },
      "manufacture.flexspline_pitch_deviation = 1.0e-9 [m] must be 0",
      { "manufacture.flexspline_pitch_deviation=1e-9" } },
    { { "manufacture.circular_spline_pitch_table=pitch.csv" },
      "manufacture.circular_spline_pitch_table = 'pitch.csv' must be an absolute path",
      { "manufacture.circular_spline_pitch_table=/pitch.csv" } },
    { { "manufacture.circular_spline_pitch_table=/pitch.csv", "manufacture.circular_spline_pitch_deviation=1e-9" },
      "manufacture.circular_spline_pitch_deviation = 1.0e-9 [m] must be 0",
      { "manufacture.circular_spline_pitch_deviation=1e-9" } },
    { { "cup.torsion_breakpoints=[14.0, 14.0]" },
      "cup.torsion_breakpoints = [14.0, 14.0] [N.m] must be ascending",
      { "cup.torsion_breakpoints=[14.0, 14.001]" } },
    { { "cup.torsion_stiffness=[31.0e+3, 60.0e+3, 57.0e+3]", "cup.wall_stiffness=60.0e+3" },
      "cup.wall_stiffness = 60000.0 [N.m/rad] must exceed",
      { "cup.torsion_stiffness=[31.0e+3, 60.0e+3, 57.0e+3]", "cup.wall_stiffness=60.1e+3" } },
    { { "mesh.profile=involute", "gear.tip_radius_circular_spline=0.5" },
      "mesh.profile needs teeth that reach into the circular spline",
      { "mesh.profile=trapezoid", "gear.tip_radius_circular_spline=0.5" } },
    { { "mesh.friction_static=0.1", "mesh.friction_kinetic=0.1001" },
      "mesh.friction_kinetic = 0.1001 [-] must not exceed",
      { "mesh.friction_static=0.1", "mesh.friction_kinetic=0.1" } },
    { { "bearing.ball_diameter=0.05", "bearing.pitch_diameter=0.05" },
      "bearing.ball_diameter = 0.05 [m] must be less than",
      { "bearing.ball_diameter=0.0499", "bearing.pitch_diameter=0.05" } },
  };
}

/// All of them.
std::vector<Contradiction> contradictionTable()
{
  std::vector<Contradiction> table = gearContradictions();
  const std::vector<Contradiction> others{
    { { "life.use_record=use.yaml" },
      "life.use_record = 'use.yaml' must be an absolute path",
      { "life.use_record=/use.yaml" } },
    { { "life.bearing_l10=7000", "life.bearing_l50=7000" },
      "life.bearing_l10 = 7000.0 [h] must be less than",
      { "life.bearing_l10=7000", "life.bearing_l50=7001" } },
    { { "life.endurance_limit=600e6", "life.ultimate_strength=600e6" },
      "life.endurance_limit = 6.0e+8 [Pa] must be less than",
      { "life.endurance_limit=600e6", "life.ultimate_strength=601e6" } },
    { { "life.face_width=0.03", "stress.cup_length=0.03" },
      "life.face_width = 0.03 [m] must be less than",
      { "life.face_width=0.03", "stress.cup_length=0.0301" } },
    { { "life.flank_wear_limit=2e-5", "fault_scale.tooth_wear_depth=1.9e-5" },
      "life.flank_wear_limit = 2.0e-5 [m] must not exceed fault_scale.tooth_wear_depth",
      { "life.flank_wear_limit=2e-5", "fault_scale.tooth_wear_depth=2e-5" } },
    { { "life.interface_wear_limit=2e-5", "fault_scale.interface_wear_depth=1.9e-5" },
      "life.interface_wear_limit = 2.0e-5 [m] must not exceed fault_scale.interface_wear_depth",
      { "life.interface_wear_limit=2e-5", "fault_scale.interface_wear_depth=2e-5" } },
    { { "solver.rate=30000", "publish.joint_states_rate=100", "publish.encoders_rate=100",
        "publish.contact_forces_rate=100", "publish.health_rate=100", "publish.stress_rate=100",
        "publish.indicators_rate=1" },
      "solver.rate = 30000.0 [Hz] must make a step of whole nanoseconds",
      { "solver.rate=20000" } },
    { { "publish.joint_states_rate=300" }, "publish.joint_states_rate = 300.0 [Hz] must divide", {} },
    { { "publish.joint_states_rate=20000" }, "publish.joint_states_rate = 20000.0 [Hz] must divide", {} },
    { { "publish.encoders_rate=300" }, "publish.encoders_rate = 300.0 [Hz] must divide", {} },
    { { "publish.contact_forces_rate=300" }, "publish.contact_forces_rate = 300.0 [Hz] must divide", {} },
    { { "publish.health_rate=300" }, "publish.health_rate = 300.0 [Hz] must divide", { "publish.health_rate=0.1" } },
    { { "publish.stress_rate=300" }, "publish.stress_rate = 300.0 [Hz] must divide", {} },
    { { "publish.indicators_rate=300" }, "publish.indicators_rate = 300.0 [Hz] must divide", {} },
    { { "indicators.sample_rate=3000" },
      "indicators.sample_rate = 3000.0 [Hz] must divide solver.rate = 10000.0 [Hz]; the nearest that do: 2500.0, "
      "3333.3333333333335 [Hz]",
      { "indicators.sample_rate=2500" } },
    { { "indicators.sample_rate=20000" },
      "indicators.sample_rate = 20000.0 [Hz] must divide solver.rate = 10000.0 [Hz]; the nearest that does: 10000.0 "
      "[Hz]",
      { "indicators.sample_rate=3333.3333333333335" } },
  };
  table.insert(table.end(), others.begin(), others.end());
  return table;
}

TEST(Contradictions, EachCheckRefusesWhatBreaksItAndNothingElse)
{
  for (const Contradiction& row : contradictionTable())
  {
    const std::string said = complaint(row.broken);
    EXPECT_THAT(said, HasSubstr(row.text));
    EXPECT_EQ(said.find('\n'), std::string::npos) << said;
    EXPECT_EQ(complaint(row.kept), "") << row.text;
  }
}

/// Faults are a list, which no assignment gives.
TEST(Contradictions, FaultsMustBeValidAndNotTooMany)
{
  const auto list_of = [](std::size_t count, const std::string& fault)
  {
    std::string text = "faults:\n";
    for (std::size_t i = 0; i < count; ++i)
    {
      text += "  - " + fault + "\n";
    }
    return YamlFile(text).complaint();
  };
  const std::string wear = "{kind: tooth_wear, severity: 0.1, place: -1, onset: 0.0}";
  EXPECT_EQ(list_of(MAX_FAULTS, wear), "");
  const std::string many = list_of(MAX_FAULTS + 1, wear);
  EXPECT_THAT(many, HasSubstr("more than " + std::to_string(MAX_FAULTS) + " faults"));
  EXPECT_EQ(many.find('\n'), std::string::npos) << many;
  EXPECT_EQ(list_of(1, "{kind: tooth_wear, severity: 0.1, place: 199, onset: 0.0}"), "");
  EXPECT_THAT(list_of(1, "{kind: tooth_wear, severity: 0.1, place: 200, onset: 0.0}"), HasSubstr("place = 200"));
}
}  // namespace
}  // namespace hjt
