#include "api/requests/soil_estimate.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "api/files/soil_file.h"
#include "api/json/faults.h"
#include "api/json/writer.h"
#include "campaign/digest.h"
#include "sim/effects/effect_catalogue.h"
#include "sim/rover/rover_model.h"
#include "sim/single_wheel/sweep_parameter.h"

namespace slipway::api {
namespace {

constexpr std::size_t kMaxName = 40, kMaxText = 480;

// At most so many bytes, without a character of UTF-8 that is cut in its middle.
std::string shortened(const std::string& text, std::size_t most) {
  if (text.size() <= most) return text;
  std::size_t end = most;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80) --end;
  return text.substr(0, end);
}

// What a soil file takes for a name: small letters, digits, - and _. Anything else, a whole character of
// UTF-8 at a time, becomes one _.
std::string file_name_of(const std::string& name) {
  std::string out;
  for (const char c : name) {
    const auto byte = static_cast<unsigned char>(c);
    if ((byte & 0xC0) == 0x80) continue;
    const bool plain = (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '-' || c == '_';
    const bool capital = c >= 'A' && c <= 'Z';
    out += plain ? c : capital ? static_cast<char>(c - 'A' + 'a') : '_';
  }
  return out.substr(0, kMaxName);
}

void check(std::string_view name, const std::optional<double>& value, double lowest, double highest,
           std::string_view unit, std::vector<Fault>& faults) {
  if (!value || (*value >= lowest && *value <= highest)) return;
  faults.push_back({fmt::format("/{}", name), fmt::format("{} = {:g} {}, must be in [{:g}, {:g}]", name,
                                                          *value, unit, lowest, highest)});
}

const sim::WheelModel* wheel_of(const sim::RoverModel& rover, const std::string& name,
                                std::vector<Fault>& faults) {
  std::vector<std::string> names;
  for (const sim::WheelModel& wheel : rover.wheels) {
    names.push_back(wheel.name);
    if (name.empty() || wheel.name == name) return &wheel;
  }
  faults.push_back({"/wheel", unknown_name("wheel", name, names)});
  return nullptr;
}

bool measures_current(const gap::SoilData& data) {
  return std::any_of(data.wheels.begin(), data.wheels.end(), [](const gap::WheelObservation& o) {
    return o[gap::SoilChannel::kCurrent].value.has_value();
  });
}

// The estimated soil gets a name of its own for its numbers, "dry_sand-3f9a2c". Its summary states what the
// data do not determine, since the soil may be used for planning without the rest of the estimate.
void name_posterior(gap::SoilEstimate& estimate, const std::string& nominal, const std::string& what) {
  std::vector<std::string_view> open;
  for (const gap::EstimatedParameter& p : estimate.parameters)
    if (p.determination != gap::Determination::kDetermined) open.push_back(gap::row_of(p.parameter).name);
  sim::SoilDistribution& soil = estimate.soil;
  json::Writer w;
  json::write_soil(w, soil);
  const std::string version = fmt::format("{:016x}", campaign::digest_of(w.take())).substr(0, 6);
  soil.summary = shortened(fmt::format("{} as {} show it{}{}", nominal, what,
                                       open.empty() ? "" : "; not determined: ", fmt::join(open, ", ")),
                           kMaxText);
  soil.source = shortened(
      fmt::format("estimated by slipway estimate from {}, starting from {}", what, nominal), kMaxText);
  soil.name = fmt::format("{}-{}", file_name_of(nominal), version);
}

std::string tests_words(const gap::SoilData& data) {
  if (data.wheels.empty()) return fmt::format("{} plate tests", data.plates.size());
  if (data.plates.empty()) return fmt::format("{} wheel tests", data.wheels.size());
  return fmt::format("{} wheel tests and {} plate tests", data.wheels.size(), data.plates.size());
}

}  // namespace

std::vector<Fault> choose_channels(const std::vector<std::string>& names, SoilEstimateRequest& request) {
  std::vector<Fault> faults;
  if (names.empty()) return faults;
  std::vector<std::string> known;
  const bool drives = !request.campaign.empty();
  if (drives)
    for (const gap::ChannelRow& row : gap::channel_catalogue()) known.emplace_back(row.name);
  for (int c = 0; !drives && c < gap::kSoilChannels; ++c)
    known.emplace_back(gap::name_of(static_cast<gap::SoilChannel>(c)));
  for (std::size_t i = 0; i < names.size(); ++i)
    if (std::find(known.begin(), known.end(), names[i]) == known.end())
      faults.push_back({fmt::format("/channels/{}", i), unknown_name("channel", names[i], known)});
  if (drives) request.looked_at.assign(known.size(), false);
  for (std::size_t c = 0; c < known.size(); ++c) {
    const bool chosen = std::find(names.begin(), names.end(), known[c]) != names.end();
    if (drives)
      request.looked_at[c] = chosen;
    else
      request.options.channels[c] = chosen;
  }
  return faults;
}

std::vector<Fault> faults_of(const Catalogue& catalogue, const SoilEstimateRequest& request) {
  std::vector<Fault> faults;
  if (!catalogue.soils.contains(request.soil))
    faults.push_back({"/soil", unknown_name("soil", request.soil, names_of(catalogue.soils))});
  else if (const sim::Soil& start = catalogue.soils.find(request.soil)->second.mean;
           !start.has_bekker_law() || start.shear_law.row != nullptr)
    faults.push_back(
        {"/soil", fmt::format("{} has other laws than Bekker's and Janosi and Hanamoto's, whose parameters "
                              "are what is estimated",
                              in_quotes(request.soil))});
  const TestedWheel& tested = request.wheel;
  const auto rover = catalogue.rovers.find(tested.rover);
  if (!tested.rover.empty() && rover == catalogue.rovers.end())
    faults.push_back({"/rover", unknown_name("rover", tested.rover, names_of(catalogue.rovers))});
  if (tested.rover.empty() && !tested.wheel.empty())
    faults.push_back({"/wheel", "a wheel is named of a rover, and there is none"});
  if (tested.rover.empty() && tested.motor_temp_c)
    faults.push_back({"/motor_temp_c", "a temperature needs the motor of a rover, and there is none"});
  if (rover != catalogue.rovers.end()) wheel_of(*rover->second, tested.wheel, faults);
  check("radius_m", tested.radius_m, 0.01, 2.0, "m", faults);
  check("width_m", tested.width_m, 0.005, 2.0, "m", faults);
  if (!request.data.wheels.empty() && tested.rover.empty()) {
    for (const auto& [name, value] : {std::pair{"radius_m", tested.radius_m}, {"width_m", tested.width_m}})
      if (!value)
        faults.push_back(
            {fmt::format("/{}", name), fmt::format("{} is missing, or a rover with wheels", name)});
    if (measures_current(request.data))
      faults.push_back({"/rover", "a measured current needs the motor of a rover"});
  }
  check("gravity_m_s2", request.gravity_m_s2, 0.1, 30.0, "m/s^2", faults);
  check("speed_m_s", request.speed_m_s, 1e-4, 5.0, "m/s", faults);
  return faults;
}

Result<SoilEstimateAnswer> estimate_soil(const Catalogue& catalogue, const SoilEstimateRequest& request,
                                         Progress& progress) {
  if (auto faults = faults_of(catalogue, request); !faults.empty())
    return fail(ErrorCode::kInvalidRequest, summary_of(faults), faults);
  SoilEstimateAnswer answer{request, request.soil, {}, {}, 0};
  sim::SoilDistribution nominal = catalogue.soils.find(request.soil)->second;
  TestedWheel& tested = answer.request.wheel;
  sim::WheelGeometry wheel;
  std::optional<sim::DriveMotor> drive;
  if (const auto found = catalogue.rovers.find(tested.rover); found != catalogue.rovers.end()) {
    sim::RoverModel rover = *found->second;
    // The rover's own effects act on wheel, motor and soil.
    sim::apply_effects(rover.effects, rover);
    sim::apply_effects(rover.effects, nominal.mean);
    std::vector<Fault> none;
    const sim::WheelModel& model = *wheel_of(rover, tested.wheel, none);
    tested.wheel = model.name;
    wheel = model.geometry();
    drive = rover.drive;
    if (tested.motor_temp_c) drive = sim::at_temperature(*drive, *tested.motor_temp_c);
  }
  wheel.radius_m = tested.radius_m.value_or(wheel.radius_m);
  wheel.width_m = tested.width_m.value_or(wheel.width_m);
  wheel.grousers = tested.grousers.value_or(wheel.grousers);
  if (!request.data.wheels.empty()) {
    tested.radius_m = wheel.radius_m;
    tested.width_m = wheel.width_m;
    tested.grousers = wheel.grousers;
  }
  for (gap::WheelObservation& observation : answer.request.data.wheels) {
    observation.test.wheel = wheel;
    observation.test.drive = drive;
    observation.test.gravity_m_s2 = request.gravity_m_s2;
    observation.test.speed_m_s = request.speed_m_s;
  }
  const auto estimate = gap::estimate_soil(nominal, answer.request.data, request.options, progress);
  if (!estimate) return fail(estimate.error());
  answer.estimates.push_back(*estimate);
  name_posterior(answer.estimates.front(), request.soil, tests_words(request.data));
  return answer;
}

Result<SoilEstimateAnswer> estimate_soil(const gap::DriveCampaign& campaign,
                                         const SoilEstimateRequest& request, std::size_t threads,
                                         Progress& progress) {
  auto estimated = gap::estimate_soils_of_drives(campaign, request.looked_at, threads, progress);
  if (!estimated) return fail(estimated.error());
  SoilEstimateAnswer answer{request, campaign.name, std::move(estimated->soils),
                            std::move(estimated->channels), estimated->windows};
  for (std::size_t s = 0; s < answer.estimates.size(); ++s)
    name_posterior(answer.estimates[s], campaign.soils[s].name,
                   fmt::format("the drives of campaign {}", campaign.name));
  return answer;
}

}  // namespace slipway::api
