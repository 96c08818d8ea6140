#include "server/cli/commands/tune_command.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "api/documents/soil/tuning_document.h"
#include "api/files/drive_table/campaign_source.h"
#include "api/files/drive_table/measured_finals.h"
#include "api/files/whole_file.h"
#include "api/report/tuning_charts.h"
#include "campaign/tune.h"
#include "core/angle.h"
#include "gap/estimate/least_squares.h"
#include "server/cli/inquiry/command_parts.h"
#include "server/cli/inquiry/data_folder.h"
#include "server/cli/inquiry/data_option.h"
#include "server/cli/inquiry/drive_choice.h"
#include "server/cli/terminal/terminal_progress.h"
#include "server/cli/terminal/text_table.h"

namespace slipway::server {
namespace {

using slipway::campaign::TableTuning;
using slipway::campaign::TuneRequest;

std::optional<double> number(std::string_view text) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

struct TwoNumbers {
  std::string name;
  double first = 0.0, second = 0.0;
};

// "NAME=first(between)second".
std::optional<TwoNumbers> two_numbers(std::string_view text, std::string_view between) {
  const std::size_t equals = text.find('=');
  if (equals == std::string_view::npos) return std::nullopt;
  const std::string_view values = text.substr(equals + 1);
  const std::size_t middle = values.find(between);
  if (middle == std::string_view::npos) return std::nullopt;
  const auto first = number(values.substr(0, middle)),
             second = number(values.substr(middle + between.size()));
  if (!first || !second) return std::nullopt;
  return TwoNumbers{std::string(text.substr(0, equals)), *first, *second};
}

Result<std::vector<gap::TunedParameter>> parameters_of(const TuneCommand& options) {
  constexpr std::string_view kLogarithmic = ":log";
  std::vector<gap::TunedParameter> parameters;
  std::vector<Fault> faults;
  for (const std::string& text : options.parameters) {
    std::string_view range = text;
    const bool logarithmic = range.ends_with(kLogarithmic);
    if (logarithmic) range.remove_suffix(kLogarithmic.size());
    const auto given = two_numbers(range, "..");
    if (given)
      parameters.push_back({{.name = given->name,
                             .lowest = given->first,
                             .highest = given->second,
                             .coarse = options.coarse,
                             .fine = options.fine,
                             .logarithmic = logarithmic},
                            {}});
    else
      faults.push_back(
          {"/parameter", fmt::format("\"{}\" must be NAME=lowest..highest or with :log behind it", text)});
  }
  for (const std::string& text : options.priors) {
    const auto given = two_numbers(text, ",");
    if (!given) faults.push_back({"/prior", fmt::format("\"{}\" must be NAME=mean,std", text)});
    bool found = !given;
    for (gap::TunedParameter& parameter : parameters) {
      if (!given || parameter.sweep.name != given->name) continue;
      parameter.prior = gap::Prior{given->first, given->second};
      found = true;
    }
    if (!found) faults.push_back({"/prior", fmt::format("{} is none of the parameters", given->name)});
  }
  if (options.loss_scale && options.loss == "none")
    faults.push_back(
        {"/loss-scale", "loss-scale says where outliers begin, which without a --loss are none"});
  if (!faults.empty()) return fail(ErrorCode::kInvalidRequest, "this can't be tuned", std::move(faults));
  return parameters;
}

// Of a name that the command line has checked.
gap::RobustLoss loss_of(std::string_view name) {
  const auto names = gap::robust_loss_names();
  return static_cast<gap::RobustLoss>(std::find(names.begin(), names.end(), name) - names.begin());
}

std::string score_words(const std::optional<double>& score) {
  return score ? fmt::format("{:.3f}", *score) : "none";
}

// "0.1 to 10.8 deg (3 of 4)".
std::string served_words(const gap::DriveTuning& tuning, std::size_t point) {
  const gap::SlopeService& service = tuning.services[point];
  const std::string share = fmt::format("{} of {}", service.count, tuning.tilts.size());
  if (!service.range) return share;
  return fmt::format("{:.1f} to {:.1f} deg ({})", deg_from_rad(service.range->lowest_rad),
                     deg_from_rad(service.range->highest_rad), share);
}

std::string sets_table(const gap::DriveTuning& tuning) {
  std::vector<std::string> header{"best for"};
  header.insert(header.end(), tuning.sweep.names.begin(), tuning.sweep.names.end());
  for (const gap::TiltGroup& group : tuning.tilts)
    header.push_back(fmt::format("at {:.1f} deg", deg_from_rad(group.tilt_rad)));
  header.insert(header.end(), {"all drives", "serves tilts"});
  TextTable text(header);
  const auto add = [&](std::string words, std::size_t point) {
    std::vector<std::string> row{std::move(words)};
    for (const double x : tuning.sweep.points[point].x) row.push_back(fmt::format("{:.5g}", x));
    for (const auto& score : tuning.services[point].scores) row.push_back(score_words(score));
    row.push_back(score_words(tuning.sweep.points[point].score));
    row.push_back(served_words(tuning, point));
    text.add(std::move(row));
  };
  add("all, coarse", tuning.sweep.best_coarse);
  add("all, fine", tuning.sweep.best);
  add("most tilts", tuning.widest);
  for (const gap::TiltGroup& group : tuning.tilts)
    add(fmt::format("{:.1f} deg", deg_from_rad(group.tilt_rad)), group.best);
  return text.print();
}

constexpr std::size_t kMaxNamed = 5;  // drives; tuning.json has all

// What the uncertainties rest on: "noise 0.031 of the scales; far off: a-r1, b".
std::string noise_words(const TableTuning& result, const gap::TuningFit& fit) {
  std::string out = fmt::format("  noise {:.3g} of the scales", fit.noise);
  if (fit.fit.residual_variance > 1.005)
    out += fmt::format(", scatter {:.3g} times that", std::sqrt(fit.fit.residual_variance));
  for (std::size_t i = 0; i < std::min(fit.beyond.size(), kMaxNamed); ++i)
    out += (i == 0 ? "; far off: " : ", ") + result.drives[fit.beyond[i]].name;
  if (fit.beyond.size() > kMaxNamed) out += fmt::format(" and {} more", fit.beyond.size() - kMaxNamed);
  return out + "\n";
}

std::string fit_words(const TableTuning& answer, const gap::TuningFit& result, const std::string& drives) {
  const gap::DriveTuning& tuning = answer.tuning;
  const gap::LeastSquaresFit& fit = result.fit;
  std::string out = fmt::format("least squares, {}: score {:.3f}{}\n", drives, result.score,
                                fit.converged ? "" : ", not converged");
  out += noise_words(answer, result);
  for (std::size_t k = 0; k < fit.estimate.size(); ++k) {
    const auto std = fit.standard_error(k);
    out += fmt::format("  {} = {:.5g} {}{}\n", tuning.sweep.names[k], fit.estimate[k],
                       std ? fmt::format("+- {:.2g}", *std) : "(undetermined)",
                       fit.on_bound[k] ? ", at the end of its range" : "");
  }
  for (std::size_t j = 0; j < fit.estimate.size(); ++j)
    for (std::size_t k = j + 1; k < fit.estimate.size(); ++k)
      if (const auto correlation = fit.correlation(j, k))
        out += fmt::format("  correlation of {} and {}: {:.2f}\n", tuning.sweep.names[j],
                           tuning.sweep.names[k], *correlation);
  for (const gap::UndeterminedDirection& direction : fit.undetermined)
    out += fmt::format("  the drives do not tell {}\n", direction.words);
  return out;
}

std::string answer_words(const TableTuning& result) {
  const gap::DriveTuning& tuning = result.tuning;
  std::size_t repeats = 0;
  for (const gap::MeasuredDrive& drive : result.drives) repeats += drive.finals.size();
  std::string out = fmt::format("{} drives, {} of them different, {} parameter sets; scores:\n", repeats,
                                result.drives.size(), tuning.sweep.points.size());
  out += sets_table(tuning);
  if (tuning.fit) out += fit_words(result, *tuning.fit, "all drives");
  for (const gap::TiltGroup& group : tuning.tilts)
    if (group.fit)
      out += fit_words(result, *group.fit, fmt::format("{:.1f} deg alone", deg_from_rad(group.tilt_rad)));
  return out;
}

std::vector<OutputFile> files_of(const std::string& folder, const std::string& title,
                                 const std::string& document, const TableTuning& result) {
  const std::filesystem::path path(folder);
  std::vector<OutputFile> files{{(path / "tuning.json").string(), document}};
  for (api::NamedChart& chart : api::draw_tuning(title, result))
    files.push_back({(path / (chart.name + ".svg")).string(), std::move(chart.svg)});
  return files;
}

}  // namespace

int tune(const TuneCommand& options) {
  auto parameters = parameters_of(options);
  if (!parameters) return refuse(parameters.error());
  const auto data = data_folder(options.data);
  if (!data) return refuse(data.error());
  const auto catalogue = api::load_catalogue(*data);
  if (!catalogue) return refuse(catalogue.error());
  std::cerr << left_out_text(*catalogue);
  const auto loaded = api::load_campaign_table(options.table, *data, *catalogue);
  if (!loaded) return refuse(loaded.error());
  const auto drives = chosen_drives(slipway::campaign::expand(loaded->table), options.drives, "/drives");
  if (!drives) return refuse(drives.error());
  const auto measured = api::read_measured_finals(options.measured, loaded->table, *drives);
  if (!measured) return refuse(measured.error());
  TuneRequest request;
  request.parameters = std::move(*parameters);
  request.options = {.scales = {.position_m = options.position_scale_m,
                                .heading_rad = rad_from_deg(options.heading_scale_deg)},
                     .scales_are_errors = options.scales_are_errors,
                     .within = options.within,
                     .good_enough = options.good_enough,
                     .least_squares = !options.sweep_only,
                     .loss = loss_of(options.loss),
                     .loss_scale = options.loss_scale,
                     .fit_each_tilt = options.each_tilt,
                     .threads = static_cast<std::size_t>(options.threads)};
  std::optional<Result<TableTuning>> result;
  {
    TerminalProgress progress;
    result = slipway::campaign::tune(loaded->table, *drives, *measured, request, progress);
  }
  if (!*result) return refuse(result->error());
  const TableTuning& tuning = **result;
  if (!tuning.unmeasured.empty())
    std::cerr << fmt::format("{} of {} drives have no measured end, the first is {}\n",
                             tuning.unmeasured.size(), drives->size(), tuning.unmeasured.front());
  const std::string document = api::json::tuning_document(loaded->table, request, tuning);
  std::vector<OutputFile> files;
  if (!options.out.empty()) {
    if (const auto made = api::make_folder(options.out); !made) return refuse(made.error());
    files = files_of(options.out, loaded->table.name, document, tuning);
  }
  return deliver(files, options.json ? document : answer_words(tuning));
}

void add_tune_command(CLI::App& app, std::function<int()>& run) {
  const auto options = std::make_shared<TuneCommand>();
  CLI::App* command = app.add_subcommand("tune", "tune a table's soil to where its drives really ended");
  command->add_option("table", options->table, "file of a table, or name of a shipped one")->required();
  add_data_option(*command, options->data, "rovers, soils and campaigns");
  command
      ->add_option("--measured", options->measured,
                   "folder of a campaign, or CSV with columns drive, x_m, y_m, yaw_deg")
      ->required();
  command
      ->add_option("--parameter", options->parameters,
                   "NAME=lowest..highest, with :log for steps of a ratio: soil.friction_angle_deg=28..40")
      ->required();
  command->add_option("--prior", options->priors, "NAME=mean,std: what is known besides, for least squares");
  command->add_option("--coarse", options->coarse, "values of each parameter in the coarse sweep")
      ->capture_default_str()
      ->check(CLI::Range(2, 1000));
  command->add_option("--fine", options->fine, "values of each parameter in the fine sweep")
      ->capture_default_str()
      ->check(CLI::Range(2, 1000));
  command->add_option("--drives", options->drives, "ids of drives, * and ? stand for anything");
  command->add_option("--position-scale-m", options->position_scale_m, "so far off counts 1")
      ->capture_default_str();
  command->add_option("--heading-scale-deg", options->heading_scale_deg, "so far off counts 1")
      ->capture_default_str();
  command->add_flag(
      "--scales-are-errors", options->scales_are_errors,
      "the scales are standard deviations; otherwise those are estimated from what is left over");
  const std::span<const std::string_view> losses = gap::robust_loss_names();
  command
      ->add_option("--loss", options->loss,
                   "what least squares makes of drives that are far off: none counts them in full, huber by "
                   "their size, cauchy hardly at all")
      ->capture_default_str()
      ->check(CLI::IsMember(std::vector<std::string>(losses.begin(), losses.end())));
  command
      ->add_option("--loss-scale", options->loss_scale,
                   "far off begins at so many times the noise; 1.345 for huber and 2.385 for cauchy where "
                   "not given")
      ->check(CLI::PositiveNumber);
  command
      ->add_option("--within", options->within,
                   "a set serves a tilt up to so many times its best score there")
      ->capture_default_str();
  command->add_option("--good-enough", options->good_enough, "and up to this score in any case")
      ->capture_default_str();
  command->add_flag("--each-tilt", options->each_tilt, "least squares by the drives of each tilt, too");
  command->add_flag("--sweep-only", options->sweep_only, "no least squares");
  command->add_option("--threads", options->threads, "at once; 0: as many as the machine has")
      ->capture_default_str()
      ->check(CLI::Range(0, 1024));
  command->add_option("--out", options->out, "folder for tuning.json and the score surface; made if need be");
  command->add_flag("--json", options->json, "print the document, for machines");
  command->footer(
      "Example: which friction and which shear modulus bring simulated drives to where the real ones ended?\n"
      "  slipway tune fido_table_1 --measured fido --drives 'straight_*' --parameter "
      "soil.friction_angle_deg=28..44 --parameter soil.shear_modulus_m=0.005..0.025 --out tuned\n"
      "Exit status: 0 an answer, 1 none, 2 the question has faults; an unknown parameter lists those there "
      "are.");
  command->callback([options, &run] { run = [options] { return tune(*options); }; });
}

}  // namespace slipway::server
