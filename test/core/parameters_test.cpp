// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/number_text.hpp"
#include "harmonic_joint_twin/base/errors.hpp"
#include "harmonic_joint_twin/params/parameter_map.hpp"
#include "params/field_table.hpp"

namespace hjt
{
namespace
{
using testing::AllOf;
using testing::HasSubstr;
namespace fs = std::filesystem;

const fs::path CONFIG(HJT_TEST_CONFIG_DIR);
const std::vector<std::string> STAGES{ "gear",    "manufacture", "elements", "joint",  "solver",
                                       "sensors", "health",      "life",     "faults", "node" };

ParameterMap defaultMap()
{
  ParameterMap map;
  for (const std::string& stage : STAGES)
  {
    readYamlFile(CONFIG / (stage + ".yaml"), map);
  }
  return map;
}

/// What is said about the defaults with these `section.key=value` over them; empty if they are accepted.
std::string complaint(const std::vector<std::string>& assignments)
{
  try
  {
    ParameterMap map = defaultMap();
    for (const std::string& assignment : assignments)
    {
      readAssignment(assignment, map);
    }
    parseParameters(map);
  }
  catch (const ParameterError& error)
  {
    return error.what();
  }
  return "";
}

/// A YAML file with this text, removed at the end of the test.
class YamlFile
{
public:
  explicit YamlFile(const std::string& text)
    : path_(fs::temp_directory_path() / ("hjt_parameters_test_" + std::to_string(::getpid()) + ".yaml"))
  {
    std::ofstream(path_) << text;
  }
  ~YamlFile() { fs::remove(path_); }

  std::string path() const { return path_.string(); }

  std::string complaint() const
  {
    try
    {
      ParameterMap map = defaultMap();
      readYamlFile(path(), map);
      parseParameters(map);
    }
    catch (const ParameterError& error)
    {
      return error.what();
    }
    return "";
  }

private:
  fs::path path_;
};

std::vector<std::string> allKeys()
{
  std::vector<std::string> keys;
  const Parameters parameters;
  visitFields(parameters, [&](const std::string& key, const auto&...) { keys.push_back(key); });
  return keys;
}

TEST(ShippedConfiguration, IsCompleteAndValid)
{
  const Parameters parameters = parseParameters(defaultMap());
  EXPECT_EQ(parameters.gear.teeth_flexspline, 200);
  EXPECT_EQ(parameters.ring.tension_stiffness, 5e9);
  EXPECT_EQ(parameters.mesh.flank_clearance, -1e-6);
  EXPECT_EQ(parameters.cup.torsion_stiffness[2], 65.4e3);
  EXPECT_EQ(parameters.contact.law, ContactLaw::NORMAL);
  EXPECT_FALSE(parameters.brake.engaged_at_start);
}

TEST(ShippedConfiguration, EveryOverlayIsValidOverTheDefaults)
{
  int overlays = 0;
  for (const auto& entry : fs::recursive_directory_iterator(CONFIG))
  {
    if (entry.path().extension() != ".yaml")
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
  for (const std::string& stage : STAGES)
  {
    std::ifstream file(CONFIG / (stage + ".yaml"));
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
                const auto expected = [&](const char* unit, const auto&, const Range& range, const char*)
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
    try
    {
      parseParameters(map);
      ADD_FAILURE() << key << " went missing in silence";
    }
    catch (const ParameterError& error)
    {
      EXPECT_THAT(error.what(), AllOf(HasSubstr(key), HasSubstr("missing")));
    }
  }
}

TEST(Parameters, EveryRangeIsHeldAtBothEnds)
{
  const Parameters parameters;
  visitFields(
      parameters,
      [&](const std::string& key, const auto&... rest)
      {
        if constexpr (sizeof...(rest) == 4)
        {
          const auto check = [&](const char* unit, const auto& value, const Range& range, const char*)
          {
            std::vector<double> outside{ range.min - std::max(1.0, std::abs(range.min)), HUGE_VAL, std::nan("") };
            if (range.max < 1e300)
            {
              outside.push_back(range.max + std::max(1.0, std::abs(range.max)));
            }
            for (const double number : outside)
            {
              ParameterMap map = defaultMap();
              if constexpr (std::is_same_v<std::decay_t<decltype(value)>, int>)
              {
                if (!std::isfinite(number))
                {
                  continue;
                }
                map[key].value = static_cast<std::int64_t>(number);
              }
              else if constexpr (std::is_same_v<std::decay_t<decltype(value)>, double>)
              {
                map[key].value = number;
              }
              else
              {
                map[key].value = std::vector<double>(value.size(), number);
              }
              map[key].origin = "here";
              try
              {
                parseParameters(map);
                ADD_FAILURE() << key << " accepted " << number;
              }
              catch (const ParameterError& error)
              {
                EXPECT_THAT(error.what(), AllOf(HasSubstr("here: " + key + " = "),
                                                HasSubstr("[" + std::string(unit) + "]"), HasSubstr(rangeText(range))));
              }
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
  EXPECT_THAT(complaint({ "ring.wave_amplitude=0.3e-3" }), HasSubstr("did you mean gear.wave_amplitude?"));
  EXPECT_THAT(complaint({ "motor.bananas=1" }), AllOf(HasSubstr("unknown"), Not(HasSubstr("did you mean"))));
}

TEST(Parameters, NumbersMustBeSpeltAsRosparamUnderstandsThem)
{
  for (const std::string text : { "1e-3", "1e3", "1e+3", "1.0e4", "-.5e+0" })
  {
    EXPECT_THAT(complaint({ "output.load_inertia=" + text }),
                AllOf(HasSubstr("output.load_inertia = '" + text + "'"), HasSubstr("[kg.m^2]"), HasSubstr("write ")));
  }
  EXPECT_THAT(complaint({ "output.load_inertia=1e-5" }), HasSubstr("write 1.0e-5 "));
  EXPECT_THAT(complaint({ "cup.torsion_breakpoints=[14, 1e2]" }), HasSubstr("write 100.0"));
  EXPECT_THAT(complaint({ "output.load_inertia='1.0'" }), HasSubstr("no quotes"));
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
  for (const auto& [text, number] : std::vector<std::pair<std::string, double>>{
           { "5", 5.0 }, { "5.", 5.0 }, { ".5", 0.5 }, { "1.0e-3", 1e-3 }, { "1.5E+2", 150.0 }, { "deg(180)", M_PI } })
  {
    ParameterMap map = defaultMap();
    readAssignment("output.load_inertia=" + text, map);
    EXPECT_DOUBLE_EQ(parseParameters(map).output.load_inertia, number) << text;
  }
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

TEST(Parameters, ContradictionsAreRefused)
{
  EXPECT_THAT(complaint({ "gear.teeth_circular_spline=204" }), HasSubstr("must be two more than"));
  EXPECT_THAT(complaint({ "gear.teeth_flexspline=201", "gear.teeth_circular_spline=203" }), HasSubstr("must be even"));
  EXPECT_THAT(complaint({ "cup.torsion_breakpoints=[48.0, 14.0]" }), HasSubstr("must ascend"));
  EXPECT_THAT(complaint({ "gear.wave_amplitude=5.0e-3", "gear.flexspline_inner_radius=4.0e-3" }),
              HasSubstr("must be less than"));
  EXPECT_THAT(complaint({ "mesh.friction_kinetic=0.2" }), HasSubstr("must not exceed"));
  EXPECT_THAT(complaint({ "solver.rate=3000" }), HasSubstr("whole nanoseconds"));
  for (const std::string topic : { "joint_states", "encoders", "contact_forces", "health" })
  {
    EXPECT_THAT(complaint({ "publish." + topic + "_rate=300" }), HasSubstr("must divide solver.rate"));
    EXPECT_THAT(complaint({ "publish." + topic + "_rate=20000" }), HasSubstr("must divide solver.rate"));
  }
  EXPECT_EQ(complaint({ "publish.health_rate=0.1" }), "");
}

TEST(Parameters, AllThatIsWrongIsSaidAtOnce)
{
  EXPECT_THAT(complaint({ "motor.torque_limit=-1", "gear.teeth=3", "contact.law=round" }),
              AllOf(HasSubstr("motor.torque_limit"), HasSubstr("gear.teeth ="), HasSubstr("contact.law")));
}

TEST(YamlFiles, BrokenFilesAreRefusedWithPlace)
{
  EXPECT_THAT(YamlFile("gear:\n  a: [1, 2\n").complaint(), HasSubstr(".yaml:"));
  EXPECT_THAT(YamlFile("").complaint(), HasSubstr("empty"));
  EXPECT_THAT(YamlFile("gear: 5\n").complaint(), HasSubstr(":1: 'gear' must be a section"));
  EXPECT_THAT(YamlFile("- 1\n").complaint(), HasSubstr("expected `section: {key: value}`"));
  EXPECT_THAT(YamlFile("gear:\n  wave_amplitude:\n").complaint(), HasSubstr(":2: gear.wave_amplitude has no value"));
  EXPECT_THAT(YamlFile("gear:\n  wave_amplitude: {a: 1}\n").complaint(), HasSubstr(":2: gear.wave_amplitude must be"));
  EXPECT_THAT(YamlFile("motor:\n  torque_limit: 1.0\n  torque_limit: 2.0\n").complaint(), HasSubstr("stands twice"));
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
  std::istringstream lines(described);
  for (std::string line; std::getline(lines, line);)
  {
    const std::size_t colon = line.find(": ");
    readAssignment(line.substr(0, colon) + "=" + line.substr(colon + 2), map);
  }
  EXPECT_EQ(map.size(), allKeys().size());
  EXPECT_EQ(describeParameters(parseParameters(map)), described);
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
}  // namespace
}  // namespace hjt
