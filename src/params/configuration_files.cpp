// SPDX-License-Identifier: BSD-3-Clause
#include "params/configuration_files.hpp"

#include <cstdlib>
#include <variant>

#include <dlfcn.h>

#include "harmonic_joint_twin/base/errors.hpp"

namespace hjt
{
namespace
{
namespace fs = std::filesystem;

/// List of the default configuration's files, in their directory.
constexpr const char* STAGES = "stages";

fs::path findDirectory(const std::string& given)
{
  if (!given.empty())
  {
    return given;
  }
  if (const char* from_environment = std::getenv("HJT_CONFIG_DIR"))
  {
    return from_environment;
  }
  return packageDirectory() / "config";
}
}  // namespace

fs::path libraryDirectory()
{
  static const int HERE = 0;
  Dl_info library{};
  return dladdr(&HERE, &library) != 0 ? fs::absolute(library.dli_fname).parent_path() : "";
}

fs::path packageDirectory()
{
  // PREFIX/share/harmonic_joint_twin belongs to the executable PREFIX/lib/harmonic_joint_twin/joint_twin, and to the
  // library PREFIX/lib/libharmonic_joint_twin_core.so where another program has loaded it. In a development space its
  // config is a link to that of the sources.
  std::error_code error;
  const fs::path executable = fs::read_symlink("/proc/self/exe", error);
  const fs::path libraries = libraryDirectory();
  for (const fs::path& beside : { executable.parent_path() / "../..", libraries / ".." })
  {
    const fs::path config = fs::canonical(beside / "share/harmonic_joint_twin/config", error);
    if (!error && fs::exists(config / STAGES))
    {
      return config.parent_path();
    }
  }
  throw ParameterError("neither " + executable.string() + " nor " + libraries.string() +
                       " lies in an installation or development space of harmonic_joint_twin: no default configuration "
                       "found; name its directory with --config-dir or HJT_CONFIG_DIR");
}

fs::path configurationDirectory(const std::string& given)
{
  fs::path directory = findDirectory(given);
  if (!fs::exists(directory / STAGES))
  {
    throw ParameterError("no default configuration in '" + directory.string() +
                         "': name its directory with --config-dir or HJT_CONFIG_DIR");
  }
  return fs::absolute(directory);
}

std::string findConfiguration(const std::string& name, const fs::path& directory)
{
  for (const fs::path& candidate : { fs::path(name), directory.parent_path() / name, directory / name })
  {
    if (fs::exists(candidate))
    {
      return candidate.string();
    }
  }
  return name;
}

void putOver(const ParameterMap& values, ParameterMap& map)
{
  for (const auto& [key, value] : values)
  {
    map[key] = value;
  }
}

void findNamedFiles(const fs::path& directory, ParameterMap& map)
{
  const auto found = map.find("indicators.signatures");
  std::string* name = found == map.end() ? nullptr : std::get_if<std::string>(&found->second.value);
  if (name != nullptr && *name != NO_FILE)
  {
    *name = findConfiguration(*name, directory);
  }
}
}  // namespace hjt
