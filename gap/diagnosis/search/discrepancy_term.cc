#include "gap/diagnosis/search/discrepancy_term.h"

#include <algorithm>
#include <cmath>

#include "core/angle.h"
#include "gap/diagnosis/search/effect_trace.h"
#include "sim/effects/attitude_bias.h"
#include "sim/effects/com_offset.h"
#include "sim/effects/effect_catalogue.h"
#include "sim/effects/steering_offset.h"

namespace slipway::gap {
namespace {

constexpr std::array<std::string_view, 13> kEntryNames{"tangential_force",
                                                       "lateral_force",
                                                       "wheel_load_fore_aft",
                                                       "wheel_load_left_right",
                                                       "kinematics",
                                                       "pressure_sinkage",
                                                       "slip_sensor",
                                                       "side_slip",
                                                       "yaw",
                                                       "roll_sensor",
                                                       "pitch_sensor",
                                                       "torque_to_current",
                                                       "sinkage"};

constexpr std::array<std::string_view, kCircumstances> kCircumstanceNames{
    "constant",  "pitch",   "roll",        "slip", "direction", "speed",
    "curvature", "turning", "temperature", "east", "north",     "order"};

// What an effect's law may depend on otherwise than the library's does.
constexpr std::array kFormCircumstances{Circumstance::kPitch, Circumstance::kSlip,
                                        Circumstance::kTemperature};

constexpr std::array<Entry, kLevers> kLeverEntries{Entry::kTangentialForce, Entry::kLateralForce,
                                                   Entry::kWheelLoadForeAft, Entry::kWheelLoadLeftRight,
                                                   Entry::kKinematics};

// Effects of the catalogue as levers: what a force along, a force across, a shifted load, a turned wheel
// does. Their bounds are never reached: only derivatives are taken.
std::vector<EffectVariant> levers(const DiscrepancyOptions& options) {
  const auto lever = [](const sim::Effect& effect, std::vector<EffectVariant::Free> free,
                        std::vector<std::pair<std::string, double>> fixed = {}) {
    EffectVariant v;
    v.effect = effect.name;
    v.free = std::move(free);
    v.fixed = std::move(fixed);
    return v;
  };
  const double tilt = options.tilt_deg, shift = options.load_shift_m;
  return {lever(sim::kAttitudeBias, {{"pitch_deg", tilt, -10.0, 10.0}, {"roll_deg", tilt, -10.0, 10.0}}),
          lever(sim::kComOffset, {{"x_m", shift, -0.5, 0.5}, {"y_m", shift, -0.5, 0.5}}),
          lever(sim::kSteeringOffset, {{"angle_deg", options.steering_deg, -20.0, 20.0}}, {{"wheel", -1.0}})};
}

// A force that keeps its direction on the map and what changes over the hours could enter at some points
// only. The other circumstances go with every entry.
bool may_depend(Entry entry, Circumstance circumstance) {
  switch (circumstance) {
    case Circumstance::kEast:
    case Circumstance::kNorth:
      return entry == Entry::kTangentialForce || entry == Entry::kLateralForce;
    case Circumstance::kOrder:
      return entry == Entry::kTangentialForce || entry == Entry::kPressureSinkage ||
             entry == Entry::kSlipSensor || entry == Entry::kTorqueToCurrent;
    default:
      return true;
  }
}

Circumstances circumstances_of(const WindowModel& model, std::size_t w, double slip, double mean_speed,
                               const DiscrepancyOptions& options) {
  const DriveWindow& window = model.windows()[w];
  const WindowModel::Conditions& at = model.conditions(w);
  const sim::DriveCommand& command = window.command;
  const double speed = std::abs(command.speed_m_s);
  const double yaw = window.middle().yaw_rad;
  const auto last_drive = static_cast<double>(model.windows().back().drive);
  return {1.0,
          at.pitch_rad / rad_from_deg(options.pitch_deg),
          at.roll_rad / rad_from_deg(options.roll_deg),
          slip / options.slip,
          command.turn_in_place     ? 0.0
          : command.speed_m_s < 0.0 ? -1.0
                                    : 1.0,
          command.turn_in_place || mean_speed == 0.0 ? 0.0 : 2.0 * (speed / mean_speed - 1.0),
          command.turn_in_place ? 0.0 : command.curvature_1_m / options.curvature_1_m,
          command.turn_in_place ? 1.0 : 0.0,
          command.motor_temp_c ? *command.motor_temp_c / options.temperature_c : 0.0,
          std::cos(yaw),
          std::sin(yaw),
          last_drive > 0.0 ? 2.0 * static_cast<double>(window.drive) / last_drive - 1.0 : 0.0};
}

// Which axle each wheel is on, from the front.
std::vector<int> axles(const sim::RoverModel& rover) {
  std::vector<int> of;
  for (const sim::WheelModel& wheel : rover.wheels) {
    int ahead = 0;
    for (const sim::WheelModel& other : rover.wheels)
      ahead += other.position_m.x() > wheel.position_m.x() + 0.01 &&
                       other.position_m.y() * wheel.position_m.y() > 0.0
                   ? 1
                   : 0;
    of.push_back(ahead);
  }
  return of;
}

// What an entry point does to every observation.
struct EntryResponse {
  Entry entry = Entry::kTangentialForce;
  int wheel = -1;
  Eigen::VectorXd response;
};

// Of forces, loads and the ground: by the columns of a hypothesis with the levers as its last effects.
std::vector<EntryResponse> force_responses(const Hypothesis& probe, const Eigen::MatrixXd& jacobian) {
  std::vector<EntryResponse> responses;
  for (std::size_t k = 0; k < kLeverEntries.size(); ++k)
    responses.push_back(
        {kLeverEntries[k], -1, jacobian.rightCols(kLevers).col(static_cast<Eigen::Index>(k))});
  Eigen::VectorXd stiffness = Eigen::VectorXd::Zero(jacobian.rows());
  for (Eigen::Index p = 0; p < static_cast<Eigen::Index>(probe.nuisance_count()); ++p)
    if (probe.parameters()[static_cast<std::size_t>(p)].quantity == SoilQuantity::kStiffness)
      stiffness += jacobian.col(p);
  responses.push_back({Entry::kPressureSinkage, -1, std::move(stiffness)});
  return responses;
}

// Of readings: an offset of one channel, or a share of the predicted currents.
std::vector<EntryResponse> reading_responses(const WindowModel& model, std::span<const double> expected,
                                             const DiscrepancyOptions& options) {
  struct Offset {
    Entry entry;
    Channel channel;
    double size;
  };
  std::vector<EntryResponse> responses;
  const auto add = [&](Entry entry, int wheel, const auto& value) {
    Eigen::VectorXd response = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(model.observation_count()));
    Eigen::Index i = 0;
    for (const DriveWindow& window : model.windows())
      for (const Observation& o : window.observations) {
        const double f = expected[static_cast<std::size_t>(i)];
        response[i++] = value(o, std::isfinite(f) ? f : 0.0);
      }
    responses.push_back({entry, wheel, std::move(response)});
  };
  const auto add_offset = [&](const Offset& offset) {
    add(offset.entry, -1,
        [&](const Observation& o, double) { return o.channel == offset.channel ? offset.size : 0.0; });
  };
  const auto add_current = [&](int wheel) {
    add(Entry::kTorqueToCurrent, wheel, [&](const Observation& o, double f) {
      return o.channel == Channel::kCurrent && (wheel < 0 || o.wheel == wheel) ? options.current_share * f
                                                                               : 0.0;
    });
  };
  for (const Offset& offset : {Offset{Entry::kSlipSensor, Channel::kSlip, options.slip_reading},
                               Offset{Entry::kSideSlip, Channel::kSideSlip, options.side_slip_reading},
                               Offset{Entry::kYaw, Channel::kYawRate, options.yaw_rate_rad_s},
                               Offset{Entry::kRollSensor, Channel::kRoll, options.attitude_rad},
                               Offset{Entry::kPitchSensor, Channel::kPitch, options.attitude_rad}})
    add_offset(offset);
  add_current(-1);
  add_offset({Entry::kSinkage, Channel::kSinkage, options.sinkage_m});
  for (std::size_t k = 0; k < model.campaign().rover->wheels.size(); ++k) add_current(static_cast<int>(k));
  return responses;
}

// A response in every window times what the window met.
Eigen::VectorXd times_circumstance(Eigen::VectorXd response, const WindowModel& model,
                                   std::span<const Circumstances> met, std::size_t circumstance) {
  for (std::size_t w = 0; w < met.size(); ++w)
    response.segment(static_cast<Eigen::Index>(model.offset(w)),
                     static_cast<Eigen::Index>(model.windows()[w].observations.size())) *=
        met[w][circumstance];
  return response;
}

Eigen::MatrixXd side_by_side(Eigen::Index rows, std::span<const Eigen::VectorXd> columns) {
  Eigen::MatrixXd values(rows, static_cast<Eigen::Index>(columns.size()));
  for (std::size_t c = 0; c < columns.size(); ++c) values.col(static_cast<Eigen::Index>(c)) = columns[c];
  return values;
}

}  // namespace

std::string_view name_of(Entry entry) {
  return kEntryNames[static_cast<std::size_t>(entry)];
}

std::string_view name_of(Circumstance circumstance) {
  return kCircumstanceNames[static_cast<std::size_t>(circumstance)];
}

std::vector<Circumstances> circumstances(const WindowModel& model, std::span<const double> expected,
                                         const DiscrepancyOptions& options) {
  double mean_speed = 0.0;
  int driven = 0;
  for (const DriveWindow& window : model.windows())
    if (!window.command.turn_in_place) {
      mean_speed += std::abs(window.command.speed_m_s);
      ++driven;
    }
  if (driven > 0) mean_speed /= driven;
  std::vector<Circumstances> met;
  for (std::size_t w = 0; w < model.windows().size(); ++w) {
    double slip = 0.0;
    for (std::size_t i = 0; i < model.windows()[w].observations.size(); ++i)
      if (model.windows()[w].observations[i].channel == Channel::kSlip) slip = expected[model.offset(w) + i];
    met.push_back(circumstances_of(model, w, std::isfinite(slip) ? slip : 0.0, mean_speed, options));
  }
  return met;
}

Eigen::MatrixXd lever_responses(const DriveCampaign& campaign, const WindowModel& model,
                                std::span<const double> null_x, const DiscrepancyOptions& options,
                                std::size_t threads) {
  const Hypothesis probe(campaign, levers(options));
  std::vector<double> x = probe.neutral();
  std::copy_n(null_x.begin(), probe.nuisance_count(), x.begin());
  Eigen::MatrixXd responses = probe.scaled_jacobian(model, x, threads).rightCols(kLevers);
  const double tilt = rad_from_deg(options.tilt_deg), steering = rad_from_deg(options.steering_deg);
  const std::array<double, kLevers> units{tilt, tilt, options.load_shift_m, options.load_shift_m, steering};
  for (int k = 0; k < kLevers; ++k) responses.col(k) /= units[static_cast<std::size_t>(k)];
  return responses;
}

DiscrepancyTerm make_discrepancy_term(const DriveCampaign& campaign, const WindowModel& model,
                                      const FittedExplanation& fit, const DiscrepancyOptions& options,
                                      std::size_t threads) {
  // A force does something else to a rover whose wheel drags than to the nominal one.
  std::vector<EffectVariant> effects(fit.hypothesis.effects().begin(), fit.hypothesis.effects().end());
  for (EffectVariant& lever : levers(options)) effects.push_back(std::move(lever));
  const Hypothesis probe(campaign, std::move(effects));
  std::vector<double> x = fit.x;
  const std::vector<double> neutral = probe.neutral();
  x.insert(x.end(), neutral.begin() + static_cast<std::ptrdiff_t>(x.size()), neutral.end());
  const Eigen::MatrixXd jacobian = probe.scaled_jacobian(model, x, threads);
  const std::vector<double> expected = probe.predict(model, x, threads);

  std::vector<EntryResponse> responses = force_responses(probe, jacobian);
  for (EntryResponse& reading : reading_responses(model, expected, options))
    responses.push_back(std::move(reading));
  const std::vector<Circumstances> met = circumstances(model, expected, options);
  DiscrepancyTerm discrepancy;
  std::vector<Eigen::VectorXd> columns;
  for (const EntryResponse& of : responses) {
    // One motor alone is off by a constant share.
    const std::size_t used = met.empty() ? 0 : of.wheel < 0 ? kCircumstances : 1;
    for (std::size_t v = 0; v < used; ++v) {
      const auto circumstance = static_cast<Circumstance>(v);
      if (!may_depend(of.entry, circumstance)) continue;
      Eigen::VectorXd column = times_circumstance(of.response, model, met, v);
      if (column.squaredNorm() == 0.0) continue;
      columns.push_back(std::move(column));
      discrepancy.columns.push_back({of.entry, of.wheel, circumstance});
    }
  }
  discrepancy.values = side_by_side(static_cast<Eigen::Index>(model.observation_count()), columns);
  return discrepancy;
}

bool acts_throughout(Circumstance circumstance) {
  return circumstance == Circumstance::kConstant || circumstance == Circumstance::kDirection;
}

WhiteTerm whitened(const PosteriorMode& fit, const NoiseModel& noise, const DiscrepancyTerm& discrepancy) {
  WhiteTerm white{fit.row_weights.asDiagonal() * noise.whiten(discrepancy.values), {}};
  for (std::size_t c = 0; c < discrepancy.columns.size(); ++c)
    if (!acts_throughout(discrepancy.columns[c].circumstance))
      white.single.push_back(static_cast<Eigen::Index>(c));
  return white;
}

Eigen::MatrixXd form_columns(const DriveCampaign& campaign, const WindowModel& model, const NoiseModel& noise,
                             const FittedExplanation& fit, const DiscrepancyOptions& options,
                             std::size_t threads) {
  const std::vector<double> with = fit.hypothesis.predict(model, fit.x, threads);
  const std::vector<Circumstances> met = circumstances(model, with, options);
  const std::vector<int> axle_of = axles(*campaign.rover);
  std::vector<Eigen::VectorXd> columns;
  for (const EffectVariant& effect : fit.hypothesis.effects()) {
    const sim::Effect* const row = sim::find_effect(effect.effect);
    if (row == nullptr || !row->has_many_forms) continue;
    const Eigen::VectorXd trace = options.form_imprecision * effect_trace(fit, model, effect.effect, threads);
    const auto add = [&](const auto& share) {
      Eigen::VectorXd column = trace;
      Eigen::Index i = 0;
      for (std::size_t w = 0; w < model.windows().size(); ++w)
        for (const Observation& o : model.windows()[w].observations) column[i++] *= share(w, o);
      if (column.squaredNorm() > 0.0) columns.push_back(std::move(column));
    };
    for (const Circumstance circumstance : kFormCircumstances)
      add([&](std::size_t w, const Observation&) { return met[w][static_cast<std::size_t>(circumstance)]; });
    for (std::size_t c = 0; c < channel_count(); ++c)
      add([&](std::size_t, const Observation& o) {
        return o.channel == static_cast<Channel>(c) ? 1.0 : 0.0;
      });
    for (int a = 0; a <= *std::max_element(axle_of.begin(), axle_of.end()); ++a)
      for (std::size_t c = 0; c < channel_count(); ++c)
        add([&](std::size_t, const Observation& o) {
          const bool there = o.wheel >= 0 && axle_of[static_cast<std::size_t>(o.wheel)] == a;
          return there && o.channel == static_cast<Channel>(c) ? 1.0 : 0.0;
        });
  }
  return fit.row_weights.asDiagonal() *
         noise.whiten(side_by_side(static_cast<Eigen::Index>(with.size()), columns));
}

}  // namespace slipway::gap
