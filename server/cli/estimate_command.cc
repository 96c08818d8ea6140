#include "server/cli/estimate_command.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <filesystem>
#include <optional>
#include <string_view>
#include <vector>

#include "api/documents/soil_estimate_document.h"
#include "api/files/campaign/drive_campaign_source.h"
#include "api/files/soil_file.h"
#include "api/files/soil_tests_csv.h"
#include "api/files/terrain_site.h"
#include "api/json/faults.h"
#include "api/report/soil_estimate_chart.h"
#include "api/requests/soil_estimate.h"
#include "core/angle.h"
#include "server/cli/command_parts.h"
#include "server/cli/terminal/terminal_progress.h"
#include "server/cli/terminal/text_table.h"

namespace slipway::server {
namespace {

using gap::EstimatedParameter;
using From = EstimateCommand::From;

std::optional<double> number(std::string_view text) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

std::vector<std::string> parameter_names() {
  std::vector<std::string> names;
  for (const gap::SoilParameterRow& row : gap::soil_parameter_rows()) names.emplace_back(row.name);
  return names;
}

// "n=0.5:1.5", at the boundary's units.
std::optional<gap::SoilBound> bound_of(std::string_view text) {
  const std::size_t equals = text.find('='), colon = text.find(':');
  if (equals == std::string_view::npos || colon == std::string_view::npos || colon < equals)
    return std::nullopt;
  const auto parameter = gap::soil_parameter(text.substr(0, equals));
  const auto lowest = number(text.substr(equals + 1, colon - equals - 1)),
             highest = number(text.substr(colon + 1));
  if (!parameter || !lowest || !highest) return std::nullopt;
  const double unit = gap::row_of(*parameter).boundary_unit;
  return gap::SoilBound{*parameter, *lowest / unit, *highest / unit};
}

void read_free(const EstimateCommand& options, gap::SoilEstimationOptions& estimation,
               std::vector<Fault>& faults) {
  using gap::SoilParameter;
  for (std::size_t i = 0; i < options.free.size(); ++i) {
    const auto parameter = gap::soil_parameter(options.free[i]);
    if (!parameter)
      faults.push_back(
          {fmt::format("/free/{}", i), api::unknown_name("parameter", options.free[i], parameter_names())});
    else if (options.merge_stiffness &&
             (*parameter == SoilParameter::kKc || *parameter == SoilParameter::kKphi)) {
      if (estimation.free.empty() || estimation.free.front() != SoilParameter::kBekker)
        estimation.free.insert(estimation.free.begin(), SoilParameter::kBekker);
    } else {
      estimation.free.push_back(*parameter);
    }
  }
  if (options.merge_stiffness && options.free.empty()) {
    estimation.free = {SoilParameter::kBekker, SoilParameter::kN};
    if (options.from == From::kWheel)
      estimation.free.insert(estimation.free.end(), {SoilParameter::kCohesion, SoilParameter::kFrictionAngle,
                                                     SoilParameter::kShearModulus});
  }
}

// "0.01,24".
std::optional<sim::Grousers> grousers_of(const std::string& text) {
  const std::size_t comma = text.find(',');
  if (comma == std::string::npos) return std::nullopt;
  const auto height = number(std::string_view(text).substr(0, comma)),
             count = number(std::string_view(text).substr(comma + 1));
  if (!height || !count || !(*height >= 0.0 && *height <= 0.2) || !(*count >= 0.0 && *count <= 200.0))
    return std::nullopt;
  return sim::Grousers{*height, *count};
}

Result<api::SoilEstimateRequest> request_of(const EstimateCommand& options) {
  api::SoilEstimateRequest request;
  request.soil = options.soil;
  request.wheel = {options.rover, options.wheel, options.radius_m, options.width_m, {}, options.motor_temp_c};
  request.gravity_m_s2 = options.gravity_m_s2;
  request.speed_m_s = options.speed_m_s;
  if (options.from == From::kDrives) request.campaign = options.file;
  std::vector<Fault> faults = api::choose_channels(options.channels, request);
  gap::SoilEstimationOptions& estimation = request.options;
  read_free(options, estimation, faults);
  for (const std::string& text : options.bounds) {
    if (const auto bound = bound_of(text))
      estimation.bounds.push_back(*bound);
    else
      faults.push_back(
          {"/bound", fmt::format("{} is no bound NAME=lowest:highest of a parameter", api::in_quotes(text))});
  }
  if (!options.grousers.empty()) {
    request.wheel.grousers = grousers_of(options.grousers);
    if (!request.wheel.grousers)
      faults.push_back({"/grousers", fmt::format("{} is not height in m and count, as 0.01,24 is",
                                                 api::in_quotes(options.grousers))});
  }
  if (options.loss_scale && options.loss == "none")
    faults.push_back(
        {"/loss-scale", "loss-scale says where outliers begin, which without a --loss are none"});
  estimation.priors = gap::soil_priors(options.priors).value_or(gap::SoilPriors::kWide);
  for (std::size_t i = 0; i < gap::robust_loss_names().size(); ++i)
    if (gap::robust_loss_names()[i] == options.loss) estimation.loss = static_cast<gap::RobustLoss>(i);
  estimation.loss_scale = options.loss_scale;
  estimation.noise.share = options.noise;
  estimation.noise.share_of_rms = 0.25 * options.noise;
  estimation.seed = options.seed;
  if (!faults.empty()) return fail(ErrorCode::kInvalidRequest, api::summary_of(faults), faults);
  return request;
}

Result<bool> read_tests(const EstimateCommand& options, api::SoilEstimateRequest& request) {
  const auto bytes = api::read_data_file(options.file);
  if (!bytes) return fail(bytes.error());
  const std::string file = std::filesystem::path(options.file).filename().string();
  if (options.from == From::kPlates) {
    auto plates = api::read_plate_tests_csv(file, *bytes);
    if (!plates) return fail(plates.error());
    request.data.plates = std::move(*plates);
    return true;
  }
  auto wheels = api::read_wheel_tests_csv(file, *bytes);
  if (!wheels) return fail(wheels.error());
  request.data.wheels = std::move(*wheels);
  for (gap::WheelObservation& observation : request.data.wheels)
    if (options.slip_definition == "travel") observation.test.slip_definition = sim::SlipDefinition::kTravel;
  return true;
}

std::string words_of(const gap::SoilEstimate& e) {
  std::string out = fmt::format("{}: {}\n\n", e.soil.name, e.soil.summary);
  TextTable table({"parameter", "start", "estimate", "std", "90 % from", "to", "determined", "unit"});
  for (const EstimatedParameter& p : e.parameters) {
    const gap::SoilParameterRow& row = gap::row_of(p.parameter);
    const auto shown = [&](double value) { return fmt::format("{:.4g}", row.boundary_unit * value); };
    table.add({std::string(row.name), shown(p.start), shown(p.value), p.std ? shown(*p.std) : "-",
               (p.low_open ? "<= " : "") + shown(p.low), (p.high_open ? ">= " : "") + shown(p.high),
               std::string(gap::name_of(p.determination)), std::string(row.unit)});
  }
  out += table.print() + "\n";
  for (const EstimatedParameter& p : e.parameters) out += "  " + p.words + "\n";
  if (!e.open.empty())
    out += "of these combinations the data say less than is known of soils of all kinds:\n";
  for (const gap::OpenDirection& open : e.open) out += fmt::format("  {}\n", open.words);
  if (!e.channels.empty()) {
    TextTable left({"channel", "readings", "rms left", "in deviations", "unit"});
    for (const gap::ChannelResidual& c : e.channels)
      left.add({std::string(gap::name_of(c.channel)), fmt::format("{}", c.count),
                fmt::format("{:.3g}", c.rms), fmt::format("{:.2f}", c.rms_deviations),
                std::string(gap::unit_of(c.channel))});
    out += "\n" + left.print();
  }
  for (const std::string& note : e.notes) out += "note: " + note + "\n";
  return out;
}

std::string answer_words(const api::SoilEstimateAnswer& answer) {
  std::string out;
  for (const gap::SoilEstimate& e : answer.estimates) out += (out.empty() ? "" : "\n") + words_of(e);
  if (answer.drive_channels.empty()) return out;
  TextTable left({"channel", "readings", "rms left", "in deviations", "unit"});
  for (const gap::DriveChannelResidual& c : answer.drive_channels)
    left.add({std::string(gap::name_of(c.channel)), fmt::format("{}", c.count),
              fmt::format("{:.3g}", gap::boundary_unit(c.channel) * c.rms),
              fmt::format("{:.2f}", c.rms_deviations), std::string(gap::unit_of(c.channel))});
  return out + fmt::format("\n{} windows\n", answer.windows) + left.print();
}

}  // namespace

int estimate(const EstimateCommand& options) {
  auto request = request_of(options);
  if (!request) return refuse(request.error());
  const auto catalogue = open_catalogue(options.ask.data);
  if (!catalogue) return refuse_unreadable(catalogue.error());
  std::optional<Result<api::SoilEstimateAnswer>> answer;
  if (options.from == From::kDrives) {
    const auto campaign = api::load_drive_campaign(options.file, *catalogue);
    if (!campaign) return refuse_unreadable(campaign.error());
    request->campaign = campaign->name;
    TerminalProgress progress;
    answer = api::estimate_soil(*campaign, *request, static_cast<std::size_t>(options.threads), progress);
  } else {
    const auto read = read_tests(options, *request);
    if (!read) return refuse_unreadable(read.error());
    TerminalProgress progress;
    answer = api::estimate_soil(*catalogue, *request, progress);
  }
  if (!*answer) return refuse(answer->error());
  std::vector<OutputFile> files;
  if (!options.soil_out.empty()) {
    const std::string soils = api::json::estimated_soils_document(**answer);
    // A soil that no wheel can stand on, of a k_c far below 0 say, is an estimate but no soil file.
    if (const auto read_back = api::json::read_soil_file(soils); !read_back) return refuse(read_back.error());
    files.push_back({options.soil_out, soils});
  }
  if (!options.plot.empty())
    files.push_back({options.plot, api::draw_soil_estimate((*answer)->estimates.front())});
  return deliver(
      files, options.ask.json ? api::json::soil_estimate_document(**answer) + "\n" : answer_words(**answer));
}

}  // namespace slipway::server
