// SPDX-License-Identifier: BSD-3-Clause
#include "fmu/fmu_file.hpp"

#include <filesystem>

#include "arm/arm_controller.hpp"
#include "base/whole_file.hpp"
#include "fmu/arm_resource.hpp"
#include "fmu/arm_variables.hpp"
#include "fmu/model_description.hpp"
#include "fmu/variables.hpp"
#include "fmu/zip.hpp"
#include "harmonic_joint_twin/base/errors.hpp"
#include "harmonic_joint_twin/params/parameter_map.hpp"
#include "params/configuration_files.hpp"

namespace hjt::fmu
{
namespace
{
namespace fs = std::filesystem;

/// Fills the folder of a unit's resources.
class Resources
{
public:
  explicit Resources(Zip& zip) : zip_(zip) {}

  void add(const std::string& name, const std::string& text)
  {
    zip_.add("resources/" + name, text);
    texts_ += text;
  }

  /// A drive, with the files that its parameters name. @returns it as its unit has it.
  Parameters addDrive(const std::string& folder, Parameters parameters)
  {
    carry(folder, parameters.indicators.signatures, "signatures.yaml");
    carry(folder, parameters.manufacture.flexspline_pitch.table, "flexspline_pitch.csv");
    carry(folder, parameters.manufacture.circular_spline_pitch.table, "circular_spline_pitch.csv");
    add(folder + PARAMETER_FILE, describeParameters(parameters));
    return parameters;
  }

  std::string token() const { return instantiationToken(texts_); }

private:
  void carry(const std::string& folder, std::string& name, const char* carried)
  {
    if (name != NO_FILE)
    {
      const std::string path =
          fs::path(name).is_absolute() ? name : findConfiguration(name, configurationDirectory(""));
      name = carried;
      zip_.add("resources/" + folder + name, readFile(path));
    }
  }

  Zip& zip_;
  std::string texts_;
};

/// The library as the unit's and what it loads, with licences from where Debian keeps them:
/// /usr/share/doc/libNAME-VERSION/copyright.
void addLibraries(const UnitLibraries& libraries, const std::string& name, Version version, Zip& zip)
{
#ifdef __aarch64__
  const std::string binaries = "binaries/aarch64-linux/";
  static_cast<void>(version);
#else
  const std::string binaries = version == Version::FMI_3 ? "binaries/x86_64-linux/" : "binaries/linux64/";
#endif
  zip.add(binaries + name + ".so", readFile(libraries.own, MAX_BINARY));
  for (const std::string& other : libraries.others)
  {
    const std::string file = fs::path(other).filename();
    zip.add(binaries + file, readFile(other, MAX_BINARY));
    const std::string package = file.substr(0, file.find(".so"));
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
}

std::string finish(const UnitDescription& unit, const UnitLibraries& libraries, Version version, Zip& zip)
{
  zip.add("modelDescription.xml", modelDescription(unit, version));
  zip.add("documentation/licenses/license.txt", readFile(packageDirectory() / "LICENSE"));
  addLibraries(libraries, unit.library, version, zip);
  return zip.bytes();
}
}  // namespace

std::string driveFmu(const Parameters& parameters, const UnitLibraries& libraries, Version version)
{
  Zip zip;
  Resources resources(zip);
  const Parameters carried = resources.addDrive("", parameters);
  const UnitDescription unit{ carried.joint.name,     "Tooth-level twin of a robot joint's harmonic drive",
                              "harmonic_joint_twin",  resources.token(),
                              carried.solver.rate,    0.001,
                              driveVariables(carried) };
  return finish(unit, libraries, version, zip);
}

std::string armFmu(const std::string& name, const ArmDescription& arm, const std::vector<Parameters>& drives,
                   const UnitLibraries& libraries, Version version)
{
  ArmDescription whole = arm;
  std::vector<Parameters> carried;
  Zip zip;
  Resources resources(zip);
  for (std::size_t i = 0; i < drives.size(); ++i)
  {
    whole.joints[i].gains = arm.joints[i].gains.value_or(ArmController::defaultGains(drives[i]));
  }
  resources.add(ARM_FILE, armResource(whole));
  for (std::size_t i = 0; i < drives.size(); ++i)
  {
    carried.push_back(resources.addDrive(arm.joints[i].short_name + '/', drives[i]));
  }
  const UnitDescription unit{ name,
                              "Tooth-level twins of all drives of a robot arm, its links and its controller",
                              "harmonic_joint_twin_arm",
                              resources.token(),
                              drives.front().solver.rate,
                              1.0 / arm.state_rate,
                              armVariables(whole, carried) };
  return finish(unit, libraries, version, zip);
}
}  // namespace hjt::fmu
