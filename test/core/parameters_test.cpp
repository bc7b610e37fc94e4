// SPDX-License-Identifier: BSD-3-Clause

#include <cmath>
#include <vector>

#include <gmock/gmock.h>

#include "base/number_text.hpp"
#include "harmonic_joint_twin/params/parameter_map.hpp"
#include "params/field_table.hpp"
#include "test/core/complaint.hpp"
#include "test/support/temporary_folder.hpp"

namespace hjt
{
namespace
{
using testing::HasSubstr;
namespace fs = std::filesystem;

const fs::path CONFIG(HJT_TEST_CONFIG_DIR);
const ParameterMap& defaultMap()
{
  static const ParameterMap MAP = []
  {
    ParameterMap read;
    readDefaultConfiguration(CONFIG, read);
    return read;
  }();
  return MAP;
}

/// What is said about the defaults with these `section.key=value` over them; empty if they are accepted.
std::string complaint(const std::vector<std::string>& assignments)
{
  return complaintOf(
      [&]
      {
        ParameterMap map = defaultMap();
        for (const std::string& assignment : assignments)
        {
          readAssignment(assignment, map);
        }
        parseParameters(map);
      });
}

/// A YAML file with this text, removed at the end of the test.
class YamlFile
{
public:
  explicit YamlFile(const std::string& text) : path_(folder_.write("parameters.yaml", text)) {}

  std::string path() const { return path_; }

  std::string complaint() const
  {
    return complaintOf(
        [&]
        {
          ParameterMap map = defaultMap();
          readYamlFile(path(), map);
          parseParameters(map);
        });
  }

private:
  TemporaryFolder folder_;
  std::string path_;
};

std::vector<std::string> allKeys()
{
  std::vector<std::string> keys;
  const Parameters parameters;
  visitFields(parameters, [&](const std::string& key, const auto&...) { keys.push_back(key); });
  return keys;
}

using testing::AllOf;

TEST(ShippedConfiguration, IsCompleteAndValid)
{
  const Parameters parameters = parseParameters(defaultMap());
  EXPECT_EQ(parameters.gear.teeth_flexspline, 200);
  EXPECT_EQ(parameters.ring.tension_stiffness, 5e9);
  EXPECT_EQ(parameters.mesh.flank_clearance, -1e-6);
  EXPECT_EQ(parameters.cup.torsion_stiffness[2], 65.2e3);
  EXPECT_EQ(parameters.contact.law, ContactLaw::NORMAL);
  EXPECT_FALSE(parameters.brake.engaged_at_start);
}

TEST(ShippedConfiguration, EveryOverlayIsValidOverTheDefaults)
{
  int overlays = 0;
  for (const auto& entry : fs::recursive_directory_iterator(CONFIG))
  {
    // Files of arms and of signatures have keys of their own.
    const fs::path folder = entry.path().parent_path().filename();
    if (entry.path().extension() != ".yaml" || folder == "arms" || folder == "signatures")
    {
      continue;
    }
    ParameterMap map = defaultMap();
    readYamlFile(entry.path(), map);
    EXPECT_NO_THROW(parseParameters(map)) << entry.path();
    ++overlays;
  }
  EXPECT_GE(overlays, 12);
}

TEST(ShippedConfiguration, TellsUnitAndRangeOfEveryKeyAboveIt)
{
  std::string text = "\n";
  std::ifstream stages(CONFIG / "stages");
  for (std::string stage; std::getline(stages, stage);)
  {
    std::ifstream file(CONFIG / stage);
    std::string section;
    std::string comment;
    for (std::string line; std::getline(file, line);)
    {
      if (line.rfind("  # ", 0) == 0)
      {
        comment += line.substr(3);
      }
      else if (line.rfind("  ", 0) == 0)
      {
        text += section + line.substr(2, line.find(':') - 2) + comment + "\n";
        comment.clear();
      }
      else
      {
        section = line.substr(0, line.find(':')) + ".";
      }
    }
  }
  const Parameters parameters;
  visitFields(parameters,
              [&](const std::string& key, const auto&... rest)
              {
                const auto expected = [&](const char* unit, const auto&, const Range& range, const Meaning&)
                { return "[" + std::string(unit) + "]; " + rangeText(range); };
                if constexpr (sizeof...(rest) == 4)
                {
                  const std::size_t line = text.find("\n" + key + " ");
                  ASSERT_NE(line, std::string::npos) << key;
                  EXPECT_THAT(text.substr(line, text.find('\n', line + 1) - line), HasSubstr(expected(rest...))) << key;
                }
              });
}

TEST(ShippedConfiguration, OverlayWinsOverTheDefaults)
{
  ParameterMap map = defaultMap();
  readYamlFile(CONFIG / "thesis_insertion.yaml", map);
  EXPECT_EQ(parseParameters(map).contact.law, ContactLaw::POLAR);
  EXPECT_EQ(parseParameters(map).ring.bending_law, BendingLaw::ABSOLUTE);
  readAssignment("contact.law=normal", map);
  EXPECT_EQ(parseParameters(map).contact.law, ContactLaw::NORMAL);
}

TEST(Parameters, EveryKeyIsRequired)
{
  for (const std::string& key : allKeys())
  {
    ParameterMap map = defaultMap();
    ASSERT_EQ(map.erase(key), 1U) << key;
    EXPECT_THAT(complaintOf([&] { parseParameters(map); }), AllOf(HasSubstr(key), HasSubstr("missing")));
  }
}

/// What is said about the defaults with this number for a key whose field is `field`.
template <class Field>
std::string complaintWith(const std::string& key, const Field& field, double number)
{
  ParameterMap map = defaultMap();
  if constexpr (std::is_same_v<Field, int>)
  {
    map[key] = { static_cast<std::int64_t>(number), "here" };
  }
  else if constexpr (std::is_same_v<Field, double>)
  {
    map[key] = { number, "here" };
  }
  else
  {
    map[key] = { std::vector<double>(field.size(), number), "here" };
  }
  return complaintOf([&] { parseParameters(map); });
}

TEST(Parameters, EveryRangeIsHeldAtBothEnds)
{
  const Parameters parameters;
  visitFields(parameters,
              [&](const std::string& key, const auto&... rest)
              {
                if constexpr (sizeof...(rest) == 4)
                {
                  const auto check = [&](const char* unit, const auto& value, const Range& range, const Meaning&)
                  {
                    const bool whole = std::is_same_v<std::decay_t<decltype(value)>, int>;
                    const auto beyond = [whole](double end, double side)
                    { return whole ? end + std::copysign(1.0, side) : std::nextafter(end, side); };
                    std::vector<double> outside{ beyond(range.min, -HUGE_VAL), HUGE_VAL, std::nan("") };
                    std::vector<double> ends{ range.min };
                    if (range.max < 1e300)
                    {
                      outside.push_back(beyond(range.max, HUGE_VAL));
                      ends.push_back(range.max);
                    }
                    for (const double number : outside)
                    {
                      if (!whole || std::isfinite(number))
                      {
                        EXPECT_THAT(complaintWith(key, value, number),
                                    AllOf(HasSubstr("here: " + key + " = "), HasSubstr("[" + std::string(unit) + "]"),
                                          HasSubstr(rangeText(range))))
                            << number;
                      }
                    }
                    for (const double number : ends)
                    {
                      EXPECT_THAT(complaintWith(key, value, number), Not(HasSubstr("out of range")))
                          << key << ' ' << number;
                    }
                  };
                  check(rest...);
                }
              });
}

TEST(Parameters, OutOfRangeNamesPlaceKeyValueUnitAndRange)
{
  const YamlFile file("# comment\ngear:\n  wave_amplitude: 0.5\n");
  EXPECT_EQ(file.complaint(),
            file.path() + ":3: gear.wave_amplitude = 0.5 [m] is out of range, allowed: 0 ... 0.01 [m]");
}

TEST(Parameters, NotFiniteIsRefused)
{
  EXPECT_THAT(complaint({ "motor.torque_limit=.nan" }), HasSubstr("motor.torque_limit = .nan [N.m] is not a finite"));
  EXPECT_THAT(complaint({ "input.command_timeout=.inf" }), HasSubstr("not a finite number"));
  EXPECT_THAT(complaint({ "cup.torsion_stiffness=[1.0, .nan, 2.0]" }), HasSubstr("not a finite number"));
}

TEST(Parameters, MisspeltKeyIsRefusedWithTheNearestOne)
{
  const YamlFile file("motor:\n  rotor_inertai: 1.0e-4\n");
  EXPECT_EQ(file.complaint(), file.path() +
                                  ":2: unknown parameter motor.rotor_inertai = 0.0001 "
                                  "(did you mean motor.rotor_inertia?)");
  EXPECT_THAT(complaint({ "ring.bending_stiffnes=1.0" }), HasSubstr("did you mean ring.bending_stiffness?"));
  EXPECT_THAT(complaint({ "ring.wave_amplitude=0.3e-3" }), HasSubstr("did you mean gear.wave_amplitude?"));
  EXPECT_THAT(complaint({ "motor.bananas=1" }), AllOf(HasSubstr("unknown"), Not(HasSubstr("did you mean"))));
}

TEST(Parameters, TreacherousSpellingsAreRefused)
{
  for (const std::string text : { "010", "0x10", "0b1", "1_000", "1:30" })
  {
    EXPECT_THAT(complaint({ "output.load_inertia=" + text }), HasSubstr("plain decimal digits")) << text;
  }
}

TEST(Parameters, AcceptedSpellingsGiveTheirNumber)
{
  for (const auto& [text, number] : std::vector<std::pair<std::string, double>>{ { "5", 5.0 },
                                                                                 { "5.", 5.0 },
                                                                                 { ".5", 0.5 },
                                                                                 { "1.0e-3", 1e-3 },
                                                                                 { "1.5E+2", 150.0 },
                                                                                 { "1e-06", 1e-6 },
                                                                                 { "1e3", 1e3 },
                                                                                 { "1e+3", 1e3 },
                                                                                 { "1.0e4", 1e4 },
                                                                                 { "+.5e0", 0.5 },
                                                                                 { "'1e-3'", 1e-3 },
                                                                                 { "deg(180)", M_PI },
                                                                                 { "deg(9e1)", M_PI_2 } })
  {
    ParameterMap map = defaultMap();
    readAssignment("output.load_inertia=" + text, map);
    EXPECT_DOUBLE_EQ(parseParameters(map).output.load_inertia, number) << text;
    const YamlFile file("output:\n  load_inertia: " + text + "\ncup:\n  torsion_breakpoints: [" + text + ", 1e5]\n");
    readYamlFile(file.path(), map);
    EXPECT_DOUBLE_EQ(parseParameters(map).output.load_inertia, number) << text;
    EXPECT_DOUBLE_EQ(parseParameters(map).cup.torsion_breakpoints[0], number) << text;
    EXPECT_EQ(parseParameters(map).cup.torsion_breakpoints[1], 1e5) << text;
  }
  for (const std::string text : { "1e", "e5", ".", "1e-", "1e5 m", "1,5", "nan", "inf", "- 1", "--1" })
  {
    EXPECT_THAT(complaint({ "output.load_inertia=" + text }), HasSubstr("must be a number [kg.m^2]")) << text;
  }
  EXPECT_THAT(complaint({ "output.load_inertia=1e400" }), HasSubstr("not a finite number"));
  EXPECT_THAT(complaint({ "gear.teeth_flexspline=2e2" }), HasSubstr("must be a whole number"));
}

TEST(Parameters, WrongTypesAreRefused)
{
  EXPECT_THAT(complaint({ "gear.teeth_flexspline=200.0" }),
              AllOf(HasSubstr("gear.teeth_flexspline = 200.0 must be a whole number [-], 8 ... 4000")));
  EXPECT_THAT(complaint({ "gear.teeth_flexspline=true" }), HasSubstr("must be a whole number"));
  EXPECT_THAT(complaint({ "brake.engaged_at_start='true'" }), HasSubstr("must be true or false, without quotes"));
  EXPECT_THAT(complaint({ "brake.engaged_at_start=1" }), HasSubstr("must be true or false, without quotes"));
  EXPECT_THAT(complaint({ "joint.name=7" }), HasSubstr("joint.name = 7 must be a text"));
  EXPECT_THAT(complaint({ "joint.name=''" }), HasSubstr("must not be empty"));
  EXPECT_THAT(complaint({ "contact.law=round" }), HasSubstr("contact.law = 'round' must be polar or normal"));
  EXPECT_THAT(complaint({ "cup.torsion_stiffness=[1.0, 2.0]" }), HasSubstr("must be a list of 3 numbers [N.m/rad]"));
  EXPECT_THAT(complaint({ "cup.torsion_stiffness=31000" }), HasSubstr("must be a list of 3 numbers"));
  EXPECT_THAT(complaint({ "motor.torque_limit=[1.0]" }), HasSubstr("motor.torque_limit = [1.0] must be a number"));
}

TEST(Parameters, AllThatIsWrongIsSaidAtOnce)
{
  EXPECT_THAT(complaint({ "motor.torque_limit=-1", "gear.teeth=3", "contact.law=round" }),
              AllOf(HasSubstr("motor.torque_limit"), HasSubstr("gear.teeth ="), HasSubstr("contact.law")));
}

TEST(Parameters, AFewThatAreChangedMakeWhatTheWholeMapMakes)
{
  ParameterMap changes;
  for (const char* assignment : { "mesh.stiffness=2.5e+7", "solver.scene=auto", "bearing.balls=21" })
  {
    readAssignment(assignment, changes);
  }
  ParameterMap whole = defaultMap();
  for (const auto& [key, value] : changes)
  {
    whole[key] = value;
  }
  const Parameters before = parseParameters(defaultMap());
  Parameters changed = before;
  changeParameters(changed, changes);
  EXPECT_EQ(describeParameters(changed), describeParameters(parseParameters(whole)));
  EXPECT_EQ(parametersHash(changed), parametersHash(parseParameters(whole)));
  EXPECT_NE(parametersHash(changed), parametersHash(before));
  EXPECT_NE(surfaceParametersHash(changed), surfaceParametersHash(before));
  for (const char* wrong : { "mesh.stifness=2.5e+7", "mesh.stiffness=-1.0", "gear.teeth_flexspline=202" })
  {
    ParameterMap map;
    readAssignment(wrong, map);
    EXPECT_THROW(changeParameters(changed, map), ParameterError) << wrong;
  }
}

TEST(YamlFiles, BrokenFilesAreRefusedWithPlace)
{
  EXPECT_THAT(YamlFile("gear:\n  a: [1, 2\n").complaint(), HasSubstr(".yaml:"));
  EXPECT_THAT(YamlFile("").complaint(), HasSubstr("empty"));
  EXPECT_THAT(YamlFile("gear: 5\n").complaint(), HasSubstr(":1: gear = 5 must be keys and values"));
  EXPECT_THAT(YamlFile("faults: {kind: pitting}\n").complaint(), HasSubstr(":1: faults must be a list of {kind:"));
  EXPECT_THAT(YamlFile("- 1\n").complaint(), HasSubstr("expected `section: {key: value}`"));
  EXPECT_THAT(YamlFile("gear:\n  wave_amplitude:\n").complaint(), HasSubstr(":2: gear.wave_amplitude has no value"));
  EXPECT_THAT(YamlFile("gear:\n  wave_amplitude: {a: 1}\n").complaint(), HasSubstr(":2: gear.wave_amplitude must be"));
  EXPECT_THAT(YamlFile("motor:\n  torque_limit: 1.0\n  torque_limit: 2.0\n").complaint(), HasSubstr("occurs twice"));
  ParameterMap map;
  EXPECT_THROW(readYamlFile("/nonexistent.yaml", map), ParameterError);
}

TEST(Assignments, MustNameSectionAndKey)
{
  EXPECT_THAT(complaint({ "torque_limit=1.0" }), HasSubstr("expected section.key=value"));
  EXPECT_THAT(complaint({ "motor.torque_limit" }), HasSubstr("expected section.key=value"));
  EXPECT_THAT(complaint({ "motor.torque_limit=" }), HasSubstr("has no value"));
}

TEST(ParameterText, DescriptionReadsBackAsTheSameParameters)
{
  const Parameters parameters = parseParameters(defaultMap());
  const std::string described = describeParameters(parameters);
  ParameterMap map;
  readDescription(described, "a.h5", map);
  EXPECT_EQ(map.size(), allKeys().size());
  EXPECT_EQ(describeParameters(parseParameters(map)), described);
}

TEST(ParameterText, FaultsOfADescriptionReplaceThoseBefore)
{
  Parameters parameters = parseParameters(defaultMap());
  parameters.faults = { { FaultKind::TOOTH_WEAR, 0.1, WHOLE_MEMBER, 0.0 }, { FaultKind::BEARING_BALL, 0.2, 3, 1.5 } };
  ParameterMap map;
  readDescription(describeParameters(parameters), "a.h5", map);
  parameters.faults = { { FaultKind::PITTING, 0.5, 7, 0.0 } };
  readDescription(describeParameters(parameters), "b.h5", map);
  EXPECT_EQ(describeParameters(parseParameters(map)), describeParameters(parameters));
}

TEST(ParameterText, WrongLineOfADescriptionIsNamed)
{
  const auto said = [](const std::string& text)
  {
    return complaintOf(
        [&]
        {
          ParameterMap map = defaultMap();
          readDescription(text, "a.h5", map);
          parseParameters(map);
        });
  };
  EXPECT_THAT(said("gear.teeth_flexspline: 200\nsolver.rate: fast  # [Hz]\n"), HasSubstr("a.h5:2"));
  EXPECT_THAT(said("[1, 2]"), HasSubstr("a.h5: expected a line"));
}

TEST(ParameterText, DescriptionNumbersTheFaults)
{
  Parameters parameters = parseParameters(defaultMap());
  parameters.faults = { { FaultKind::TOOTH_WEAR, 0.1, WHOLE_MEMBER, 0.0 }, { FaultKind::BEARING_BALL, 0.2, 3, 1.5 } };
  const std::string described = describeParameters(parameters);
  EXPECT_THAT(described, HasSubstr(faultKey(0) + ".severity: 0.1"));
  EXPECT_THAT(described, HasSubstr(faultKey(1) + ".severity: 0.2"));
  EXPECT_THAT(described, HasSubstr(faultKey(1) + ".place: 3"));
  EXPECT_THAT(described, HasSubstr(faultKey(1) + ".onset: 1.5"));
}

TEST(ParameterText, TableHasARowForEveryKey)
{
  const std::string table = parameterTableMarkdown();
  for (const std::string& key : allKeys())
  {
    EXPECT_THAT(table, HasSubstr("| `" + key + "` |"));
  }
  EXPECT_THAT(table, HasSubstr("| `gear.wave_amplitude` | float | m | 0 ... 0.01 |"));
}

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
