// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <filesystem>
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
  std::string text;
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
                  const std::size_t line = text.find(key + " ");
                  ASSERT_NE(line, std::string::npos) << key;
                  EXPECT_THAT(text.substr(line, text.find('\n', line) - line), HasSubstr(expected(rest...))) << key;
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
}  // namespace
}  // namespace hjt
