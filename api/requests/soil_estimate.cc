#include "api/requests/soil_estimate.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "api/files/soil_file.h"
#include "api/json/faults.h"
#include "api/json/writer.h"
#include "api/requests/soil_test_rigs.h"
#include "core/angle.h"
#include "core/digest.h"

namespace slipway::api {
namespace {

constexpr std::size_t kMaxName = 40, kMaxText = 480;
constexpr double kMaxForwardSlipAngle_deg = 85.0;

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

// The estimated soil gets a name of its own for its numbers, "dry_sand-3f9a2c". Its summary states what the
// data do not determine, since the soil may be used for planning without the rest of the estimate.
void name_posterior(sim::SoilDistribution& soil, const std::vector<gap::EstimatedParameter>& parameters,
                    const std::string& label, const std::string& nominal, const std::string& what) {
  std::vector<std::string_view> open;
  for (const gap::EstimatedParameter& p : parameters)
    if (p.determination != gap::Determination::kDetermined && p.parameter.is_of_soil() &&
        (p.parameter.of.empty() || p.parameter.of == label))
      open.push_back(p.parameter.name);
  json::Writer w;
  json::write_soil(w, soil);
  const std::string version = fmt::format("{:016x}", fnv1a(w.take())).substr(0, 6);
  soil.summary = shortened(fmt::format("{} as {} show it{}{}", nominal, what,
                                       open.empty() ? "" : "; not determined: ", fmt::join(open, ", ")),
                           kMaxText);
  soil.source = shortened(
      fmt::format("estimated by slipway estimate from {}, starting from {}", what, nominal), kMaxText);
  soil.name = fmt::format("{}-{}", file_name_of(label.empty() ? nominal : label), version);
}

// The soil that the search of a labelled soil starts from.
std::string start_of(const SoilEstimateRequest& request, const std::string& label) {
  for (const TestedSoil& soil : request.soils)
    if (soil.name == label) return soil.soil;
  return request.soil;
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
  check("radius_m", request.wheel.radius_m, 0.01, 2.0, "m", faults);
  check("width_m", request.wheel.width_m, 0.005, 2.0, "m", faults);
  check("gravity_m_s2", request.gravity_m_s2, 0.1, 30.0, "m/s^2", faults);
  check("speed_m_s", request.speed_m_s, 1e-4, 5.0, "m/s", faults);
  for (std::size_t i = 0; i < request.wheels.size(); ++i) {
    check(fmt::format("wheels/{}/radius_m", i), request.wheels[i].wheel.radius_m, 0.01, 2.0, "m", faults);
    check(fmt::format("wheels/{}/width_m", i), request.wheels[i].wheel.width_m, 0.005, 2.0, "m", faults);
  }
  for (std::size_t i = 0; i < request.data.wheels.size(); ++i)
    if (const sim::WheelRigConditions& test = request.data.wheels[i].test;
        test.slip_definition == sim::SlipDefinition::kForward &&
        std::abs(test.slip_angle_rad) > rad_from_deg(kMaxForwardSlipAngle_deg))
      faults.push_back(
          {fmt::format("/wheel_tests/{}/slip_angle_deg", i),
           fmt::format("slip_angle_deg = {:g} deg, must be in [-{:g}, {:g}] where slip is by the "
                       "forward speed",
                       deg_from_rad(test.slip_angle_rad), kMaxForwardSlipAngle_deg,
                       kMaxForwardSlipAngle_deg)});
  (void)soil_test_rigs(catalogue, request, faults);
  return faults;
}

Result<SoilEstimateAnswer> estimate_soil(const Catalogue& catalogue, const SoilEstimateRequest& request,
                                         Progress& progress) {
  std::vector<Fault> faults = faults_of(catalogue, request);
  if (!faults.empty()) return fail(ErrorCode::kInvalidRequest, summary_of(faults), faults);
  const SoilTestRigs rigs = soil_test_rigs(catalogue, request, faults);
  gap::SoilEstimationOptions options = request.options;
  options.stated = rigs.stated;
  auto estimate = gap::estimate_soils(rigs.nominals, rigs.data, options, progress);
  if (!estimate) return fail(estimate.error());
  const std::string words = tests_words(request.data);
  for (std::size_t s = 0; s < rigs.nominals.size(); ++s)
    name_posterior(s == 0 ? estimate->soil : estimate->further_soils[s - 1], estimate->parameters,
                   rigs.data.soil_label(s), start_of(request, rigs.data.soil_label(s)), words);
  return SoilEstimateAnswer{request, request.soil, {std::move(*estimate)}, {}, 0};
}

Result<SoilEstimateAnswer> estimate_soil(const gap::DriveCampaign& campaign,
                                         const SoilEstimateRequest& request, std::size_t threads,
                                         Progress& progress) {
  auto estimated = gap::estimate_soils_of_drives(campaign, request.looked_at, threads, progress);
  if (!estimated) return fail(estimated.error());
  SoilEstimateAnswer answer{request, campaign.name, std::move(estimated->soils),
                            std::move(estimated->channels), estimated->windows};
  for (std::size_t s = 0; s < answer.estimates.size(); ++s)
    name_posterior(answer.estimates[s].soil, answer.estimates[s].parameters, "", campaign.soils[s].name,
                   fmt::format("the drives of campaign {}", campaign.name));
  return answer;
}

}  // namespace slipway::api
