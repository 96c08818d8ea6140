#include "server/cli/commands/steps_command.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <charconv>
#include <memory>
#include <optional>

#include "api/files/slip_steps_file.h"
#include "api/files/soil_file.h"
#include "api/json/writer.h"
#include "api/steps/step_chart.h"
#include "api/steps/step_comparison.h"
#include "api/steps/step_comparison_document.h"
#include "core/fault_words.h"
#include "server/cli/inquiry/command_parts.h"
#include "server/cli/inquiry/data_option.h"
#include "server/cli/terminal/terminal_progress.h"
#include "steps/belief_fit.h"

namespace slipway::server {
namespace {

steps::StepLearning learning_of(const std::string& name) {
  if (name == "sols") return steps::StepLearning::kSols;
  return name == "drive" ? steps::StepLearning::kDrive : steps::StepLearning::kNone;
}

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  for (;;) {
    const std::size_t at = text.find(separator);
    parts.push_back(text.substr(0, at));
    if (at == std::string_view::npos) return parts;
    text.remove_prefix(at + 1);
  }
}

std::optional<int> whole(std::string_view text) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || value < 0) return std::nullopt;
  return value;
}

// Whether each step belongs to the class that "538:20-36,978" or "unit:SM,SMR" names; nothing where that is
// no such list.
std::optional<std::vector<bool>> members(std::string_view list, const std::vector<steps::SlipStep>& steps) {
  std::vector<bool> chosen(steps.size(), false);
  constexpr std::string_view kUnit = "unit:";
  if (list.starts_with(kUnit)) {
    for (const std::string_view unit : split(list.substr(kUnit.size()), ','))
      for (std::size_t i = 0; i < steps.size(); ++i)
        chosen[i] = chosen[i] || (!unit.empty() && steps[i].terrain_unit == unit);
    return chosen;
  }
  for (const std::string_view part : split(list, ',')) {
    const std::vector<std::string_view> halves = split(part, ':');
    const std::vector<std::string_view> range =
        halves.size() == 2 ? split(halves[1], '-') : std::vector<std::string_view>{};
    const auto sol = whole(halves[0]);
    const auto first = range.size() == 2 ? whole(range[0]) : std::optional(0);
    const auto last = range.size() == 2 ? whole(range[1]) : std::optional(1'000'000);
    if (!sol || !first || !last || halves.size() > 2 || (halves.size() == 2 && range.size() != 2))
      return std::nullopt;
    int number = 0;
    for (std::size_t i = 0; i < steps.size(); ++i) {
      number = i > 0 && steps[i].sol == steps[i - 1].sol ? number + 1 : 1;
      if (steps[i].sol == *sol && number >= *first && number <= *last) chosen[i] = true;
    }
  }
  return chosen;
}

Result<std::vector<steps::GroundClassSteps>> classes_of(const StepsLearnCommand& options,
                                                        const std::vector<steps::SlipStep>& steps) {
  std::vector<steps::GroundClassSteps> classes;
  std::vector<Fault> faults;
  for (const std::string& text : options.classes) {
    const std::size_t equals = text.find('=');
    const auto chosen = equals == std::string::npos || equals == 0
                            ? std::nullopt
                            : members(std::string_view(text).substr(equals + 1), steps);
    if (!chosen) {
      faults.push_back({"/class", fmt::format("{} must be NAME=SOL,SOL:FIRST-LAST or NAME=unit:UNIT,UNIT",
                                              in_quotes(text))});
      continue;
    }
    steps::GroundClassSteps& of = classes.emplace_back();
    of.name = text.substr(0, equals);
    of.summary = fmt::format("Ground like that of the steps {}", text.substr(equals + 1));
    std::vector<steps::SlipStep> run;
    const auto end_run = [&] {
      for (auto& way : api::ways_of(run)) of.ways.push_back(std::move(way));
      run.clear();
    };
    for (std::size_t i = 0; i < steps.size(); ++i) {
      if ((*chosen)[i]) run.push_back(steps[i]);
      if (!(*chosen)[i]) end_run();
    }
    end_run();
    if (of.ways.empty())
      faults.push_back({"/class", fmt::format("no step of the tables belongs to {}", in_quotes(text))});
  }
  if (!faults.empty())
    return fail(ErrorCode::kInvalidRequest, "the classes can't be fitted", std::move(faults));
  return classes;
}

std::string fit_words(const steps::BeliefFit& fit) {
  double loose = 0.0;
  for (const steps::FittedSoil& soil : fit.soils) loose += soil.in_patches ? soil.share.value : 0.0;
  std::string out = fmt::format(
      "{} steps of {} sols; in brackets 90 % intervals\n"
      "odometry counts too much, %     {}\n"
      "scatter of a step, least        {}\n"
      "scatter of a step, share        {}\n"
      "patches of loose ground, m      {}\n"
      "share of loose ground, %        {:.2f}\n\n"
      "soil              share, %              level slip  at 8 deg  sinkage, mm\n",
      fit.steps, fit.ways, api::estimate_words(fit.odometry_offset, 100.0, 2),
      api::estimate_words(fit.noise_least, 1.0, 3), api::estimate_words(fit.noise_share, 1.0, 2),
      api::estimate_words(fit.patch_m, 1.0, 0), 100.0 * loose);
  for (const steps::FittedSoil& soil : fit.soils)
    out += fmt::format("{:<17} {:<21} {:>10.3f} {:>9.3f} {:>12.0f}\n", soil.name,
                       api::estimate_words(soil.share, 100.0, 2), soil.level_slip, soil.slip_at_8_deg,
                       1000.0 * soil.level_sinkage_m);
  for (std::size_t c = 1; c < fit.classes.size(); ++c) {
    double share = 0.0;
    for (std::size_t k = 0; k < fit.soils.size(); ++k)
      share += fit.soils[k].in_patches ? fit.classes[c].shares[k] : 0.0;
    out += fmt::format("{}: {} steps, {:.1f} % loose\n", fit.classes[c].name, fit.classes[c].steps,
                       100.0 * share);
  }
  return out;
}

std::string soils_file(const std::vector<sim::SoilDistribution>& soils, const sim::SoilFormat& format) {
  api::json::Writer w;
  w.begin_object().text("format", "soils/1").key("soils").begin_array();
  for (const sim::SoilDistribution& soil : soils) api::json::write_soil(w, soil, format);
  w.end_array().end_object();
  return w.take() + "\n";
}

}  // namespace

int steps_score(const StepsScoreCommand& options) {
  const auto table = api::read_slip_steps_file(options.table, options.table);
  if (!table) return refuse_unreadable(table.error());
  const auto catalogue = open_catalogue(options.data);
  if (!catalogue) return refuse(catalogue.error());
  const api::StepComparisonRequest request{.rover = options.rover,
                                           .terrain = options.terrain,
                                           .legend = options.legend,
                                           .learning = learning_of(options.learn)};
  const auto comparison = api::compare_steps(*catalogue, request, *table);
  if (!comparison) return refuse_unreadable(comparison.error());
  std::vector<OutputFile> files;
  if (!options.plot.empty()) files.push_back({options.plot, api::step_chart(*comparison)});
  return deliver(files, options.json ? api::step_comparison_json(request, *table, *comparison) + "\n"
                                     : api::step_comparison_text(request, *comparison));
}

int steps_learn(const StepsLearnCommand& options) {
  std::vector<steps::SlipStep> table;
  for (const std::string& path : options.tables) {
    const auto steps = api::read_slip_steps_file(path, path);
    if (!steps) return refuse_unreadable(steps.error());
    table.insert(table.end(), steps->begin(), steps->end());
  }
  const auto classes = classes_of(options, table);
  if (!classes) return refuse_unreadable(classes.error());
  const auto catalogue = open_catalogue(options.data);
  if (!catalogue) return refuse(catalogue.error());
  const auto rover = api::rover_that_made_steps(*catalogue, options.rover);
  if (!rover) return refuse_unreadable(rover.error());
  const steps::BeliefFitOptions fit_options;
  TerminalProgress progress;
  const auto fit = steps::fit_belief(**rover, api::kMarsGravity_m_s2, api::ways_of(table), *classes,
                                     fit_options, progress);
  if (!fit) return refuse(fit.error());
  const std::string source =
      fmt::format("slipway steps learn: {} measured steps of {} sols, {}; see docs/results/mars.md",
                  fit->steps, fit->ways, options.rover);
  return deliver(
      {{options.out, soils_file(steps::as_soils(*fit, fit_options, source), *catalogue->soil_format)}},
      fit_words(*fit));
}

namespace {

void add_score(CLI::App& steps, std::function<int()>& run) {
  const auto options = std::make_shared<StepsScoreCommand>();
  CLI::App* const command =
      steps.add_subcommand("score", "predict the slip of every measured step and compare");
  command->add_option("table", options->table, "file of steps (CSV, \"slip-steps/1\")")->required();
  add_data_option(*command, options->data, "rovers, soils and terrains");
  command->add_option("--rover", options->rover, "rover that made the steps")->capture_default_str();
  command->add_option("--terrain", options->terrain, "take slope and soil from this terrain's map");
  command->add_option("--legend", options->legend, "legend of the terrain; its first where not given");
  command
      ->add_option("--learn", options->learn,
                   "what a forecast knows: none, sols (the sols before it) or drive (also the steps before "
                   "it on its sol)")
      ->capture_default_str()
      ->check(CLI::IsMember({"none", "sols", "drive"}));
  command->add_option("--plot", options->plot, "file for a picture of slip over climb (SVG)");
  command->add_flag("--json", options->json, "print every step and the summary as a document, for machines");
  command->footer(
      "Example:\n"
      "  slipway steps score curiosity.csv --learn drive\n"
      "Exit status: 0 compared, 1 the picture could not be written, 2 options or files with faults.");
  command->callback([options, &run] { run = [options] { return steps_score(*options); }; });
}

void add_learn(CLI::App& steps, std::function<int()>& run) {
  const auto options = std::make_shared<StepsLearnCommand>();
  CLI::App* const command =
      steps.add_subcommand("learn", "fit a belief of the ground to measured steps and write it as soils");
  command->add_option("tables", options->tables, "files of steps (CSV, \"slip-steps/1\")")->required();
  add_data_option(*command, options->data, "rovers");
  command->add_option("--rover", options->rover, "rover that made the steps")->capture_default_str();
  command->add_option(
      "--class", options->classes,
      "a class of ground fitted to some steps: NAME=978,538:20-36 (sols, or steps of a sol) or "
      "NAME=unit:SM,SMR (the table's terrain_unit)");
  command->add_option("--out", options->out, "file of the soils (JSON, \"soils/1\")")->required();
  command->footer(
      "Example:\n"
      "  slipway steps learn curiosity.csv --class mars_dune=538:21-36 --out soils.json\n"
      "Exit status: 0 written, 1 given up or not written, 2 options or files with faults.");
  command->callback([options, &run] { run = [options] { return steps_learn(*options); }; });
}

}  // namespace

void add_steps_command(CLI::App& app, std::function<int()>& run) {
  CLI::App* const command =
      app.add_subcommand("steps", "measured slip of a rover, step by step: compare with it, learn from it");
  command->require_subcommand(1);
  add_score(*command, run);
  add_learn(*command, run);
}

}  // namespace slipway::server
