// SPDX-License-Identifier: BSD-3-Clause
#include <pybind11/stl.h>

#include "harmonic_joint_twin/base/errors.hpp"
#include "python/tooth_values.hpp"

namespace hjt
{
namespace
{
template <std::size_t PLACE>
py::array_t<double> stressView(const py::object& self)
{
  return viewOf(self.cast<const ToothStress&>().normal[PLACE], self);
}
}  // namespace

std::size_t stressPlace(const std::string& name)
{
  std::string names;
  for (std::size_t place = 0; place < STRESS_PLACES; ++place)
  {
    if (name == STRESS_PLACE_NAMES[place])
    {
      return place;
    }
    names += (place > 0 ? ", '" : "'") + std::string(STRESS_PLACE_NAMES[place]) + "'";
  }
  throw InputError("place = '" + name + "' must be one of " + names);
}

void bindToothValues(py::module& module)
{
  auto forces = py::class_<ToothForces, std::shared_ptr<ToothForces>>(
      module, "ToothForces",
      "Forces on every tooth of the flexspline at one instant, as ContactForces.msg. Arrays of shape (teeth,), "
      "index = tooth, counter-clockwise from the flexspline's x axis. They are views of the twin's memory: the next "
      "call of Twin.tooth_forces() overwrites them; copy() keeps them.");
  addArray(forces, "wave_generator_force", &ToothForces::wave_generator_force,
           "normal force of the wave generator on the flexspline, >= 0 [N]");
  addArray(forces, "rim_tension", &ToothForces::rim_tension, "tension to the next tooth, pull > 0 [N]");
  addArray(forces, "bending_force", &ToothForces::bending_force,
           "restoring force of the bending couple of the segment to the next tooth [N]");
  addArray(forces, "mesh_force", &ToothForces::mesh_force,
           "normal force of the circular spline on the flank; > 0 leading, < 0 trailing flank [N]");
  addArray(forces, "tooth_x", &ToothForces::tooth_x, "of the tooth point on the inner rim [m]");
  addArray(forces, "tooth_y", &ToothForces::tooth_y, "of the tooth point on the inner rim [m]");
  forces.def(
      "copy", [](const ToothForces& self) { return std::make_shared<ToothForces>(self); },
      "The same values in memory of their own: ToothForces.");
  addText(forces);

  auto cycle = py::class_<StressCycle>(
      module, "StressCycle",
      "What one place of the flexspline goes through in a turn of the wave generator, nominal: without the notch.");
  cycle.def_readonly("lowest", &StressCycle::lowest, "normal stress [Pa]")
      .def_readonly("highest", &StressCycle::highest, "normal stress [Pa]")
      .def_readonly("shear", &StressCycle::shear, "constant over the turn [Pa]")
      .def_property_readonly("amplitude", &StressCycle::amplitude, "half of highest less lowest [Pa]")
      .def_property_readonly("mean", &StressCycle::mean, "mean of highest and lowest [Pa]")
      .def_property_readonly("largest", &StressCycle::largest, "largest equivalent stress after von Mises [Pa]");
  addText(cycle);

  auto stress = py::class_<ToothStress, std::shared_ptr<ToothStress>>(
      module, "ToothStress",
      "Nominal stress of the flexspline, without the notch, as Stress.msg. Arrays of shape (teeth,) are views: those "
      "of "
      "a twin are overwritten by the next call of Twin.tooth_stress(); copy() keeps them.");
  stress
      .def_property_readonly("tooth_space", &stressView<0>,
                             "normal stress around the rim in the spaces beside each tooth [Pa]")
      .def_property_readonly("transition", &stressView<1>, "along the axis where the toothed rim ends [Pa]")
      .def_property_readonly("flange", &stressView<2>, "along the axis where the cup is held [Pa]")
      .def_property_readonly(
          "shear", [](const ToothStress& self) { return py::tuple(py::cast(self.shear)); },
          "by place, the same all around [Pa]: tuple of 3, in the order tooth space, transition, flange")
      .def(
          "cycle", [](const ToothStress& self, const std::string& place) { return self.cycle(stressPlace(place)); },
          py::arg("place"),
          "What one tooth goes through in a turn, all teeth being alike: StressCycle. place: 'tooth space', "
          "'transition' or 'flange'. At the notch it is larger by stress.concentration.")
      .def(
          "worst_tooth",
          [](const ToothStress& self, const std::string& place) { return self.worstTooth(stressPlace(place)); },
          py::arg("place"), "Where the normal stress is largest in magnitude: int.")
      .def(
          "copy", [](const ToothStress& self) { return std::make_shared<ToothStress>(self); },
          "The same values in memory of their own: ToothStress.");
  addText(stress);
}
}  // namespace hjt
