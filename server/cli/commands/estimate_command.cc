#include "server/cli/commands/estimate_command.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "api/documents/soil/soil_estimate_document.h"
#include "api/files/campaign/drive_campaign_source.h"
#include "api/files/soil_file.h"
#include "api/files/soil_tests_csv.h"
#include "api/files/terrain_site.h"
#include "api/json/faults.h"
#include "api/report/soil_estimate_chart.h"
#include "api/requests/soil_estimate.h"
#include "core/angle.h"
#include "core/largest_exact_whole.h"
#include "server/cli/commands/belief_command.h"
#include "server/cli/inquiry/command_parts.h"
#include "server/cli/inquiry/data_folder.h"
#include "server/cli/inquiry/data_option.h"
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

// "n=0.5:1.5", at the boundary's units.
std::optional<gap::SoilBound> bound_of(std::string_view text) {
  const std::size_t equals = text.find('='), colon = text.find(':');
  if (equals == std::string_view::npos || colon == std::string_view::npos || colon < equals)
    return std::nullopt;
  const auto parameter = gap::free_parameter(text.substr(0, equals));
  const auto lowest = number(text.substr(equals + 1, colon - equals - 1)),
             highest = number(text.substr(colon + 1));
  if (!parameter || !lowest || !highest) return std::nullopt;
  const double unit = parameter->boundary_unit();
  return gap::SoilBound{*parameter, *lowest / unit, *highest / unit};
}

void read_free(const EstimateCommand& options, gap::SoilEstimationOptions& estimation,
               std::vector<Fault>& faults) {
  using gap::SoilParameter;
  for (std::size_t i = 0; i < options.free.size(); ++i) {
    const auto parameter = gap::free_parameter(options.free[i]);
    if (!parameter)
      faults.push_back({fmt::format("/free/{}", i),
                        unknown_name("parameter", options.free[i], gap::free_parameter_names())});
    else if (options.merge_stiffness &&
             (parameter->soil == SoilParameter::kKc || parameter->soil == SoilParameter::kKphi)) {
      gap::FreeParameter merged = SoilParameter::kBekker;
      merged.of = parameter->of;
      if (!gap::holds(estimation.free, merged)) estimation.free.insert(estimation.free.begin(), merged);
    } else {
      estimation.free.push_back(*parameter);
    }
  }
  if (options.merge_stiffness && !options.free.empty() &&
      std::none_of(estimation.free.begin(), estimation.free.end(),
                   [](const gap::FreeParameter& p) { return p.soil == SoilParameter::kBekker; }))
    faults.push_back({"/merge-stiffness", "merge-stiffness merges k_c and k_phi, and neither is free"});
  if (options.merge_stiffness && options.free.empty()) {
    estimation.free.assign({SoilParameter::kBekker, SoilParameter::kN});
    if (options.from == From::kWheel)
      estimation.free.insert(estimation.free.end(), {SoilParameter::kCohesion, SoilParameter::kFrictionAngle,
                                                     SoilParameter::kShearModulus});
  }
}

// "0.01,24".
std::optional<sim::Grousers> grousers_of(std::string_view text) {
  const std::size_t comma = text.find(',');
  if (comma == std::string_view::npos) return std::nullopt;
  const auto height = number(text.substr(0, comma)), count = number(text.substr(comma + 1));
  if (!height || !count || !(*height >= 0.0 && *height <= 0.2) || !(*count >= 0.0 && *count <= 200.0))
    return std::nullopt;
  return sim::Grousers{*height, *count};
}

// Where "0.058" goes, and "0.058@LABEL": to all wheels, or to one that tests name.
api::TestedWheel& wheel_of(std::string_view text, api::SoilEstimateRequest& request) {
  const std::size_t at = text.find('@');
  if (at == std::string_view::npos) return request.wheel;
  const std::string_view label = text.substr(at + 1);
  for (api::NamedWheel& wheel : request.wheels)
    if (wheel.name == label) return wheel.wheel;
  return request.wheels.emplace_back(api::NamedWheel{std::string(label), {}}).wheel;
}

// The wheels' numbers. A number that is given twice of one wheel is a fault, none is left out.
void read_wheels(const EstimateCommand& options, api::SoilEstimateRequest& request,
                 std::vector<Fault>& faults) {
  const auto read = [&](const std::vector<std::string>& texts, const char* flag, const char* meaning,
                        const auto& parse, auto member) {
    for (const std::string& text : texts) {
      auto& place = wheel_of(text, request).*member;
      const auto value = parse(std::string_view(text).substr(0, text.find('@')));
      if (!value)
        faults.push_back({flag, fmt::format("{} is not {}", in_quotes(text), meaning)});
      else if (place)
        faults.push_back({flag, fmt::format("{}: this is given more than once", in_quotes(text))});
      else
        place = *value;
    }
  };
  read(options.radii, "/wheel-radius", "a number of metres, as 0.125 is", number,
       &api::TestedWheel::radius_m);
  read(options.widths, "/wheel-width", "a number of metres, as 0.16 is", number, &api::TestedWheel::width_m);
  read(options.grousers, "/grousers", "height in m and count, as 0.01,24 is", grousers_of,
       &api::TestedWheel::grousers);
}

void read_soils(const EstimateCommand& options, api::SoilEstimateRequest& request,
                std::vector<Fault>& faults) {
  bool given = false;
  for (const std::string& text : options.soils) {
    const std::size_t equals = text.find('=');
    if (equals != std::string::npos) {
      request.soils.push_back({text.substr(0, equals), text.substr(equals + 1)});
      continue;
    }
    if (given) faults.push_back({"/soil", "soil is given twice; LABEL=NAME is of one that tests name"});
    given = true;
    request.soil = text;
  }
}

// What is at work and what is set.
void read_changes(const EstimateCommand& options, api::SoilEstimateRequest& request,
                  std::vector<Fault>& faults) {
  for (const std::string& text : options.effects) {
    const auto effect = effect_of(text);
    if (effect)
      request.effects.push_back(*effect);
    else
      faults.insert(faults.end(), effect.error().faults.begin(), effect.error().faults.end());
  }
  for (const std::string& text : options.set) {
    const std::size_t equals = text.find('=');
    const auto value =
        equals == std::string::npos ? std::nullopt : number(std::string_view(text).substr(equals + 1));
    if (value)
      request.set.push_back({text.substr(0, equals), *value});
    else
      faults.push_back({"/set", fmt::format("{} is no setting NAME=value", in_quotes(text))});
  }
}

Result<api::SoilEstimateRequest> request_of(const EstimateCommand& options) {
  api::SoilEstimateRequest request;
  request.wheel = {options.rover, options.wheel, {}, {}, {}, options.motor_temp_c};
  request.gravity_m_s2 = options.gravity_m_s2;
  request.speed_m_s = options.speed_m_s;
  if (options.from == From::kDrives) request.campaign = options.files.front();
  std::vector<Fault> faults = api::choose_channels(options.channels, request);
  gap::SoilEstimationOptions& estimation = request.options;
  read_soils(options, request, faults);
  read_wheels(options, request, faults);
  read_changes(options, request, faults);
  read_free(options, estimation, faults);
  for (const std::string& text : options.bounds) {
    if (const auto bound = bound_of(text))
      estimation.bounds.push_back(*bound);
    else
      faults.push_back(
          {"/bound", fmt::format("{} is no bound NAME=lowest:highest of a parameter", in_quotes(text))});
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
  estimation.profile = !options.no_profile;
  if (!faults.empty()) return fail(ErrorCode::kInvalidRequest, api::summary_of(faults), faults);
  return request;
}

// Every file's tests; of several files, what names no wheel is of the wheel that its file is named after.
Result<bool> read_tests(const EstimateCommand& options, api::SoilEstimateRequest& request) {
  for (const std::string& path : options.files) {
    const auto bytes = api::read_data_file(path);
    if (!bytes) return fail(bytes.error());
    const std::filesystem::path file(path);
    if (options.from == From::kPlates) {
      auto plates = api::read_plate_tests_csv(file.filename().string(), *bytes);
      if (!plates) return fail(plates.error());
      request.data.plates.insert(request.data.plates.end(), plates->begin(), plates->end());
      continue;
    }
    auto wheels = api::read_wheel_tests_csv(file.filename().string(), *bytes);
    if (!wheels) return fail(wheels.error());
    for (gap::WheelObservation& observation : *wheels) {
      if (options.slip_definition == "travel")
        observation.test.slip_definition = sim::SlipDefinition::kTravel;
      observation.test.slip_radius = options.slip_radius == "tip"     ? sim::SlipRadius::kTip
                                     : options.slip_radius == "shear" ? sim::SlipRadius::kShear
                                                                      : sim::SlipRadius::kRim;
      if (options.files.size() > 1 && observation.wheel.empty()) observation.wheel = file.stem().string();
      request.data.wheels.push_back(std::move(observation));
    }
  }
  return true;
}

std::string words_of(const gap::SoilEstimate& e) {
  std::string out = fmt::format("{}: {}\n", e.soil.name, e.soil.summary);
  for (const sim::SoilDistribution& soil : e.further_soils)
    out += fmt::format("{}: {}\n", soil.name, soil.summary);
  out += "\n";
  TextTable table({"parameter", "start", "estimate", "std", "90 % from", "to", "determined", "unit"});
  for (const EstimatedParameter& p : e.parameters) {
    const auto shown = [&](double value) {
      return fmt::format("{:.4g}", p.parameter.boundary_unit() * value);
    };
    table.add({p.parameter.shown(), shown(p.start), shown(p.value), p.std ? shown(*p.std) : "-",
               (p.low_open ? "<= " : "") + shown(p.low), (p.high_open ? ">= " : "") + shown(p.high),
               std::string(gap::name_of(p.determination)), std::string(p.parameter.unit())});
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
    const auto campaign =
        api::load_drive_campaign(campaign_folder(options.files.front(), options.ask.data), *catalogue);
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

namespace {

constexpr const char* kExample =
    "Example: the soil under a wheel on a rig; that under plates; that of drives, from currents alone\n"
    "  slipway estimate wheel tests.csv --wheel-radius 0.125 --wheel-width 0.16 --soil unknown_ground\n"
    "  slipway estimate wheel bare.csv lugged.csv --wheel-radius 0.157 --wheel-width 0.165 --grousers "
    "0.01,30@lugged --free n,c1,c2,smooth_rim.friction_share@bare\n"
    "  slipway estimate plates plates.csv --free k_c,k_phi,n --soil-out soils/found.json\n"
    "  slipway estimate drives data/gap-practice/p01 --channels current\n"
    "  slipway estimate belief data/beliefs/wheel_tests_plain.json\n"
    "Exit status: 0 an estimate, whatever it determines, 1 none, 2 input that can't be read, with every "
    "fault.";

using From = EstimateCommand::From;

void add_of_tests(CLI::App& command, EstimateCommand& options) {
  command
      .add_option("--soil", options.soils,
                  "that the search starts from and that priors lie around, unknown_ground otherwise; "
                  "LABEL=NAME of a soil that tests name")
      ->allow_extra_args(false);
  command
      .add_option("--free", options.free,
                  "what is estimated: k_bekker, or k_c,k_phi; n, cohesion, friction_angle, shear_modulus; of "
                  "wheels any other number of a soil's file (c1, n1, dig_rim_share), of an effect "
                  "(smooth_rim.friction_share) or of the wheel (wheel.radius_m); NAME@LABEL of one wheel or "
                  "soil that tests name, otherwise shared by all")
      ->delimiter(',');
  command.add_flag("--merge-stiffness", options.merge_stiffness, "k_bekker in the place of k_c and k_phi");
  command.add_option("--bound", options.bounds, "NAME=lowest:highest, angles in degrees; may be repeated");
  command
      .add_option("--prior", options.priors,
                  "around the soil: wide (what soils of all kinds have), soil (its own spread), none")
      ->capture_default_str()
      ->check(CLI::IsMember({"none", "wide", "soil"}));
  command.add_option("--loss", options.loss, "what outliers cost")
      ->capture_default_str()
      ->check(CLI::IsMember({"none", "huber", "cauchy"}));
  command.add_option("--loss-scale", options.loss_scale, "in deviations, where outliers begin");
  command.add_option("--noise", options.noise, "of readings without a deviation of their own, as a share")
      ->capture_default_str()
      ->check(CLI::Range(1e-4, 1.0));
  command.add_flag("--no-profile", options.no_profile,
                   "intervals from the curvature at the estimate, not by profile likelihood");
  command.add_option("--seed", options.seed, "the same seed gives the same answer")
      ->capture_default_str()
      ->check(CLI::Range(std::uint64_t{0}, kMaxExactWhole));
  command.add_option("--plot", options.plot, "write measured against fitted (SVG) to this file");
}

void add_of_wheels(CLI::App& command, EstimateCommand& options) {
  CLI::Option* const rover = command.add_option("--rover", options.rover,
                                                "whose wheel and motor were tested; its effects are at work");
  command.add_option("--wheel", options.wheel, "of the rover; otherwise its first")->needs(rover);
  // One value each time, so that a file may follow.
  command
      .add_option("--wheel-radius", options.radii, "of the rim, m; 0.125@LABEL of a wheel that tests name")
      ->allow_extra_args(false);
  command.add_option("--wheel-width", options.widths, "of the rim, m; likewise")->allow_extra_args(false);
  command
      .add_option("--grousers", options.grousers, "height in m and count: 0.01,24; 0.01,24@LABEL likewise")
      ->allow_extra_args(false);
  command.add_option(
      "--effect", options.effects,
      "switch an effect on: NAME or NAME:parameter=value,...; NAME@LABEL on one wheel or soil");
  command.add_option("--set", options.set,
                     "NAME=value: anything that can be free, at another value than the soil's; where it is "
                     "free too, the search starts there; NAME@LABEL=value of one wheel or soil");
  command.add_option("--gravity", options.gravity_m_s2, "m/s^2; read by effects and grousers alone")
      ->capture_default_str();
  command.add_option("--speed-m-s", options.speed_m_s, "of the rim, for the motor")->capture_default_str();
  command.add_option("--motor-temp-c", options.motor_temp_c, "of the rover's motor")->needs(rover);
  command
      .add_option("--slip-definition", options.slip_definition,
                  "what slip compares the rim's speed with: forward (along the wheel's plane) or travel")
      ->capture_default_str()
      ->check(CLI::IsMember({"forward", "travel"}));
  command
      .add_option("--slip-radius", options.slip_radius,
                  "where the rim's speed in a slip is taken: rim, shear (where the soil is sheared) or tip")
      ->capture_default_str()
      ->check(CLI::IsMember({"rim", "shear", "tip"}));
}

std::shared_ptr<EstimateCommand> add(CLI::App& parent, const char* name, const char* about, const char* input,
                                     From from, CLI::App*& command, std::function<int()>& run) {
  const auto options = std::make_shared<EstimateCommand>();
  options->from = from;
  command = parent.add_subcommand(name, about);
  if (from == From::kDrives)
    command
        ->add_option_function<std::string>(
            "input", [options](const std::string& folder) { options->files = {folder}; }, input)
        ->required();
  else
    command->add_option("input", options->files, input)->required();
  add_data_option(*command, options->ask.data, "rovers and soils");
  command->add_flag("--json", options->ask.json, "print the whole document, for machines");
  command->add_option("--channels", options->channels, "what is read of what was measured; otherwise all")
      ->delimiter(',');
  command->add_option("--soil-out", options->soil_out,
                      "file for the estimated soil: put into a data folder's soils it is planned with");
  command->footer(kExample);
  command->callback([options, &run] { run = [options] { return estimate(*options); }; });
  return options;
}

void add_belief(CLI::App& parent, std::function<int()>& run) {
  const auto options = std::make_shared<BeliefCommand>();
  CLI::App* command =
      parent.add_subcommand("belief", "what differs between soils, from the wheel tests of several");
  command
      ->add_option("input", options->file,
                   "file \"soil-belief/1\": the soils' tests, what is free in each, and what is between them")
      ->required();
  add_data_option(*command, options->ask.data, "soils and tables of tests");
  command->add_flag("--json", options->ask.json, "print the whole document, for machines");
  command->footer(kExample);
  command->callback([options, &run] { run = [options] { return believe(*options); }; });
}

}  // namespace

void add_estimate_command(CLI::App& app, std::function<int()>& run) {
  CLI::App* parent =
      app.add_subcommand("estimate", "the soil that wheel tests, plate tests or drives show, and how surely");
  parent->require_subcommand(1);
  parent->footer(kExample);
  CLI::App* command = nullptr;
  auto options = add(*parent, "wheel", "from tests of a single wheel",
                     "CSV: load_n, slip_ratio, and of torque_nm, drawbar_pull_n, thrust_n, sinkage_m, "
                     "current_a, lateral_force_n what was measured; columns wheel and soil name what was "
                     "tested, and of several files each is of the wheel that it is named after",
                     From::kWheel, command, run);
  add_of_wheels(*command, *options);
  add_of_tests(*command, *options);
  options = add(*parent, "plates", "from plates pressed into the soil",
                "CSV: plate_radius_m, sinkage_m, pressure_pa or force_n", From::kPlates, command, run);
  add_of_tests(*command, *options);
  options = add(*parent, "drives", "from recorded drives, around the campaign's own soils",
                "folder of a drive campaign", From::kDrives, command, run);
  command->add_option("--threads", options->threads, "at once; 0: as many as the machine has")
      ->capture_default_str()
      ->check(CLI::Range(0, 1024));
  add_belief(*parent, run);
}

}  // namespace slipway::server
