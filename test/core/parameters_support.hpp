// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/number_text.hpp"
#include "harmonic_joint_twin/params/parameter_map.hpp"
#include "params/field_table.hpp"
#include "test/core/complaint.hpp"
#include "test/support/temporary_folder.hpp"

namespace hjt
{
using testing::HasSubstr;
namespace fs = std::filesystem;

inline const fs::path CONFIG(HJT_TEST_CONFIG_DIR);
inline const ParameterMap& defaultMap()
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
inline std::string complaint(const std::vector<std::string>& assignments)
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

inline std::vector<std::string> allKeys()
{
  std::vector<std::string> keys;
  const Parameters parameters;
  visitFields(parameters, [&](const std::string& key, const auto&...) { keys.push_back(key); });
  return keys;
}
}  // namespace hjt
