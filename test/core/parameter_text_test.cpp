// SPDX-License-Identifier: BSD-3-Clause
#include <string>

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
}  // namespace
}  // namespace hjt
