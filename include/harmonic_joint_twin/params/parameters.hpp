// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "harmonic_joint_twin/params/faults.hpp"
#include "harmonic_joint_twin/params/gear_parameters.hpp"

namespace hjt
{
/// @file Parameters as plain values in SI units, with one struct for each section of the configuration. No field has a
/// default. docs/parameters.md gives unit, range and meaning of each field, from params/field_table.hpp.

struct MotorParameters
{
  double rotor_inertia{};
  double wave_generator_inertia{};
  double coulomb_torque{};
  double stribeck_torque{};
  double stribeck_velocity{};
  double presliding_angle{};
  double viscous_friction{};
  double copper_loss{};
  double torque_limit{};
  double speed_limit{};
  double current_bandwidth{};
  double torque_temperature_coefficient{};
  double torque_ripple{};
  int pole_pairs{};
  double cogging_torque{};
  int cogging_periods{};
};

struct OutputParameters
{
  double circular_spline_inertia{};
  double load_inertia{};
  double viscous_friction{};
  double coulomb_torque{};
  double tilting_moment{};
  double tilting_friction{};
  double gravity_torque{};
  double gravity_angle{};
  double torque_limit{};
  double load_torque_limit{};
};

struct BrakeParameters
{
  double holding_torque{};
  double play{};
  double delay{};
  bool engaged_at_start{};
};

/// Whether the twin computes how the losses warm the drive.
enum class ThermalModel
{
  NONE,      ///< no: the drive has the configured or received temperature
  TWO_NODES  ///< yes: the losses warm two heat capacities, grease and housing
};

struct ThermalParameters
{
  ThermalModel model{};
  double grease_capacity{};
  double housing_capacity{};
  double internal_conductance{};
  double ambient_conductance{};
  double standby_power{};
  double grease_rise{};
  double housing_rise{};
};

/// Computation of the ring's equilibrium: always by the full ring, or by a response surface for angles in its range.
enum class SceneKind
{
  FULL_RING,
  AUTO
};

struct SolverParameters
{
  double rate{};
  double force_tolerance{};
  int max_iterations{};
  int max_step_cuts{};
  double stiction_velocity{};
  SceneKind scene{};
};

struct SensorParameters
{
  int motor_counts_per_turn{};
  int output_counts_per_turn{};
  double velocity_window{};
  double motor_eccentricity{};
  std::array<double, 2> motor_lines{};
  double motor_noise{};
  double output_eccentricity{};
  std::array<double, 2> output_lines{};
  double output_noise{};
  double torque_noise{};
  double torque_resolution{};
  double delay{};
  int noise_seed{};
};

/// Parameters for the computation of indicators from the drive's signals, and for their assessment.
struct IndicatorParameters
{
  double sample_rate{};
  double window_turns{};
  double window_time{};
  double least_speed{};
  double speed_change{};
  double stiffness_torque{};
  double lost_motion_torque{};
  int baseline_windows{};
  int baseline_classes{};
  double least_spread{};
  double false_alarm_rate{};
  int evidence_windows{};
  double error_factor{};
  std::string signatures{ NO_FILE };
};

struct HealthParameters
{
  double stiffness_torque_span{};
  double averaging_time{};
};

/// Places of the flexspline with the largest stresses. Arrays with one value for each place are in this order.
enum class StressPlace
{
  TOOTH_SPACE,  ///< rim between two teeth
  TRANSITION,   ///< wall of the cup, at the end of the toothed rim
  FLANGE        ///< wall of the cup, at the flange
};
constexpr std::size_t STRESS_PLACES = 3;

/// Coefficients from which, with the shape of the flexspline, its stress is computed (statics/flexspline_stress.hpp).
struct StressParameters
{
  double tooth_base{};
  double wall_thickness{};
  double cup_length{};
  double coning_restraint{};
  double warping_restraint{};
  std::array<double, STRESS_PLACES> concentration{};
  std::array<double, STRESS_PLACES> notch_radius{};
};

/// Coefficients of ageing, and limits of wear (life/ageing_laws.hpp).
struct LifeParameters
{
  double rated_torque{};
  double repeated_peak_torque{};
  double momentary_peak_torque{};
  double momentary_peak_cycles{};
  double rated_speed{};
  double bearing_l10{};
  double bearing_l50{};
  double spall_growth{};
  double spall_spread{};
  double face_width{};
  double elastic_modulus{};
  double flank_wear_coefficient{};
  double interface_wear_coefficient{};
  double wear_spread{};
  double flank_wear_limit{};
  double interface_wear_limit{};
  double grease_turns{};
  double grease_temperature{};
  double grease_halving{};
  double grease_wear_factor{};
  double ultimate_strength{};
  double endurance_limit{};
  double endurance_cycles{};
  double fatigue_exponent{};
  double fatigue_spread{};
  double flaw_depth{};
  double crack_coefficient{};
  double crack_exponent{};
  double crack_threshold{};
  std::string use_record;
  double forecast_period{};
};

/// Least and largest allowed temperature of the drive [degC].
constexpr double MIN_TEMPERATURE = -40.0;
constexpr double MAX_TEMPERATURE = 150.0;

/// Signals that drive the twin of the node.
enum class InputMode
{
  COMMANDS,  ///< commanded torques drive the twin, without a robot
  TORQUE,    ///< the measured current of a robot drives the twin, and measured angles do not correct the twin
  MOTION,    ///< the twin predicts torque and current of a sound joint from the measured motion
  OBSERVER   ///< the measured current drives the twin, and the measured angles correct its states
};

/// Source of the load of a joint whose motion a robot measures.
enum class LoadSource
{
  MODEL,          ///< weight and inertia from the section `output` of the configuration
  LOAD_TORQUE,    ///< weight and inertia from the section `output`, plus the received external torque
  TARGET_MOMENT,  ///< only the received torque, for example the controller's torque of the rigid links
  ARM             ///< torque of links and payload, computed from the motion of all joints of the arm
};

/// Quantity that a robot publishes as the effort of a joint.
enum class EffortUnit
{
  CURRENT,       ///< current of the motor [A]
  JOINT_TORQUE,  ///< torque of the motor times the ratio, without the losses of the gear [N.m]
  MOTOR_TORQUE   ///< torque at the motor's shaft [N.m]
};

struct InputParameters
{
  InputMode mode{};
  double command_timeout{};
  double delay{};
  bool wait_for_first_input{};
  double temperature{};
};

struct TelemetryParameters
{
  double torque_per_current{};
  double current_offset{};
  double presliding_angle{};
  double lasting_share{};
  double inertia_in_load{};
  std::array<double, 2> ripple_circular_spline_2{};
  std::array<double, 2> ripple_flexspline_2{};
  std::array<double, 2> ripple_circular_spline_4{};
  std::array<double, 2> ripple_flexspline_4{};
  double ripple_resonance{};
  double ripple_damping{};
  double ripple_lag{};
  double ripple_fastest{};
  double current_deviation{};
  EffortUnit effort{};
  LoadSource load{};
};

/// Standard deviations of the observer's measurements and disturbance, which determine the gains of the observer.
struct ObserverParameters
{
  double output_angle_noise{};
  double motor_angle_noise{};
  double torque_noise{};
  double load_noise{};
  double disturbance_growth{};
};

/// Tolerances for the differences of a sound joint from its twin, and from one recording of the joint to the next.
struct ComparisonParameters
{
  double friction_tolerance{};
  double compliance_tolerance{};
  double repeat_tolerance{};
};

struct PublishParameters
{
  double joint_states_rate{};
  double encoders_rate{};
  double contact_forces_rate{};
  double health_rate{};
  double stress_rate{};
  double indicators_rate{};
};

struct RealtimeParameters
{
  double deadline{};
  int priority{};
  bool lock_memory{};
  int processor{};
};

struct JointParameters
{
  std::string name{};
  std::string hardware_id{};
};

/// Sizes of the faults at severity 1, by kind of fault.
struct FaultScaleParameters
{
  double interface_wear_depth{};
  double interface_friction_factor{};
  double cup_crack_fraction{};
  double rear_section_share{};
  double flange_share{};
  double cup_crack_friction_factor{};
  double viscosity_factor{};
  double boundary_friction_factor{};
  double tooth_wear_depth{};
  double tooth_compliance_share{};
  double pitted_fraction{};
  double pitted_friction_factor{};
  double wave_generator_wear_depth{};
  double race_fit_stiffness{};
  double race_bending_preload{};
  double rim_crack_depth{};
  int rim_crack_segments{};
  double buckling_stiffness_loss{};
  double buckling_out_of_round{};
  int buckling_waves{};
  double ratcheting_eccentricity{};
  double ratcheting_tip_loss{};
  double spall_depth{};
  double spall_length{};
  double cage_deflection{};
};

struct Parameters
{
  JointParameters joint;
  GearParameters gear;
  ManufactureParameters manufacture;
  RingParameters ring;
  ContactParameters contact;
  MeshParameters mesh;
  CupParameters cup;
  BearingParameters bearing;
  MotorParameters motor;
  OutputParameters output;
  BrakeParameters brake;
  ThermalParameters thermal;
  SolverParameters solver;
  SensorParameters sensors;
  HealthParameters health;
  IndicatorParameters indicators;
  StressParameters stress;
  LifeParameters life;
  InputParameters input;
  TelemetryParameters telemetry;
  ObserverParameters observer;
  ComparisonParameters comparison;
  PublishParameters publish;
  FaultScaleParameters fault_scale;
  std::vector<Fault> faults;  ///< faults that are active at the start or that set in later
  RealtimeParameters realtime;
};
}  // namespace hjt
