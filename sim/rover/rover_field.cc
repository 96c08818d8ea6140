#include "sim/rover/rover_field.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

namespace slipway::sim {
namespace {

constexpr auto kOptional = FieldPresence::kOptional;
constexpr auto kLessKnown = FieldPresence::kLessKnown;
constexpr auto kUnlessInitial = FieldWriting::kUnlessInitial;
constexpr auto kRadians = KeptAs::kRadians;
constexpr auto kPerRadian = KeptAs::kPerRadian;

constexpr std::array kMass{
    ModelField<RoverModel>{.field = {"mass_kg", "kg", "of the whole rover", 1.0, 5000.0, 100.0},
                           .number = [](RoverModel& r) -> double& { return r.mass_kg; }},
};

using Maybe = std::optional<double>;

constexpr std::array kPartMasses{
    ModelField<MassDistribution>{
        .field = {"wheel_kg", "kg", "of each wheel with its motors", 1e-3, 5000.0, 5.0},
        .maybe = [](MassDistribution& m) -> Maybe& { return m.wheel_kg; },
        .presence = kOptional},
    ModelField<MassDistribution>{.field = {"rocker_kg", "kg", "of each rocker", 1e-3, 5000.0, 5.0},
                                 .maybe = [](MassDistribution& m) -> Maybe& { return m.rocker_kg; },
                                 .presence = kOptional},
    ModelField<MassDistribution>{.field = {"bogie_kg", "kg", "of each bogie", 1e-3, 5000.0, 3.0},
                                 .maybe = [](MassDistribution& m) -> Maybe& { return m.bogie_kg; },
                                 .presence = kOptional},
};

constexpr std::array kWheel{
    ModelField<WheelModel>{.field = {"radius_m", "m", "of the rim", 0.01, 2.0, 0.125},
                           .number = [](WheelModel& w) -> double& { return w.radius_m; }},
    ModelField<WheelModel>{.field = {"width_m", "m", "of the rim", 0.005, 2.0, 0.16},
                           .number = [](WheelModel& w) -> double& { return w.width_m; }},
};

constexpr std::array kGrousers{
    ModelField<Grousers>{
        .field = {"height_m", "m", "of each grouser, at most the wheel's radius", 0.0, 1.0, 0.0},
        .number = [](Grousers& g) -> double& { return g.height_m; }},
    ModelField<Grousers>{.field = {"count", "1", "around the rim", 0.0, 500.0, 0.0},
                         .number = [](Grousers& g) -> double& { return g.count; }},
    ModelField<Grousers>{.field = {"thrust", "1", "share of their passive thrust", 0.0, 1.0, 1.0},
                         .number = [](Grousers& g) -> double& { return g.thrust; },
                         .presence = kOptional,
                         .writing = FieldWriting::kUnlessInitial},
    ModelField<Grousers>{.field = {"braking", "1", "share of their thrust that brakes", 0.0, 1.0, 1.0},
                         .number = [](Grousers& g) -> double& { return g.braking; },
                         .presence = kOptional,
                         .writing = FieldWriting::kUnlessInitial},
    ModelField<Grousers>{
        .field = {"by_slip", "1", "share of their shear displacement that follows from slip alone", 0.0, 1.0,
                  0.0},
        .number = [](Grousers& g) -> double& { return g.by_slip; },
        .presence = kOptional,
        .writing = FieldWriting::kUnlessInitial},
    ModelField<Grousers>{
        .field = {"surcharge", "1", "share of the rim's pressure that presses on the soil before a grouser",
                  0.0, 1.0, 0.0},
        .number = [](Grousers& g) -> double& { return g.surcharge; },
        .presence = kOptional,
        .writing = FieldWriting::kUnlessInitial},
    ModelField<Grousers>{.field = {"shear_share", "1",
                                   "where the soil is sheared: 0 at the rim, 1 at the tips", 0.0, 1.0, 0.0},
                         .number = [](Grousers& g) -> double& { return g.shear_share; },
                         .presence = kOptional,
                         .writing = FieldWriting::kUnlessInitial},
    ModelField<Grousers>{
        .field = {"shear_by_spacing", "1", "how much of what height and spacing give is added to that share",
                  0.0, 1.0, 0.0},
        .number = [](Grousers& g) -> double& { return g.shear_by_spacing; },
        .presence = kOptional,
        .writing = FieldWriting::kUnlessInitial},
};

constexpr std::array kDifferential{
    ModelField<Suspension>{
        .field = {"differential_stiffness_nm_per_deg", "N m/deg",
                  "torque on each rocker per sum of the rockers' angles", 1.7e-5, 1e7, 100.0},
        .maybe = [](Suspension& s) -> Maybe& { return s.differential_stiffness_nm_rad; },
        .presence = kOptional,
        .kept_as = kPerRadian},
    ModelField<Suspension>{.field = {"differential_damping_nms_per_deg", "N m s/deg",
                                     "torque on each rocker per rate of the rockers' angles", 0.0, 1e6, 10.0},
                           .maybe = [](Suspension& s) -> Maybe& { return s.differential_damping_nms_rad; },
                           .presence = kOptional,
                           .kept_as = kPerRadian},
    ModelField<Suspension>{
        .field = {"rocker_stop_deg", "deg", "either way from the rockers' place at rest", 0.57, 90.0, 45.0},
        .maybe = [](Suspension& s) -> Maybe& { return s.rocker_stop_rad; },
        .presence = kOptional,
        .kept_as = kRadians},
};

constexpr std::array kBogie{
    ModelField<Suspension>{
        .field = {"bogie_stop_deg", "deg", "either way from the bogies' place at rest", 0.57, 90.0, 45.0},
        .maybe = [](Suspension& s) -> Maybe& { return s.bogie_stop_rad; },
        .presence = kOptional,
        .kept_as = kRadians},
};

constexpr std::array kMotor{
    ModelField<DriveMotor>{.field = {"torque_constant_nm_per_a", "N m/A", "of the motor", 1e-4, 10.0, 0.05},
                           .number = [](DriveMotor& m) -> double& { return m.torque_constant_nm_per_a; }},
    ModelField<DriveMotor>{.field = {"gear_ratio", "1", "motor turns per wheel turn", 1.0, 1e5, 100.0},
                           .number = [](DriveMotor& m) -> double& { return m.gear_ratio; }},
    ModelField<DriveMotor>{.field = {"gear_efficiency", "1", "torque out over torque in", 0.05, 1.0, 0.8},
                           .number = [](DriveMotor& m) -> double& { return m.gear_efficiency; }},
    ModelField<DriveMotor>{
        .field = {"no_load_current_a", "A", "of motor and gear without load", 0.0, 10.0, 0.1},
        .number = [](DriveMotor& m) -> double& { return m.no_load_current_a; }},
    ModelField<DriveMotor>{
        .field = {"damping_nms_rad", "N m s/rad", "viscous drag at the motor", 0.0, 10.0, 0.0},
        .number = [](DriveMotor& m) -> double& { return m.damping_nms_rad; },
        .presence = kOptional,
        .writing = kUnlessInitial},
    ModelField<DriveMotor>{
        .field = {"max_wheel_rate_deg_s", "deg/s", "greatest wheel rate", 0.057, 5000.0, 20.0},
        .number = [](DriveMotor& m) -> double& { return m.max_wheel_rate_rad_s; },
        .kept_as = kRadians},
    ModelField<DriveMotor>{.field = {"bus_voltage_v", "V", "of the supply", 1.0, 400.0, 28.0},
                           .number = [](DriveMotor& m) -> double& { return m.bus_voltage_v; }},
    ModelField<DriveMotor>{.field = {"resistance_ohm", "ohm", "of the windings", 1e-3, 1000.0, 1.0},
                           .maybe = [](DriveMotor& m) -> Maybe& { return m.resistance_ohm; },
                           .presence = kOptional},
    ModelField<DriveMotor>{.field = {"max_current_a", "A", "that the driver lets through", 1e-3, 1000.0, 5.0},
                           .maybe = [](DriveMotor& m) -> Maybe& { return m.max_current_a; },
                           .presence = kOptional},
    ModelField<DriveMotor>{.field = {"rotor_inertia_kg_m2", "kg m2", "of the rotor", 0.0, 1.0, 4e-7},
                           .number = [](DriveMotor& m) -> double& { return m.rotor_inertia_kg_m2; },
                           .presence = kOptional,
                           .writing = kUnlessInitial},
    ModelField<DriveMotor>{
        .field = {"thermal_resistance_k_w", "K/W", "from motor and gear to the air", 0.01, 1000.0, 7.0},
        .maybe = [](DriveMotor& m) -> Maybe& { return m.thermal_resistance_k_w; },
        .presence = kOptional},
    ModelField<DriveMotor>{
        .field = {"thermal_time_constant_s", "s", "of motor and gear in the air", 1.0, 1e6, 1000.0},
        .maybe = [](DriveMotor& m) -> Maybe& { return m.thermal_time_constant_s; },
        .presence = kOptional},
    ModelField<DriveMotor>{
        .field = {"min_temp_c", "degC", "the coldest at which it is driven", -273.0, 500.0, -55.0},
        .maybe = [](DriveMotor& m) -> Maybe& { return m.min_temp_c; },
        .presence = kOptional},
    ModelField<DriveMotor>{
        .field = {"max_temp_c", "degC", "the warmest at which it is driven", -273.0, 500.0, 100.0},
        .maybe = [](DriveMotor& m) -> Maybe& { return m.max_temp_c; },
        .presence = kOptional},
};

constexpr std::array kPower{
    ModelField<PowerSupply>{
        .field = {"constant_w", "W", "of a source that gives the same all day", 0.0, 1e5, 110.0},
        .number = [](PowerSupply& p) -> double& { return p.constant_w; },
        .presence = kOptional},
    ModelField<PowerSupply>{
        .field = {"array_m2", "m^2", "of solar cells, flat on the body", 0.0, 1000.0, 1.3},
        .number = [](PowerSupply& p) -> double& { return p.array_m2; },
        .presence = kOptional},
    ModelField<PowerSupply>{
        .field = {"upright_array_m2", "m^2",
                  "of solar cells that stand upright around the body, as much to each side", 0.0, 1000.0,
                  0.0},
        .number = [](PowerSupply& p) -> double& { return p.upright_array_m2; },
        .presence = kOptional,
        .writing = kUnlessInitial},
    ModelField<PowerSupply>{
        .field = {"array_efficiency", "1", "power over the light on clean cells", 0.0, 1.0, 0.2},
        .number = [](PowerSupply& p) -> double& { return p.array_efficiency; },
        .presence = kOptional},
    ModelField<PowerSupply>{
        .field = {"array_clean", "1", "share of the light that dust on the cells lets through", 0.0, 1.0,
                  1.0},
        .number = [](PowerSupply& p) -> double& { return p.array_clean; },
        .presence = kOptional},
    ModelField<PowerSupply>{
        .field = {"battery_wh", "Wh", "that may be used, from empty to full", 1.0, 1e6, 500.0},
        .number = [](PowerSupply& p) -> double& { return p.battery_wh; }},
    ModelField<PowerSupply>{.field = {"standing_w", "W", "that a standing rover needs", 0.0, 1e5, 50.0},
                            .number = [](PowerSupply& p) -> double& { return p.standing_w; }},
    ModelField<PowerSupply>{
        .field = {"driving_w", "W", "that a driving rover needs besides its drive motors", 0.0, 1e5, 100.0},
        .number = [](PowerSupply& p) -> double& { return p.driving_w; }},
    ModelField<PowerSupply>{.field = {"heating_w", "W", "of heaters, besides, in cold air", 0.0, 1e5, 0.0},
                            .number = [](PowerSupply& p) -> double& { return p.heating_w; },
                            .presence = kOptional},
    ModelField<PowerSupply>{
        .field = {"heating_below_c", "degC", "the air below which heaters work", -273.0, 100.0, -200.0},
        .number = [](PowerSupply& p) -> double& { return p.heating_below_c; },
        .presence = kOptional},
};

constexpr std::array kClosures{
    ModelField<RoverModel>{.field = {"pull_below_axle", "1",
                                     "share of a wheel's pull that acts at the rim's lowest "
                                     "point",
                                     0.0, 1.0, 0.0},
                           .number = [](RoverModel& r) -> double& { return r.pull_below_axle; },
                           .presence = kOptional,
                           .writing = kUnlessInitial},
    ModelField<RoverModel>{
        .field = {"wheel_weight", "1", "share of the wheels' own weight that hangs at the wheels", 0.0, 3.0,
                  0.0},
        .number = [](RoverModel& r) -> double& { return r.wheel_weight; },
        .presence = kOptional,
        .writing = kUnlessInitial},
};

constexpr std::array kBody{
    ModelField<RoverModel>{
        .field = {"belly_clearance_m", "m", "of the body over level ground", 0.01, 2.0, 0.3},
        .number = [](RoverModel& r) -> double& { return r.belly_clearance_m; },
        .presence = kLessKnown},
    ModelField<RoverModel>{
        .field = {"body_length_m", "m", "of the rectangle that must stay clear", 0.1, 10.0, 1.6},
        .number = [](RoverModel& r) -> double& { return r.body_length_m; },
        .presence = kLessKnown},
    ModelField<RoverModel>{
        .field = {"body_width_m", "m", "of the rectangle that must stay clear", 0.1, 10.0, 1.5},
        .number = [](RoverModel& r) -> double& { return r.body_width_m; },
        .presence = kLessKnown},
    ModelField<RoverModel>{.field = {"max_tilt_deg", "deg", "greatest tilt of the body", 0.57, 60.0, 28.6},
                           .number = [](RoverModel& r) -> double& { return r.max_tilt_rad; },
                           .presence = kLessKnown,
                           .kept_as = kRadians},
    ModelField<RoverModel>{.field = {"cruise_speed_m_s", "m/s", "commanded on the straight", 1e-4, 5.0, 0.04},
                           .number = [](RoverModel& r) -> double& { return r.cruise_speed_m_s; },
                           .presence = kLessKnown},
    ModelField<RoverModel>{
        .field = {"turn_rate_deg_s", "deg/s", "commanded turning in place", 0.0057, 100.0, 1.7},
        .number = [](RoverModel& r) -> double& { return r.turn_rate_rad_s; },
        .presence = kLessKnown,
        .kept_as = kRadians},
    ModelField<RoverModel>{.field = {"min_turn_radius_m", "m", "of an arc", 0.0, 100.0, 1.5},
                           .number = [](RoverModel& r) -> double& { return r.min_turn_radius_m; },
                           .presence = kLessKnown},
};

}  // namespace

std::span<const ModelField<RoverModel>> mass_fields() {
  return kMass;
}
std::span<const ModelField<MassDistribution>> part_mass_fields() {
  return kPartMasses;
}
std::span<const ModelField<WheelModel>> wheel_fields() {
  return kWheel;
}
std::span<const ModelField<Grousers>> grouser_fields() {
  return kGrousers;
}
std::span<const ModelField<Suspension>> differential_fields() {
  return kDifferential;
}
std::span<const ModelField<Suspension>> bogie_fields() {
  return kBogie;
}
std::span<const ModelField<DriveMotor>> motor_fields() {
  return kMotor;
}
std::span<const ModelField<PowerSupply>> power_fields() {
  return kPower;
}
std::span<const ModelField<RoverModel>> closure_fields() {
  return kClosures;
}
std::span<const ModelField<RoverModel>> body_fields() {
  return kBody;
}

std::string out_of_range_in_words(std::string_view key, double value, const Field& field) {
  const bool unit = field.unit != "1";
  return fmt::format("{} = {:g}{}{}, must be in [{:g}, {:g}]", key, value, unit ? " " : "",
                     unit ? field.unit : "", field.lowest, field.highest);
}

template <class Owner>
void check_fields(std::span<const ModelField<Owner>> fields, const Owner& object, const std::string& pointer,
                  std::vector<Fault>& faults) {
  Owner copy = object;
  for (const ModelField<Owner>& row : fields) {
    const std::optional<double> kept =
        row.maybe != nullptr ? row.maybe(copy) : std::optional(row.number(copy));
    if (!kept) continue;
    // A value at the end of the range may pass it by rounding, in and out of degrees.
    const double value = row.to_boundary(*kept), near = 1e-12 * std::abs(value);
    if (row.holds(value) || row.holds(value + near) || row.holds(value - near)) continue;
    faults.push_back({pointer + "/" + std::string(row.field.name),
                      out_of_range_in_words(row.field.name, value, row.field)});
  }
}

template void check_fields(std::span<const ModelField<RoverModel>>, const RoverModel&, const std::string&,
                           std::vector<Fault>&);
template void check_fields(std::span<const ModelField<MassDistribution>>, const MassDistribution&,
                           const std::string&, std::vector<Fault>&);
template void check_fields(std::span<const ModelField<WheelModel>>, const WheelModel&, const std::string&,
                           std::vector<Fault>&);
template void check_fields(std::span<const ModelField<Grousers>>, const Grousers&, const std::string&,
                           std::vector<Fault>&);
template void check_fields(std::span<const ModelField<Suspension>>, const Suspension&, const std::string&,
                           std::vector<Fault>&);
template void check_fields(std::span<const ModelField<PowerSupply>>, const PowerSupply&, const std::string&,
                           std::vector<Fault>&);
template void check_fields(std::span<const ModelField<DriveMotor>>, const DriveMotor&, const std::string&,
                           std::vector<Fault>&);

}  // namespace slipway::sim
