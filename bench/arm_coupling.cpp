// SPDX-License-Identifier: BSD-3-Clause
// Cost and error of a whole UR5 in its gentle motion, for scripts/arm_coupling. Prints CSV. Arguments: directory of the
// default configuration, and
//   coupling  mass matrix at several rates, the other drives' torques extrapolated by several orders: rate of the mass
//             matrix [Hz], order, processor time over simulated time [-], largest error of the arm's energy [J],
//             largest difference of an angle from the run with a quarter of the step [rad]
//   scenes    drives on the full ring, the others on surfaces: their number, processor time over simulated time [-]
#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>
#include <iostream>
#include <string>
#include <vector>

#include "arm/arm_configuration.hpp"
#include "arm/arm_controller.hpp"
#include "arm/arm_motion.hpp"
#include "harmonic_joint_twin/base/errors.hpp"

namespace hjt
{
namespace
{
constexpr double RATE = 10e3;      // [Hz]
constexpr double SETTLING = 0.5;   // before it [s]
constexpr double SAMPLES = 500.0;  // at which angles are compared [Hz]
constexpr int REPEATS = 3;

double processorTime()
{
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

struct Run
{
  double cost{};          // processor time over simulated time, least of the repeats [-]
  double energy_error{};  // [J]
  std::vector<double> angles;
};

class Bench
{
public:
  explicit Bench(const std::string& directory)
    : arm_(readArmDescription(findArm("ur5", directory))), motion_(gentleMotion(arm_))
  {
    ConfigurationOptions options;
    options.config_dir = directory;
    maps_ = armDriveMaps(arm_, options, "");
    for (const JointMotion& joint : motion_.points().front().joints)
    {
      start_.push_back(joint.position);
    }
  }

  /// `rings`: drives on the full ring, the elbow first, then from the base on.
  Run run(double rate, const ArmCoupling& coupling, std::size_t rings, double duration) const
  {
    std::vector<Parameters> drives;
    for (const ParameterMap& map : maps_)
    {
      drives.push_back(parseParameters(map));
      drives.back().solver.rate = rate;
    }
    constexpr std::array<std::size_t, 6> ORDER{ 2, 0, 1, 3, 4, 5 };
    for (std::size_t i = 0; i < rings; ++i)
    {
      drives[ORDER[i]].solver.scene = SceneKind::FULL_RING;
    }
    ArmTwin twin(arm_, drives, start_, { surfaceCacheDirectory() }, coupling);
    std::vector<JointGains> gains;
    for (const Parameters& drive : drives)
    {
      gains.push_back(ArmController::defaultGains(drive));
    }
    ArmController controller(arm_, twin, gains, CONTROL_RATE);
    Run run;
    run.cost = HUGE_VAL;
    for (int repeat = 0; repeat < REPEATS; ++repeat)
    {
      twin.reset(0);
      controller.reset();
      run.angles.clear();
      const double begin = processorTime();
      march(twin, controller, run, duration);
      run.cost = std::min(run.cost, (processorTime() - begin) / (SETTLING + duration));
    }
    return run;
  }

private:
  static constexpr double CONTROL_RATE = 2000.0;  // [Hz]

  void march(ArmTwin& twin, ArmController& controller, Run& run, double duration) const
  {
    ArmMotion motion = motion_;
    std::vector<JointMotion> wanted(twin.joints());
    for (std::size_t i = 0; i < twin.joints(); ++i)
    {
      twin.drive(i).commandBrake(toStampLength(0.5 * SETTLING), false);
    }
    const Stamp end = toStampLength(SETTLING + duration);
    const Stamp sample = toStampLength(1.0 / SAMPLES);
    do
    {
      if (controller.isDue(twin))
      {
        motion.at(motion.begin() + toSeconds(twin.stamp() + twin.stepLength()) - SETTLING, wanted);
        controller.control(twin, wanted);
      }
      if (twin.stamp() % sample == 0)
      {
        run.energy_error = std::max(run.energy_error, std::abs(twin.energyResidual()));
        for (const JointMotion& joint : twin.motion())
        {
          run.angles.push_back(joint.position);
        }
      }
    } while (twin.step(end));
  }

  ArmDescription arm_;
  ArmMotion motion_;
  std::vector<ParameterMap> maps_;
  std::vector<double> start_;
};

void compareCouplings(const Bench& bench)
{
  constexpr double DURATION = 4.0;  // of the motion [s]
  const Run exact = bench.run(4.0 * RATE, { 4.0 * RATE, 1 }, 0, DURATION);
  std::cout << "mass_rate,order,cost,energy_error,angle_error\n";
  for (const int order : { 0, 1, 2 })
  {
    for (const double mass_rate : { 10e3, 5e3, 2e3, 1e3, 500.0, 200.0, 100.0 })
    {
      const Run run = bench.run(RATE, { mass_rate, order }, 0, DURATION);
      double largest = 0.0;
      for (std::size_t i = 0; i < run.angles.size(); ++i)
      {
        largest = std::max(largest, std::abs(run.angles[i] - exact.angles[i]));
      }
      std::cout << mass_rate << ',' << order << ',' << run.cost << ',' << run.energy_error << ',' << largest
                << std::endl;
    }
  }
}

void compareScenes(const Bench& bench)
{
  constexpr double DURATION = 2.0;  // of the motion [s]
  std::cout << "rings,cost\n";
  for (const std::size_t rings : std::array<std::size_t, 4>{ 0, 1, 3, 6 })
  {
    std::cout << rings << ',' << bench.run(RATE, {}, rings, DURATION).cost << std::endl;
  }
}
}  // namespace
}  // namespace hjt

int main(int argc, char** argv)
try
{
  const std::string what = argc == 3 ? argv[2] : "";
  if (what != "coupling" && what != "scenes")
  {
    std::cerr << "usage: arm_coupling CONFIG_DIR coupling|scenes\n";
    return 2;
  }
  const hjt::Bench bench(argv[1]);
  what == "scenes" ? hjt::compareScenes(bench) : hjt::compareCouplings(bench);
  return 0;
}
catch (const hjt::ParameterError& error)
{
  std::cerr << error.what() << '\n';
  return 1;
}
