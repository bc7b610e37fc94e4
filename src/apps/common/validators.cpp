// SPDX-License-Identifier: BSD-3-Clause
#include "apps/common/validators.hpp"

#include <cmath>
#include <filesystem>
#include <regex>

#include "base/number_text.hpp"

namespace hjt
{
namespace
{
std::string extension(const std::string& path)
{
  return std::filesystem::path(path).extension().string();
}
}  // namespace

const CLI::Validator FINITE(
    [](std::string& text)
    {
      const auto number = decimalNumber(text);
      return number && std::isfinite(*number) ? std::string() : "'" + text + "' is not a finite number";
    },
    "");

const CLI::Validator BAG([](std::string& path)
                         { return extension(path) == ".bag" ? std::string() : "'" + path + "' must end in .bag"; },
                         "");

const CLI::Validator BAG_OR_CSV(
    [](std::string& path)
    {
      return extension(path) == ".bag" || extension(path) == ".csv" ? std::string() :
                                                                      "'" + path + "' must end in .bag or .csv";
    },
    "");

void addNamespaceOption(CLI::App& command, std::string& joint_namespace)
{
  const CLI::Validator global_name(
      [](std::string& name)
      {
        return std::regex_match(name, std::regex("(/[A-Za-z][A-Za-z0-9_]*)+")) ?
                   std::string() :
                   "'" + name + "' is not a global ROS name such as /joint_twin";
      },
      "");
  command.add_option("--joint-namespace", joint_namespace, "of the twin's topics")
      ->type_name("NAME")
      ->capture_default_str()
      ->check(global_name);
}
}  // namespace hjt
