// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <string>
#include <vector>

#include <link.h>

#include <Eigen/Dense>

#include "apps/common/configuration.hpp"
#include "output/output_file.hpp"
#include "output/process_end.hpp"

#include "arm/arm_configuration.hpp"
#include "base/number_text.hpp"
#include "base/text.hpp"
#include "base/whole_file.hpp"
#include "elements/motor.hpp"
#include "fmu/fmu_file.hpp"
#include "gear/ratio.hpp"
#include "harmonic_joint_twin/statics/static_analysis.hpp"
#include "params/configuration_files.hpp"
#include "tracking/motion_driven.hpp"

namespace hjt
{
namespace
{
struct ExportOptions : CommonOptions
{
  std::string format;
  std::string out;
  std::string arm;
  std::string identified;
};

/// Properties of the joint that other simulators can represent, all on the output side of the gear.
struct ExportedJoint
{
  std::string name;             ///< name in XML
  double friction{};            ///< value at speed 0 of the straight line fitted to friction over speed [N.m]
  double damping{};             ///< slope of the straight line fitted to friction over speed [N.m.s/rad]
  double friction_deviation{};  ///< largest deviation of the twin's friction from the straight line [N.m]
  double armature{};            ///< inertia of motor and wave generator at the joint [kg.m^2]
  double stiffness{};           ///< stiffness of the gear: secant between plus and minus the rated torque [N.m/rad]
  double hysteresis{};          ///< dry friction parallel to the stiffness: half the height of the torsion loop [N.m]
  double inertia{};             ///< inertia of circular spline and load [kg.m^2]
  double effort{};              ///< largest torque of the joint [N.m]
  double velocity{};            ///< largest speed of the joint [rad/s]
};

/// Fits a straight line to the twin's friction without load over the speed of the joint.
void fitFriction(const Parameters& parameters, ExportedJoint& joint)
{
  constexpr int SPEEDS = 20;
  const MotionDriven twin(parameters);
  Eigen::MatrixX2d line(SPEEDS, 2);
  Eigen::VectorXd friction(SPEEDS);
  for (int i = 0; i < SPEEDS; ++i)
  {
    const double speed = joint.velocity * (i + 1) / SPEEDS;
    line.row(i) << 1.0, speed;
    friction[i] = twin.frictionAt(speed, 0.0, parameters.input.temperature);
  }
  const Eigen::Vector2d fitted = line.colPivHouseholderQr().solve(friction);
  joint.friction = fitted[0];
  joint.damping = fitted[1];
  joint.friction_deviation = (line * fitted - friction).cwiseAbs().maxCoeff();
}

/// Comment in the XML file about the properties of the joint that the format of the file cannot represent.
std::string missing(const ExportedJoint& joint, const Parameters& parameters, bool has_armature, bool has_stiffness)
{
  const auto text = [](double value) { return roundedText(value, 4); };
  std::string lines = "  Not represented: effect of load and temperature on the friction (here: no load, " +
                      text(parameters.input.temperature) +
                      " degC), deviation of the friction\n"
                      "  from a straight line over the speed (up to " +
                      text(joint.friction_deviation) + " N.m), stiffness that grows with the torque, " +
                      (has_stiffness ? "hysteresis of small swings" : "hysteresis") +
                      ", lost motion, kinematic error, backlash of the brake, faults.\n";
  lines += has_armature ?
               "" :
               "  Not in this format: inertia of the motor at the joint, " + text(joint.armature) + " kg.m^2.\n";
  lines += has_stiffness ? "" : "  Not in this format: stiffness in series, " + text(joint.stiffness) + " N.m/rad.\n";
  return "<!--\n  A joint of harmonic_joint_twin. Values are in SI units, on the output side of the gear.\n" + lines +
         "-->\n";
}

std::string attribute(const char* name, double value)
{
  return std::string(" ") + name + "=\"" + roundedText(value, 6) + '"';
}

std::string element(const char* name, double value)
{
  return std::string("<") + name + '>' + roundedText(value, 6) + "</" + name + '>';
}

std::string urdf(const ExportedJoint& joint, const Parameters& parameters)
{
  return missing(joint, parameters, false, false) + "<robot name=\"harmonic_joint\">\n  <link name=\"housing\"/>\n" +
         "  <link name=\"output\"/>\n  <joint name=\"" + joint.name + "\" type=\"revolute\">\n" +
         "    <parent link=\"housing\"/>\n    <child link=\"output\"/>\n    <axis xyz=\"0 0 1\"/>\n    <limit "
         "lower=\"-6.28319\" "
         "upper=\"6.28319\"" +
         attribute("effort", joint.effort) + attribute("velocity", joint.velocity) + "/>\n    <dynamics" +
         attribute("damping", joint.damping) + attribute("friction", joint.friction) + "/>\n  </joint>\n</robot>\n";
}

std::string sdfLink(const char* name, double inertia)
{
  // The mass of 1 kg has no effect, because the link rotates about its own centre.
  return std::string("    <link name=\"") + name + "\">\n      <inertial><mass>1</mass><inertia>" +
         element("ixx", inertia) + element("iyy", inertia) + element("izz", inertia) +
         "<ixy>0</ixy><ixz>0</ixz><iyz>0</iyz></inertia></inertial>\n    </link>\n";
}

/// SDF text. The motor's inertia is a separate link, which the spring of the gear connects with the output.
std::string sdf(const ExportedJoint& joint, const Parameters& parameters)
{
  const std::string axis = "      <axis>\n        <xyz>0 0 1</xyz>\n        ";
  return missing(joint, parameters, true, true) + "<sdf version=\"1.7\">\n  <model name=\"harmonic_joint\">\n" +
         sdfLink("motor", joint.armature) + sdfLink("output", joint.inertia) + "    <joint name=\"" + joint.name +
         "\" type=\"revolute\">\n      <parent>world</parent>\n      <child>motor</child>\n" + axis + "<limit>" +
         element("effort", joint.effort) + element("velocity", joint.velocity) + "</limit>\n        <dynamics>" +
         element("damping", joint.damping) + element("friction", joint.friction) +
         "</dynamics>\n      </axis>\n    </joint>\n    <joint name=\"" + joint.name +
         "_torsion\" type=\"revolute\">\n      <parent>motor</parent>\n      <child>output</child>\n" + axis +
         "<dynamics>" + element("friction", joint.hysteresis) + element("spring_reference", 0.0) +
         element("spring_stiffness", joint.stiffness) +
         "</dynamics>\n      </axis>\n    </joint>\n  </model>\n</sdf>\n";
}

std::string mjcfInertial(double inertia)
{
  const std::string text = roundedText(inertia, 6);
  return "<inertial pos=\"0 0 0\" mass=\"1\" diaginertia=\"" + text + ' ' + text + ' ' + text + "\"/>\n";
}

/// Attributes of dry friction, with the largest impedance that MuJoCo allows. Even so, a joint that friction holds
/// creeps in MuJoCo by microradians per second.
std::string mjcfFriction(double friction)
{
  return attribute("frictionloss", friction) + " solimpfriction=\"0.9999 0.9999 0.001 0.5 2\"";
}

/// Time step for MuJoCo [s]: its default or, if shorter, 4 % of the period in which motor and output oscillate against
/// each other on the gear's spring. A step of a third of this period is the limit of stability.
double mjcfTimeStep(const ExportedJoint& joint)
{
  constexpr double OWN = 0.002;
  return std::min(OWN, 0.25 / std::sqrt(joint.stiffness * (1.0 / joint.inertia + 1.0 / joint.armature)));
}

std::string mjcf(const ExportedJoint& joint, const Parameters& parameters)
{
  return missing(joint, parameters, true, true) +
         "<mujoco model=\"harmonic_joint\">\n  <compiler angle=\"radian\"/>\n  <option" +
         attribute("timestep", mjcfTimeStep(joint)) +
         "/>\n  <worldbody>\n    <body "
         "name=\"motor\">\n      " +
         mjcfInertial(1e-6) + "      <joint name=\"" + joint.name + "\" type=\"hinge\" axis=\"0 0 1\"" +
         attribute("damping", joint.damping) + mjcfFriction(joint.friction) + attribute("armature", joint.armature) +
         "/>\n      <body name=\"output\">\n        " + mjcfInertial(joint.inertia) + "        <joint name=\"" +
         joint.name + "_torsion\" type=\"hinge\" axis=\"0 0 1\"" + attribute("stiffness", joint.stiffness) +
         mjcfFriction(joint.hysteresis) +
         "/>\n      </body>\n    </body>\n  </worldbody>\n  <actuator>\n    <motor joint=\"" + joint.name +
         "\" ctrllimited=\"true\" ctrlrange=\"-" + roundedText(joint.effort, 6) + ' ' + roundedText(joint.effort, 6) +
         "\"/>\n  </actuator>\n</mujoco>\n";
}

/// Paths of the loaded libraries whose names are in `names`, which another system may lack. Empty if all of them are
/// linked statically.
std::vector<std::string> loadedLibraries(const std::vector<std::string>& names)
{
  struct Search
  {
    const std::vector<std::string>& names;
    std::vector<std::string> paths;
  } search{ names, {} };
  dl_iterate_phdr(
      [](dl_phdr_info* info, std::size_t, void* data)
      {
        auto& wanted = *static_cast<Search*>(data);
        const std::string path = info->dlpi_name;
        if (std::any_of(wanted.names.begin(), wanted.names.end(),
                        [&](const std::string& name) { return path.find('/' + name + ".so") != std::string::npos; }))
        {
          wanted.paths.push_back(path);
        }
        return 0;
      },
      &search);
  return search.paths;
}

std::string armUnit(const ExportOptions& options, const std::filesystem::path& libraries, fmu::Version version)
{
  ArmDescription arm = readArmDescription(findArm(options.arm, configDirectory(options)));
  addIdentifiedGains(options.identified, arm);
  return fmu::armFmu(
      std::filesystem::path(options.arm).stem(), arm, armDrives(arm, options, options.identified, {}),
      { libraries / "harmonic_joint_twin_arm_fmu.so", loadedLibraries({ "libyaml-cpp", "liborocos-kdl" }) }, version);
}

int exportFmu(const ExportOptions& options)
{
  const std::filesystem::path libraries = libraryDirectory() / "harmonic_joint_twin";
  const fmu::Version version = options.format == "fmu2" ? fmu::Version::FMI_2 : fmu::Version::FMI_3;
  requireWritable(options.out, options.force);
  const std::string unit =
      options.arm.empty() ?
          fmu::driveFmu(loadGear(options),
                        { libraries / "harmonic_joint_twin_fmu.so", loadedLibraries({ "libyaml-cpp" }) }, version) :
          armUnit(options, libraries, version);
  writeTextFile(options.out, unit);
  return EXIT_DONE;
}

int exportJoint(const ExportOptions& options)
{
  const bool is_fmu = options.format == "fmu" || options.format == "fmu2";
  if (is_fmu == options.out.empty())
  {
    std::cerr << "joint_twin: " << (is_fmu ? "--format fmu needs --out" : "--out is only for --format fmu") << '\n';
    return EXIT_USAGE;
  }
  if (options.arm.empty() ? !options.identified.empty() : !is_fmu)
  {
    const char* wrong = options.arm.empty() ? "--identified is only for --arm" : "--arm is only for --format fmu";
    std::cerr << "joint_twin: " << wrong << '\n';
    return EXIT_USAGE;
  }
  if (is_fmu)
  {
    return exportFmu(options);
  }
  const Parameters parameters = loadParameters(options);
  const double ratio = nominalRatio(parameters.gear);
  const double rated = parameters.life.rated_torque;
  const std::vector<StiffnessRow> rows = analyseStiffness(parameters, 0.0, { -rated, rated });
  for (const StiffnessRow& row : rows)
  {
    if (!row.status.ok())
    {
      return notConverged("the rated torque", row.status);
    }
  }
  ExportedJoint joint;
  joint.name = xmlText(parameters.joint.name);
  joint.velocity = parameters.motor.speed_limit / ratio;
  joint.effort = parameters.motor.torque_limit * ratio;
  joint.armature = Motor(parameters.motor).inertia() * ratio * ratio;
  joint.inertia = parameters.output.circular_spline_inertia + parameters.output.load_inertia;
  joint.stiffness = 2.0 * rated / (rows[0].output_angle - rows[1].output_angle);
  joint.hysteresis = parameters.cup.friction_torque;
  fitFriction(parameters, joint);
  std::cout << (options.format == "urdf" ? urdf : options.format == "sdf" ? sdf : mjcf)(joint, parameters);
  return EXIT_DONE;
}

void declare(OptionTable& table, ExportOptions& options)
{
  table
      .add("--format", options.format,
           "urdf, sdf, mjcf: a joint with its damping and friction, printed to stdout; fmu, fmu2: the twin itself as a "
           "co-simulation unit of FMI 3.0 or 2.0, written to --out")
      .required()
      .choice({ "urdf", "sdf", "mjcf", "fmu", "fmu2" });
  table.add("--out", options.out, "file for the FMI unit").type("FILE.fmu");
  table.add("--arm", options.arm, "export this whole arm with its drives, links and controller").type("NAME|FILE.yaml");
  table.add("--identified", options.identified, "directory of overlays that `joint_twin identify --arm` wrote")
      .type("DIR")
      .existingDirectory();
  table.flag("--force", options.force, "overwrite an existing file");
  addOptions(table, options);
}

const Subcommand EXPORT{ Subject::JOINT, "export",
                         "the joint for other simulators: URDF, SDF, MJCF or FMU; an arm as FMU", declare,
                         exportJoint };
}  // namespace
}  // namespace hjt
