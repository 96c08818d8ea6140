#include "gap/diagnosis/model/window_model.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/angle.h"
#include "core/parallel_for.h"
#include "gap/diagnosis/model/station_prediction.h"
#include "sim/effects/effect_catalogue.h"

namespace slipway::gap {
namespace {

// Stations whose attitudes and soils are no further apart than this are one.
constexpr double kSameAttitude_rad = rad_from_deg(0.02);

// Where no attitude was recorded and the map is steeper than this, the map shows a tree or a wall and not
// what was driven on.
constexpr double kMaxTilt_rad = rad_from_deg(35.0);

// Every channel's numbers, those of wheels one a wheel: at a station, or means over a window's stations.
class ChannelValues {
 public:
  explicit ChannelValues(std::size_t wheels) {
    for (const ChannelRow& row : channel_catalogue()) values_.emplace_back(row.per_wheel ? wheels : 1, 0.0);
  }
  // Of a station, in which the rover moves or does not.
  void predict(const StationPrediction& at) {
    const std::span<const ChannelRow> rows = channel_catalogue();
    for (std::size_t c = 0; c < rows.size(); ++c)
      for (std::size_t k = 0; k < values_[c].size(); ++k)
        values_[c][k] = at.state != nullptr || rows[c].predicted_when_stuck ? rows[c].predict(at, k) : 0.0;
  }
  void add(double share, const ChannelValues& other) {
    for (std::size_t c = 0; c < values_.size(); ++c)
      for (std::size_t k = 0; k < values_[c].size(); ++k) values_[c][k] += share * other.values_[c][k];
  }
  // Of a wheel's channel without a wheel: the mean of all.
  double of(const Observation& o) const {
    const std::vector<double>& all = values_[static_cast<std::size_t>(o.channel)];
    if (o.wheel >= 0) return all[static_cast<std::size_t>(o.wheel)];
    return std::accumulate(all.begin(), all.end(), 0.0) / static_cast<double>(all.size());
  }

 private:
  std::vector<std::vector<double>> values_;
};

bool same_shape_as(const sim::RoverModel& a, const sim::RoverModel& b) {
  for (std::size_t k = 0; k < a.wheels.size(); ++k)
    if (a.wheels[k].radius_m != b.wheels[k].radius_m || a.wheels[k].position_m != b.wheels[k].position_m)
      return false;
  return true;
}

bool stand_alike(const ModelState& a, const ModelState& b) {
  return same_shape_as(a.rover, b.rover) && a.heading_error == b.heading_error;
}

// No motor stalled in drives that were made, whatever re-tuned constants imply of voltages.
bool gets_on(const sim::StationState& at) {
  return at.moving() || at.outcome == sim::Outcome::kStalled;
}

// What acts from outside at a station.
void set_outside(sim::QuasiStaticSolver& solver, const ModelState& state, const sim::Stance& stance,
                 const sim::DriveCommand& command) {
  if (state.outside.any()) solver.set_outside(wrench_of(state.outside, state.rover, stance, command));
}

bool attitude_recorded(const DriveWindow& window) {
  return std::any_of(window.observations.begin(), window.observations.end(), [](const Observation& o) {
    return o.channel == Channel::kRoll || o.channel == Channel::kPitch;
  });
}

}  // namespace

WindowModel::WindowModel(const DriveCampaign& campaign, std::span<const DriveWindow> windows, Footing footing)
    : campaign_(campaign),
      windows_(windows),
      footing_(footing),
      stances_(windows.size()),
      starts_(windows.size()),
      conditions_(windows.size()) {
  offsets_.push_back(0);
  for (std::size_t w = 0; w < windows.size(); ++w) {
    offsets_.push_back(offsets_.back() + windows[w].observations.size());
    std::vector<Place> places = places_of(*campaign.rover, {}, w);
    if (places.empty()) continue;
    const sim::DriveCommand& command = windows[w].command;
    const double sense = command.speed_m_s < 0.0 && !command.turn_in_place ? -1.0 : 1.0;
    Conditions& at = conditions_[w];
    for (const Place& place : places) {
      at.pitch_rad -= sense * place.stance.attitude.pitch_rad / static_cast<double>(places.size());
      at.roll_rad += place.stance.attitude.roll_rad / static_cast<double>(places.size());
    }
    at.soil = places[places.size() / 2].soil[0];
    at.turning = command.turn_in_place;
    stances_[w] = std::move(places);
  }
  constexpr double kLeastExtent_m = 0.1;
  Eigen::AlignedBox2d extent;
  for (const std::vector<Place>& places : stances_)
    for (const Place& place : places) extent.extend(Eigen::Vector2d(place.stance.p_MB.head<2>()));
  if (extent.isEmpty()) return;
  middle_m_ = extent.center();
  half_extent_m_ = (0.5 * extent.sizes()).cwiseMax(kLeastExtent_m);
}

double WindowModel::attitude_scatter_rad(std::span<const double> predicted) const {
  double squares = 0.0, all = 0.0;
  for (const Channel channel : {Channel::kRoll, Channel::kPitch}) {
    double sum = 0.0, sum_of_squares = 0.0, count = 0.0;
    for (std::size_t w = 0; w < windows_.size(); ++w) {
      for (std::size_t i = 0; used(w) && i < windows_[w].observations.size(); ++i) {
        const Observation& o = windows_[w].observations[i];
        if (o.channel != channel) continue;
        const double difference = o.value - predicted[offsets_[w] + i];
        sum += difference;
        sum_of_squares += difference * difference;
        count += 1.0;
      }
    }
    if (count > 0.0) squares += std::max(0.0, sum_of_squares - sum * sum / count);
    all += count;
  }
  return std::sqrt(squares / all);
}

double WindowModel::attitude_misfit_rad() const {
  double squares = 0.0;
  std::size_t count = 0;
  for (std::size_t w = 0; w < windows_.size(); ++w) {
    if (!used(w)) continue;
    double roll = 0.0, pitch = 0.0;
    for (const Place& place : stances_[w]) {
      roll += place.stance.attitude.roll_rad / static_cast<double>(stances_[w].size());
      pitch += place.stance.attitude.pitch_rad / static_cast<double>(stances_[w].size());
    }
    for (const Observation& o : windows_[w].observations) {
      if (o.channel != Channel::kRoll && o.channel != Channel::kPitch) continue;
      const double difference = o.value - (o.channel == Channel::kRoll ? roll : pitch);
      squares += difference * difference;
      ++count;
    }
  }
  return std::sqrt(squares / static_cast<double>(count));
}

std::optional<WindowModel::Place> WindowModel::place_at(const sim::RoverModel& rover, std::size_t window,
                                                        const Pose2& pose) const {
  const sim::Ground& ground = *campaign_.terrains[campaign_.drives[windows_[window].drive].terrain].ground;
  const auto stance = footing_ == Footing::kPlane ? sim::lay_on_fitted_plane(rover, ground, pose)
                                                  : sim::settle(rover, ground, pose);
  if (!stance) return std::nullopt;
  Place place{*stance, sim::PerWheel<std::size_t>(rover.wheels.size())};
  for (std::size_t k = 0; k < rover.wheels.size(); ++k) {
    const Eigen::Vector3d p = stance->p_MB + stance->R_MB * stance->p_B_wheel[k];
    const auto soil = ground.soil_at(p.x(), p.y());
    if (!soil) return std::nullopt;
    place.soil[k] = *soil;
  }
  return place;
}

std::vector<WindowModel::Place> WindowModel::places_of(const sim::RoverModel& rover,
                                                       const HeadingError& heading_error,
                                                       std::size_t window) const {
  std::vector<Place> places;
  for (Pose2 pose : windows_[window].stations) {
    pose.yaw_rad -= heading_error.off_rad(pose.yaw_rad - windows_[window].first_yaw_rad);
    std::optional<Place> place = place_at(rover, window, pose);
    if (!place) return {};
    places.push_back(*std::move(place));
  }
  if (footing_ != Footing::kPlane || attitude_recorded(windows_[window])) return places;
  Place mean = places[places.size() / 2];
  Attitude attitude{.yaw_rad = mean.stance.attitude.yaw_rad};
  for (const Place& place : places) {
    attitude.roll_rad += place.stance.attitude.roll_rad / static_cast<double>(places.size());
    attitude.pitch_rad += place.stance.attitude.pitch_rad / static_cast<double>(places.size());
  }
  if (attitude.tilt_rad() > kMaxTilt_rad) return {};
  const Eigen::Vector3d p_MB = mean.stance.p_MB;
  mean.stance = sim::stance_on_plane(rover, attitude);
  mean.stance.p_MB = p_MB;
  return {mean};
}

SoilPlace WindowModel::soil_place(std::size_t w, const Place& place) const {
  const auto from_middle = [](double value, double lowest, double highest) {
    return highest > lowest ? 2.0 * (value - lowest) / (highest - lowest) - 1.0 : 0.0;
  };
  const DriveWindow& window = windows_[w];
  const std::vector<DriveSample>& rows = campaign_.drives[window.drive].samples;
  const double last = static_cast<double>(campaign_.drives.size()) - 1.0;
  return {last > 0.0 ? from_middle(static_cast<double>(window.drive), 0.0, last) : -1.0,
          from_middle(window.mid_s(), rows.front().time_s, rows.back().time_s),
          (place.stance.p_MB.head<2>() - middle_m_).cwiseQuotient(half_extent_m_)};
}

sim::PerWheel<sim::Soil> WindowModel::soils_at(std::size_t w, const Place& place,
                                               const ModelState& state) const {
  const std::vector<sim::Disc> regions = sim::effect_regions(state.effects);
  const double strength = state.soil_drift.any() ? state.soil_drift.factor(soil_place(w, place)) : 1.0;
  sim::PerWheel<sim::Soil> soils(place.soil.size());
  for (std::size_t k = 0; k < soils.size(); ++k) {
    soils[k] = state.soils[place.soil[k]];
    if (strength != 1.0) strengthen(soils[k], strength);
    if (regions.empty()) continue;
    const Eigen::Vector3d p = place.stance.p_MB + place.stance.R_MB * place.stance.p_B_wheel[k];
    for (std::size_t r = 0; r < regions.size(); ++r)
      if (regions[r].holds(p.x(), p.y())) sim::apply_in_region(state.effects, r, soils[k]);
  }
  return soils;
}

std::span<const WindowModel::Place> WindowModel::places_in(std::size_t w, const ModelState& state,
                                                           std::vector<Place>& own) const {
  if (!stands_as_nominal(state)) own = places_of(state.rover, state.heading_error, w);
  return own.empty() ? stances_[w] : own;
}

void WindowModel::predict_window(std::size_t w, const ModelState& state, std::span<const Place> places,
                                 const From& from, sim::QuasiStaticSolver& solver,
                                 std::span<double> out) const {
  const DriveWindow& window = windows_[w];
  const std::size_t wheels = state.rover.wheels.size();
  const bool regions = !sim::effect_regions(state.effects).empty();
  ChannelValues mean(wheels), last(wheels);
  bool moving = true;
  const double share = 1.0 / static_cast<double>(places.size());
  const Place* before = nullptr;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const Place& place = places[i];
    const bool as_before =
        before != nullptr && !regions && state.outside.on_map_n.isZero(0.0) &&
        before->soil.size() == place.soil.size() &&
        std::equal(before->soil.begin(), before->soil.end(), place.soil.begin()) &&
        std::abs(before->stance.attitude.pitch_rad - place.stance.attitude.pitch_rad) < kSameAttitude_rad &&
        std::abs(before->stance.attitude.roll_rad - place.stance.attitude.roll_rad) < kSameAttitude_rad &&
        std::abs(before->stance.rocker_rad - place.stance.rocker_rad) < kSameAttitude_rad &&
        std::abs(before->stance.bogie_rad[0] - place.stance.bogie_rad[0]) < kSameAttitude_rad &&
        std::abs(before->stance.bogie_rad[1] - place.stance.bogie_rad[1]) < kSameAttitude_rad;
    if (!as_before) {
      const StationStart* start = from.starts.empty() ? nullptr : &from.starts[i];
      const sim::QuasiStaticSolver::Start* const balance =
          start != nullptr && start->balance ? &*start->balance : nullptr;
      const auto thoroughness =
          start == nullptr || start->moving ? sim::Thoroughness::kSure : sim::Thoroughness::kQuick;
      const bool stuck = from.near && start != nullptr && !start->moving;
      sim::StationState at;
      if (!stuck && !from.geometries.empty()) {
        at = solver.solve(from.geometries[i], soils_at(w, place, state), balance, thoroughness);
      } else if (!stuck) {
        set_outside(solver, state, place.stance, window.command);
        at = solver.solve(place.stance, soils_at(w, place, state), window.command, balance, thoroughness);
      }
      const bool moves = !stuck && gets_on(at);
      if (!moves) {
        moving = false;
        solver.reset();
      }
      last.predict({moves ? &at : nullptr, place.stance, window.command, state.rover, state.track_left_out,
                    footing_ == Footing::kSuspension});
    }
    before = &place;
    mean.add(share, last);
  }
  for (std::size_t i = 0; i < window.observations.size(); ++i) {
    const Observation& o = window.observations[i];
    out[i] = moving || row_of(o.channel).predicted_when_stuck ? mean.of(o) : kNotMeasured;
  }
}

std::vector<WindowModel::StationStart> WindowModel::starts_of(std::size_t w, const ModelState& state,
                                                              std::span<const Place> places) const {
  sim::QuasiStaticSolver solver(state.rover, campaign_.gravity_m_s2);
  std::vector<StationStart> starts(places.size());
  for (std::size_t i = 0; i < places.size() && !cancelled(); ++i) {
    const sim::PerWheel<sim::Soil> soils = soils_at(w, places[i], state);
    set_outside(solver, state, places[i].stance, windows_[w].command);
    const bool known = !starts_[w].empty() && starts_[w][i].balance;
    starts[i].moving = gets_on(solver.solve(places[i].stance, soils, windows_[w].command,
                                            known ? &*starts_[w][i].balance : nullptr));
    starts[i].balance = solver.start_of_last(places[i].stance, soils, windows_[w].command);
    if (!starts[i].moving) solver.reset();
  }
  return starts;
}

std::vector<sim::BalanceGeometry> WindowModel::geometries_of(std::size_t w, const ModelState& state,
                                                             std::span<const Place> places) const {
  const sim::DriveCommand& command = windows_[w].command;
  std::vector<sim::BalanceGeometry> geometries;
  for (const Place& place : places) {
    geometries.emplace_back(state.rover, campaign_.gravity_m_s2, place.stance, command);
    if (state.outside.any())
      geometries.back().add(wrench_of(state.outside, state.rover, place.stance, command));
  }
  return geometries;
}

bool WindowModel::stands_as_nominal(const ModelState& state) const {
  return same_shape_as(state.rover, *campaign_.rover) && !state.heading_error.any();
}

void WindowModel::start_from(const ModelState& state, std::size_t threads) {
  std::vector<std::vector<StationStart>> starts(windows_.size());
  parallel_for(windows_.size(), threads, [&](std::size_t w) {
    std::vector<Place> own;
    starts[w] = starts_of(w, state, places_in(w, state, own));
  });
  starts_ = std::move(starts);
}

std::vector<std::size_t> WindowModel::first_windows() const {
  std::vector<std::size_t> first;
  for (std::size_t w = 0; w < windows_.size(); ++w)
    if (w == 0 || windows_[w].drive != windows_[w - 1].drive) first.push_back(w);
  first.push_back(windows_.size());
  return first;
}

// A drive's windows follow each other on one thread, each drive with a solver of its own: numbers do not
// depend on how drives are spread.
std::vector<double> WindowModel::predict(const ModelState& state, std::size_t threads) const {
  std::vector<double> out(observation_count(), kNotMeasured);
  const std::vector<std::size_t> first = first_windows();
  parallel_for(first.size() - 1, threads, [&](std::size_t d) {
    sim::QuasiStaticSolver solver(state.rover, campaign_.gravity_m_s2);
    for (std::size_t w = first[d]; w < first[d + 1]; ++w) {
      if (cancelled()) return;
      if (!used(w)) continue;
      std::vector<Place> own;
      predict_window(w, state, places_in(w, state, own), {starts_[w]}, solver,
                     std::span(out).subspan(offsets_[w], windows_[w].observations.size()));
    }
  });
  return out;
}

std::vector<std::vector<double>> WindowModel::predict_near(const ModelState& centre,
                                                           std::span<const NearState> near,
                                                           std::size_t threads) const {
  std::vector<std::vector<double>> out(near.size(), std::vector<double>(observation_count(), kNotMeasured));
  std::vector<bool> as_centre;
  for (const NearState& n : near) as_centre.push_back(stand_alike(n.state, centre));
  const std::vector<std::size_t> first = first_windows();
  parallel_for(first.size() - 1, threads, [&](std::size_t d) {
    std::vector<sim::QuasiStaticSolver> solvers;
    for (const NearState& n : near) solvers.emplace_back(n.state.rover, campaign_.gravity_m_s2);
    for (std::size_t w = first[d]; w < first[d + 1]; ++w) {
      if (cancelled()) return;
      if (!used(w)) continue;
      std::vector<Place> own_centre;
      const std::span<const Place> places = places_in(w, centre, own_centre);
      const std::vector<StationStart> starts = starts_of(w, centre, places);
      const std::vector<sim::BalanceGeometry> geometries = geometries_of(w, centre, places);
      for (std::size_t n = 0; n < near.size(); ++n) {
        const ModelState& state = near[n].state;
        const std::span<double> values =
            std::span(out[n]).subspan(offsets_[w], windows_[w].observations.size());
        std::vector<Place> own;
        const From from{starts, true,
                        near[n].same_rover ? geometries : std::span<const sim::BalanceGeometry>{}};
        const std::span<const Place> at = as_centre[n] ? places : places_in(w, state, own);
        predict_window(w, state, at, from, solvers[n], values);
      }
    }
  });
  return out;
}

}  // namespace slipway::gap
