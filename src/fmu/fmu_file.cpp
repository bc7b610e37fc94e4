// SPDX-License-Identifier: BSD-3-Clause
#include "fmu/fmu_file.hpp"

#include <filesystem>

#include "base/whole_file.hpp"
#include "fmu/model_description.hpp"
#include "fmu/variables.hpp"
#include "fmu/zip.hpp"
#include "harmonic_joint_twin/params/parameter_map.hpp"
#include "params/configuration_files.hpp"

namespace hjt::fmu
{
namespace fs = std::filesystem;

std::string fmuFile(Parameters parameters, const std::string& library, const std::vector<std::string>& others)
{
#ifdef __aarch64__
  const std::string binaries = "binaries/aarch64-linux/";
#else
  const std::string binaries = "binaries/x86_64-linux/";
#endif
  const std::string resources = "resources/";
  Zip zip;
  const auto carry = [&](std::string& name, const char* carried)
  {
    if (name != NO_FILE)
    {
      const std::string path =
          fs::path(name).is_absolute() ? name : findConfiguration(name, configurationDirectory(""));
      name = carried;
      zip.add(resources + name, readFile(path));
    }
  };
  carry(parameters.indicators.signatures, "signatures.yaml");
  carry(parameters.manufacture.flexspline_pitch.table, "flexspline_pitch.csv");
  carry(parameters.manufacture.circular_spline_pitch.table, "circular_spline_pitch.csv");
  const std::string text = describeParameters(parameters);
  zip.add(resources + PARAMETER_FILE, text);
  zip.add("modelDescription.xml", modelDescription(parameters, instantiationToken(text)));
  zip.add(binaries + MODEL_IDENTIFIER + ".so", readFile(library));
  for (const std::string& other : others)
  {
    const std::string name = fs::path(other).filename();
    zip.add(binaries + name, readFile(other));
    // Its licence goes with it, from where Debian keeps it: /usr/share/doc/libNAME-VERSION/copyright.
    const std::string package = name.substr(0, name.find(".so"));
    std::error_code error;
    for (const fs::directory_entry& entry : fs::directory_iterator("/usr/share/doc", error))
    {
      const fs::path licence = entry.path() / "copyright";
      if (entry.path().filename().string().rfind(package, 0) == 0 && fs::exists(licence, error))
      {
        zip.add("documentation/licenses/" + entry.path().filename().string() + ".txt", readFile(licence));
        break;
      }
    }
  }
  return zip.bytes();
}
}  // namespace hjt::fmu
