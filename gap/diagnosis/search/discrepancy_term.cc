#include "gap/diagnosis/search/discrepancy_term.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>

#include "core/angle.h"
#include "gap/diagnosis/search/effect_trace.h"
#include "sim/effects/attitude_bias.h"
#include "sim/effects/com_offset.h"
#include "sim/effects/effect_catalogue.h"
#include "sim/effects/steering_offset.h"

namespace slipway::gap {
namespace {

constexpr std::array kSizes{0.4, 1.2, 3.6};
constexpr std::array kImprecisionShares{0.1, 0.3, 1.0};
constexpr std::array kFormSizes{0.0, 0.3, 1.0};
// What an effect's law may depend on otherwise than the library's does.
constexpr std::array<std::string_view, 2> kFormVariables{"pitch", "slip"};
constexpr double kProbe_m = 0.05;

// Effects of the catalogue as levers: what a force along, a force across, a shifted load, a turned wheel
// does.
std::vector<EffectVariant> levers() {
  const auto lever = [](const sim::Effect& effect, std::vector<EffectVariant::Free> free,
                        std::vector<std::pair<std::string, double>> fixed = {}) {
    EffectVariant v;
    v.effect = effect.name;
    v.free = std::move(free);
    v.fixed = std::move(fixed);
    return v;
  };
  return {lever(sim::kAttitudeBias, {{"pitch_deg", 1.0, -10.0, 10.0}, {"roll_deg", 1.0, -10.0, 10.0}}),
          lever(sim::kComOffset, {{"x_m", kProbe_m, -0.5, 0.5}, {"y_m", kProbe_m, -0.5, 0.5}}),
          lever(sim::kSteeringOffset, {{"angle_deg", 1.0, -20.0, 20.0}}, {{"wheel", -1.0}})};
}
constexpr std::array<std::string_view, 5> kLeverEntries{
    "tangential_force", "lateral_force", "wheel_load_fore_aft", "wheel_load_left_right", "kinematics"};

// What only some entries could depend on: a force that keeps its direction on the map, what changes over the
// hours. The other variables go with every entry.
struct RareVariable {
  std::string_view name;
  std::array<std::string_view, 4> entries;
};
constexpr std::array kRareVariables{
    RareVariable{"east", {"tangential_force", "lateral_force"}},
    RareVariable{"north", {"tangential_force", "lateral_force"}},
    RareVariable{"order", {"tangential_force", "pressure_sinkage", "slip_sensor", "torque_to_current"}}};

bool may_depend(std::string_view entry, std::string_view variable) {
  for (const RareVariable& rare : kRareVariables)
    if (rare.name == variable)
      return std::find(rare.entries.begin(), rare.entries.end(), entry) != rare.entries.end();
  return true;
}

std::vector<Circumstance> variables_of(const WindowModel& model, std::size_t w, double slip,
                                       double mean_speed) {
  const DriveWindow& window = model.windows()[w];
  const WindowModel::Conditions& at = model.conditions(w);
  const sim::DriveCommand& command = window.command;
  const double speed = std::abs(command.speed_m_s);
  const double yaw = window.stations[window.stations.size() / 2].yaw_rad;
  const auto last_drive = static_cast<double>(model.windows().back().drive);
  return {{"constant", 1.0},
          {"pitch", at.pitch_rad / rad_from_deg(10.0)},
          {"roll", at.roll_rad / rad_from_deg(10.0)},
          {"slip", slip / 0.2},
          {"direction", command.turn_in_place     ? 0.0
                        : command.speed_m_s < 0.0 ? -1.0
                                                  : 1.0},
          {"speed", command.turn_in_place || mean_speed == 0.0 ? 0.0 : 2.0 * (speed / mean_speed - 1.0)},
          {"curvature", command.turn_in_place ? 0.0 : command.curvature_1_m / 0.4},
          {"turning", command.turn_in_place ? 1.0 : 0.0},
          {"temperature", command.motor_temp_c ? *command.motor_temp_c / 30.0 : 0.0},
          {"east", std::cos(yaw)},
          {"north", std::sin(yaw)},
          {"order", last_drive > 0.0 ? 2.0 * static_cast<double>(window.drive) / last_drive - 1.0 : 0.0}};
}

Eigen::MatrixXd both(const Eigen::MatrixXd& known, const Eigen::MatrixXd& white, double size) {
  Eigen::MatrixXd columns(known.rows(), known.cols() + white.cols());
  columns << known, size * white;
  return columns;
}

// The columns of a fit with others of every size beside; `take` is told whether the size is that of something
// else, and says whether to go on.
void for_sizes(const FittedExplanation& fit, const Eigen::MatrixXd& white, const Eigen::MatrixXd& form,
               const std::function<bool(bool, const Eigen::MatrixXd&)>& take) {
  for (const double exact : kFormSizes) {
    if (exact > 0.0 && form.cols() == 0) continue;
    const Eigen::MatrixXd known = both(fit.white_jacobian, form, exact);
    for (const double share : kImprecisionShares)
      if (!take(false, both(known, white, share * kImprecision))) return;
    for (const double size : kSizes)
      if (!take(true, both(known, white, size))) return;
  }
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

// log of the mean of exp(values).
double log_mean_exp(const std::vector<double>& values) {
  const double most = *std::max_element(values.begin(), values.end());
  double sum = 0.0;
  for (const double v : values) sum += std::exp(v - most);
  return most + std::log(sum / static_cast<double>(values.size()));
}

}  // namespace

std::vector<std::vector<Circumstance>> circumstances(const WindowModel& model,
                                                     std::span<const double> expected) {
  double mean_speed = 0.0;
  int driven = 0;
  for (const DriveWindow& window : model.windows())
    if (!window.command.turn_in_place) {
      mean_speed += std::abs(window.command.speed_m_s);
      ++driven;
    }
  if (driven > 0) mean_speed /= driven;
  std::vector<std::vector<Circumstance>> variables;
  for (std::size_t w = 0; w < model.windows().size(); ++w) {
    double slip = 0.0;
    for (std::size_t i = 0; i < model.windows()[w].observations.size(); ++i)
      if (model.windows()[w].observations[i].channel == Channel::kSlip) slip = expected[model.offset(w) + i];
    variables.push_back(variables_of(model, w, std::isfinite(slip) ? slip : 0.0, mean_speed));
  }
  return variables;
}

Eigen::MatrixXd lever_responses(const DriveCampaign& campaign, const WindowModel& model,
                                std::span<const double> null_x, std::size_t threads) {
  const Hypothesis probe(campaign, levers());
  std::vector<double> x = probe.neutral();
  std::copy_n(null_x.begin(), probe.nuisance_count(), x.begin());
  Eigen::MatrixXd responses = probe.scaled_jacobian(model, x, threads).rightCols(kLevers);
  const double degree = rad_from_deg(1.0);
  const std::array<double, kLevers> units{degree, degree, kProbe_m, kProbe_m, degree};
  for (int k = 0; k < kLevers; ++k) responses.col(k) /= units[static_cast<std::size_t>(k)];
  return responses;
}

DiscrepancyTerm make_discrepancy_term(const DriveCampaign& campaign, const WindowModel& model,
                                      const FittedExplanation& fit, std::size_t threads) {
  const Hypothesis probe(campaign, levers());
  std::vector<double> x(fit.x.begin(), fit.x.begin() + static_cast<std::ptrdiff_t>(probe.nuisance_count()));
  const std::vector<double> neutral = probe.neutral();
  x.insert(x.end(), neutral.begin() + static_cast<std::ptrdiff_t>(x.size()), neutral.end());
  const Eigen::MatrixXd jacobian = probe.scaled_jacobian(model, x, threads);
  const std::vector<double> expected = probe.predict(model, x, threads);
  const auto rows = static_cast<Eigen::Index>(model.observation_count());
  const auto nuisances = static_cast<Eigen::Index>(probe.nuisance_count());

  std::vector<std::string> entries;
  std::vector<Eigen::VectorXd> responses;
  const auto add = [&](std::string name, Eigen::VectorXd response) {
    entries.push_back(std::move(name));
    responses.push_back(std::move(response));
  };
  for (std::size_t k = 0; k < kLeverEntries.size(); ++k)
    add(std::string(kLeverEntries[k]), jacobian.col(nuisances + static_cast<Eigen::Index>(k)));
  Eigen::VectorXd stiffness = Eigen::VectorXd::Zero(rows);
  for (Eigen::Index p = 0; p < nuisances; ++p)
    if (probe.parameters()[static_cast<std::size_t>(p)].name.starts_with("stiffness"))
      stiffness += jacobian.col(p);
  add("pressure_sinkage", std::move(stiffness));
  // Sensors.
  const auto sensor = [&](std::string_view name, const auto& value) {
    Eigen::VectorXd response = Eigen::VectorXd::Zero(rows);
    Eigen::Index i = 0;
    for (const DriveWindow& window : model.windows())
      for (const Observation& o : window.observations) {
        const double f = expected[static_cast<std::size_t>(i)];
        response[i++] = value(o, std::isfinite(f) ? f : 0.0);
      }
    add(std::string(name), std::move(response));
  };
  const std::span<const ChannelRow> channels = channel_catalogue();
  for (std::size_t c = 0; c < channels.size(); ++c)
    sensor(channels[c].sensor_entry, [&, c](const Observation& o, double f) {
      return o.channel == static_cast<Channel>(c) ? channels[c].sensor_error(f) : 0.0;
    });
  const auto shared_entries = entries.size();
  for (std::size_t c = 0; c < channels.size(); ++c)
    for (std::size_t k = 0; channels[c].sensor_error_by_wheel && k < campaign.rover->wheels.size(); ++k)
      sensor(fmt::format("{}_{}", channels[c].sensor_entry, campaign.rover->wheels[k].name),
             [&, c, k](const Observation& o, double f) {
               return o.channel == static_cast<Channel>(c) && o.wheel == static_cast<int>(k)
                          ? channels[c].sensor_error(f)
                          : 0.0;
             });

  const std::vector<std::vector<Circumstance>> variables = circumstances(model, expected);
  DiscrepancyTerm discrepancy;
  std::vector<Eigen::VectorXd> columns;
  for (std::size_t e = 0; e < entries.size() && !variables.empty(); ++e) {
    const std::size_t used = e < shared_entries ? variables.front().size() : 1;
    for (std::size_t v = 0; v < used; ++v) {
      if (!may_depend(entries[e], variables.front()[v].name)) continue;
      Eigen::VectorXd column = responses[e];
      for (std::size_t w = 0; w < variables.size(); ++w)
        column.segment(static_cast<Eigen::Index>(model.offset(w)),
                       static_cast<Eigen::Index>(model.windows()[w].observations.size())) *=
            variables[w][v].value;
      if (column.squaredNorm() == 0.0) continue;
      columns.push_back(std::move(column));
      discrepancy.columns.push_back({entries[e], std::string(variables.front()[v].name)});
    }
  }
  discrepancy.values.resize(rows, static_cast<Eigen::Index>(columns.size()));
  for (std::size_t c = 0; c < columns.size(); ++c)
    discrepancy.values.col(static_cast<Eigen::Index>(c)) = columns[c];
  return discrepancy;
}

Eigen::MatrixXd whitened(const FittedExplanation& fit, const NoiseModel& noise,
                         const DiscrepancyTerm& discrepancy) {
  return fit.row_weights.asDiagonal() * noise.whiten(discrepancy.values);
}

Eigen::MatrixXd form_columns(const DriveCampaign& campaign, const WindowModel& model, const NoiseModel& noise,
                             const FittedExplanation& fit, std::size_t threads) {
  const std::vector<double> with = fit.hypothesis.predict(model, fit.x, threads);
  const std::vector<std::vector<Circumstance>> variables = circumstances(model, with);
  const std::vector<int> axle_of = axles(*campaign.rover);
  std::vector<Eigen::VectorXd> columns;
  for (const EffectVariant& effect : fit.hypothesis.effects()) {
    if (!sim::find_effect(effect.effect)->has_many_forms) continue;
    const Eigen::VectorXd trace = kFormImprecision * effect_trace(fit, model, effect.effect, threads);
    const auto add = [&](const auto& share) {
      Eigen::VectorXd column = trace;
      Eigen::Index i = 0;
      for (std::size_t w = 0; w < model.windows().size(); ++w)
        for (const Observation& o : model.windows()[w].observations) column[i++] *= share(w, o);
      if (column.squaredNorm() > 0.0) columns.push_back(std::move(column));
    };
    for (std::size_t v = 0; !variables.empty() && v < variables.front().size(); ++v)
      if (std::find(kFormVariables.begin(), kFormVariables.end(), variables.front()[v].name) !=
          kFormVariables.end())
        add([&](std::size_t w, const Observation&) { return variables[w][v].value; });
    for (std::size_t c = 0; c < channel_count(); ++c)
      add([&](std::size_t, const Observation& o) {
        return o.channel == static_cast<Channel>(c) ? 1.0 : 0.0;
      });
    for (int a = 0; a <= *std::max_element(axle_of.begin(), axle_of.end()); ++a)
      add([&](std::size_t, const Observation& o) {
        return o.wheel >= 0 && axle_of[static_cast<std::size_t>(o.wheel)] == a ? 1.0 : 0.0;
      });
  }
  Eigen::MatrixXd values(static_cast<Eigen::Index>(with.size()), static_cast<Eigen::Index>(columns.size()));
  for (std::size_t c = 0; c < columns.size(); ++c) values.col(static_cast<Eigen::Index>(c)) = columns[c];
  return fit.row_weights.asDiagonal() * noise.whiten(values);
}

DiscrepancyGain discrepancy_gain(const FittedExplanation& fit, const NoiseModel& noise,
                                 const DiscrepancyTerm& discrepancy, const Eigen::MatrixXd& form) {
  const Eigen::MatrixXd white = whitened(fit, noise, discrepancy);
  const double without = log_marginal(fit.white_linear, fit.white_jacobian);
  std::vector<double> imprecise, other;
  for_sizes(fit, white, form, [&](bool something_else, const Eigen::MatrixXd& columns) {
    if (noise.cancelled()) return false;
    (something_else ? other : imprecise).push_back(log_marginal(fit.white_linear, columns));
    return true;
  });
  if (noise.cancelled()) return {};
  return {log_mean_exp(imprecise) - without, log_mean_exp(other) - without};
}

Eigen::MatrixXd columns_beside(const FittedExplanation& fit, const NoiseModel& noise,
                               const DiscrepancyTerm& discrepancy, const Eigen::MatrixXd& form,
                               bool something_else) {
  Eigen::MatrixXd best = fit.white_jacobian;
  double most = -std::numeric_limits<double>::infinity();
  for_sizes(fit, whitened(fit, noise, discrepancy), form, [&](bool else_too, const Eigen::MatrixXd& columns) {
    if (noise.cancelled()) return false;
    if (else_too != something_else) return true;
    if (const double value = log_marginal(fit.white_linear, columns); value > most) {
      most = value;
      best = columns;
    }
    return true;
  });
  return best;
}

DiscrepancyEstimate estimate_discrepancy(const FittedExplanation& fit, const NoiseModel& noise,
                                         const DiscrepancyTerm& discrepancy) {
  const Eigen::MatrixXd white = whitened(fit, noise, discrepancy);
  double best = -std::numeric_limits<double>::infinity();
  double size = kSizes[0];
  for (const double s : kSizes) {
    if (noise.cancelled()) break;
    const double value = log_marginal(fit.white_linear, both(fit.white_jacobian, white, s));
    if (value > best) {
      best = value;
      size = s;
    }
  }
  const Eigen::MatrixXd columns = both(fit.white_jacobian, white, size);
  Eigen::MatrixXd hessian = columns.transpose() * columns;
  hessian.diagonal().array() += 1.0;
  const Eigen::LLT<Eigen::MatrixXd> factor(hessian);
  const Eigen::VectorXd all = factor.solve(columns.transpose() * fit.white_linear);
  const Eigen::MatrixXd covariance = factor.solve(Eigen::MatrixXd::Identity(columns.cols(), columns.cols()));
  return {size * all.tail(white.cols()), size * covariance.diagonal().tail(white.cols()).cwiseSqrt()};
}

}  // namespace slipway::gap
