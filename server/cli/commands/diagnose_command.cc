#include "server/cli/commands/diagnose_command.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "api/documents/diagnosis/diagnosis_document.h"
#include "api/files/campaign/drive_campaign_source.h"
#include "api/files/corrected_model.h"
#include "api/files/model_folder.h"
#include "api/files/whole_file.h"
#include "api/report/diagnosis_charts.h"
#include "api/report/diagnosis_report.h"
#include "api/report/report_words.h"
#include "core/largest_exact_whole.h"
#include "gap/diagnosis/diagnosis.h"
#include "gap/diagnosis/drive_watch.h"
#include "server/cli/commands/watch_command.h"
#include "server/cli/inquiry/command_parts.h"
#include "server/cli/inquiry/data_folder.h"
#include "server/cli/inquiry/data_option.h"
#include "server/cli/terminal/terminal_progress.h"
#include "server/cli/terminal/text_table.h"

namespace slipway::server {
namespace {

using api::interval_words;
using gap::Diagnosis;

constexpr double kMinMarginal = 0.05;
constexpr std::size_t kMaxCandidates = 6, kMaxChannels = 8, kMaxRegimes = 3, kMaxLeast = 6;

std::string names_words(const std::vector<std::string>& names) {
  return names.empty() ? "nothing missing" : fmt::format("{}", fmt::join(names, " + "));
}

std::string effects_words(const Diagnosis& d) {
  std::string out;
  for (const gap::FoundEffect& found : d.effects) {
    out += fmt::format("  {}{}, probability {:.2f} over all explanations", found.name,
                       found.variant.empty() ? "" : fmt::format(" ({})", found.variant), found.probability);
    for (const gap::FoundParameter& p : found.parameters)
      out += fmt::format(", {} = {}", p.name, interval_words(p.value));
    out += "\n";
  }
  return out;
}

std::string candidates_words(const Diagnosis& d) {
  TextTable table({"explanation", "probability", "complexity"});
  std::size_t shown = 0;
  for (const gap::ComparedSet& set : api::json::compared_sets(d)) {
    if (++shown > kMaxCandidates) break;
    table.add({names_words(gap::names_of(set)), fmt::format("{:.3f}", set.probability),
               fmt::format("{}", set.complexity)});
  }
  return table.print();
}

// Of the effects that are not next to impossible.
std::string marginals_words(const Diagnosis& d) {
  std::string out;
  for (const gap::EffectMarginal& m : d.marginals)
    if (m.probability >= kMinMarginal)
      out += fmt::format("  {}: probability {:.3f} over all explanations, closes {:.0f} % of the gap\n",
                         m.name, m.probability, 100.0 * m.closed_share);
  return out.empty() ? out : "effects one by one:\n" + out;
}

std::string residual_words(const Diagnosis& d) {
  if (d.residual.empty()) return {};
  std::string out =
      "unexplained (shares of this description, of all drives and in squared deviations of the noise):\n";
  for (const gap::ResidualShape& shape : d.residual)
    out +=
        fmt::format("  {:.0f} %: {}\n", 100.0 * shape.share,
                    shape.words.empty() ? fmt::format("{} by {}", shape.entry, shape.variable) : shape.words);
  return out;
}

std::string channels_words(const Diagnosis& d) {
  std::vector<gap::ChannelGap> channels = d.channels;
  std::stable_sort(channels.begin(), channels.end(), [](const auto& a, const auto& b) {
    return a.significance < b.significance ||
           (a.significance == b.significance && a.gap * b.noise > b.gap * a.noise);
  });
  TextTable table({"channel", "gap", "noise", "mean", "p", "unit"});
  for (std::size_t i = 0; i < std::min(channels.size(), kMaxChannels); ++i) {
    const gap::ChannelGap& c = channels[i];
    const double unit = gap::boundary_unit(c.channel);
    table.add({fmt::format("{}{}", gap::name_of(c.channel), c.wheel ? " " + *c.wheel : ""),
               fmt::format("{:.3g}", unit * c.gap), fmt::format("{:.3g}", unit * c.noise),
               fmt::format("{:.3g}", unit * c.bias), fmt::format("{:.3f}", c.significance),
               std::string(gap::unit_of(c.channel))});
  }
  return table.print();
}

std::string ladder_words(const Diagnosis& d) {
  TextTable table({"channel", "nominal", "re-tuned", "with effects", "with discrepancy", "floor", "unit"});
  for (const gap::ChannelClosure& c : d.gap) {
    const double unit = gap::boundary_unit(c.channel);
    table.add({std::string(gap::name_of(c.channel)), interval_words(c.nominal, unit),
               interval_words(c.retuned, unit), interval_words(c.with_effects, unit),
               c.with_discrepancy ? interval_words(*c.with_discrepancy, unit) : std::string(),
               interval_words(c.noise_floor, unit), std::string(gap::unit_of(c.channel))});
  }
  return table.print();
}

std::string regimes_words(const std::vector<gap::Regime>& regimes) {
  std::string out;
  for (std::size_t i = 0; i < std::min(regimes.size(), kMaxRegimes); ++i) {
    std::vector<std::string> conditions;
    for (const gap::Condition& c : regimes[i].conditions)
      conditions.push_back(fmt::format("{} {:.3g} to {:.3g}", gap::name_of(c.variable), c.from, c.to));
    out += fmt::format("  {} where {}: {:.0f} % of it in {:.0f} % of the data\n",
                       gap::name_of(regimes[i].channel), fmt::join(conditions, " and "),
                       100.0 * regimes[i].share_of_gap, 100.0 * regimes[i].share_of_data);
  }
  return out;
}

std::string channels_of_effects_words(const Diagnosis& d) {
  std::vector<std::string> channels;
  for (const gap::ChannelShare& c : d.channels_of_effects)
    if (c.share >= 0.01)
      channels.push_back(fmt::format("{} {:.0f} %", gap::name_of(c.channel), 100.0 * c.share));
  return fmt::format("the effect acts in {} (of its squares, in deviations of the noise)\n",
                     fmt::join(channels, ", "));
}

std::string reference_words(const gap::ReferenceSummary& reference) {
  TextTable table({"channel", "learnt, rms", "left open, rms", "unit"});
  for (const gap::ReferenceSummary::LearntChannel& c : reference.channels) {
    const double unit = gap::boundary_unit(c.channel);
    table.add({std::string(gap::name_of(c.channel)), fmt::format("{:.2g}", unit * c.learnt),
               fmt::format("{:.2g}", unit * c.open), std::string(gap::unit_of(c.channel))});
  }
  return fmt::format(
      "the question is what has changed since the {} drives of {}; they taught this difference between model "
      "and drives:\n{}",
      reference.drives, reference.campaign, table.print());
}

std::string next_drives_words(const Diagnosis& d) {
  if (d.verdict == gap::Verdict::kInsufficient) return {};
  const std::vector<gap::NextDrive> offered = api::json::offered_drives(d);
  if (offered.empty()) return "\n" + api::no_drive_offered_words() + "\n";
  std::string out = "\ndrives that would say most:\n";
  for (const gap::NextDrive& n : offered)
    out += fmt::format(
        "  tilt {:.0f} deg, heading {:.0f} deg, {:.3g} m/s, curvature {:.2g} 1/m, motors at {:.0f} C: {:.2f} "
        "bits\n",
        n.tilt_deg, n.heading_deg, n.speed_m_s, n.curvature_1_m, n.motor_temp_c, n.information_bits);
  return out;
}

std::string answer_words(const Diagnosis& d) {
  std::string out = fmt::format("{}: {}\n{}\n", d.campaign, gap::name_of(d.verdict), d.reason);
  if (d.reference) out += reference_words(*d.reference);
  if (!d.overturned_by.empty()) out += fmt::format("would overturn it: {}\n", d.overturned_by);
  out += effects_words(d);
  out += fmt::format("\n{} drives, {} windows, {} observations; explanations compared:\n", d.drives,
                     d.windows, d.observations);
  out += candidates_words(d);
  out += marginals_words(d);
  for (const gap::ConfusablePair& pair : d.confusable)
    out +=
        fmt::format("alike on these drives: {} and {} ({:.0f} deg apart)\n", pair.a, pair.b, pair.angle_deg);
  out += "\nwhere, before any re-tuning (measured less predicted):\n" + channels_words(d);
  if (!d.regimes.empty()) out += "the gap is\n" + regimes_words(d.regimes);
  if (!d.channels_of_effects.empty()) out += channels_of_effects_words(d);
  if (!d.regimes_of_effect.empty()) out += "what the effect does is\n" + regimes_words(d.regimes_of_effect);
  if (!d.gap.empty())
    out += "\nhow far, rms on drives held out of the fit (90 % intervals):\n" + ladder_words(d);
  if (d.closed_fraction)
    out += fmt::format("of the gap that re-tuning leaves, closed: {}\n", interval_words(*d.closed_fraction));
  out += residual_words(d);
  if (!d.least_detectable.empty()) out += "\nsmallest effects that would have been seen:\n";
  for (std::size_t i = 0; i < std::min(d.least_detectable.size(), kMaxLeast); ++i)
    out += fmt::format("  {} {} = {:.3g}\n", d.least_detectable[i].effect, d.least_detectable[i].parameter,
                       d.least_detectable[i].value);
  out += next_drives_words(d);
  for (const std::string& note : d.notes) out += "note: " + note + "\n";
  return out;
}

std::vector<OutputFile> report_files(const std::string& path, const gap::DriveCampaign& campaign,
                                     const Diagnosis& d) {
  const std::vector<api::NamedChart> charts = api::draw_diagnosis(campaign, d);
  return report_output(path, api::diagnosis_report(campaign, d, charts), charts, "diagnosis.json",
                       api::json::diagnosis_document(campaign, d));
}

// The files of the corrected model; none where none is offered.
std::vector<OutputFile> model_files(const std::string& folder, const gap::DriveCampaign& campaign,
                                    const Diagnosis& d) {
  const auto model = api::corrected_model(campaign, d);
  if (!model) return {};
  // As a data folder has them: a rover's file is called as the rover. The description is last: without it the
  // folder holds no model.
  const std::filesystem::path path(folder);
  return {
      {(path / "rovers" / (model->rover.name + ".json")).string(), api::json::rover_document(*model)},
      {(path / "soils" / (model->soils.front().name + ".json")).string(), api::json::soils_document(*model)},
      {(path / "model.json").string(), api::model_document(campaign, *model)}};
}

// Makes the folder ready for the new model: that of an earlier diagnosis is taken out, so that nobody plans
// with it for the new one, whether one is offered now or not.
Result<void> clear_model(const std::string& folder, bool is_offered) {
  const auto removed = api::remove_model(folder);
  if (!removed) return fail(removed.error());
  if (*removed) std::cerr << fmt::format("the model of campaign {} was taken out of {}\n", **removed, folder);
  if (!is_offered) {
    std::cerr << "no corrected model is offered: nothing is written\n";
    return {};
  }
  for (const char* part : {"rovers", "soils"})
    if (auto made = api::make_folder(std::filesystem::path(folder) / part); !made) return made;
  return {};
}

}  // namespace

gap::DiagnosisOptions DriveQuestion::search() const {
  gap::DiagnosisOptions options;
  options.search.withheld = without;
  options.search.threads = static_cast<std::size_t>(threads);
  options.seed = seed;
  return options;
}

Result<AskedDrives> load_drives(const DriveQuestion& question) {
  const auto catalogue = open_catalogue(question.data);
  if (!catalogue) return fail(catalogue.error());
  const auto load = [&](const std::string& named) {
    return api::load_drive_campaign(campaign_folder(named, question.data), *catalogue);
  };
  auto campaign = load(question.campaign);
  if (!campaign) return fail(campaign.error());
  AskedDrives drives{*std::move(campaign), std::nullopt};
  if (question.reference.empty()) return drives;
  auto reference = load(question.reference);
  if (!reference) return fail(reference.error());
  drives.reference = *std::move(reference);
  return drives;
}

int diagnose(const DiagnoseCommand& options) {
  const auto drives = load_drives(options);
  if (!drives) return refuse_unreadable(drives.error());
  const auto& [campaign, reference] = *drives;
  // What can't be written is known before the work.
  if (!options.report.empty())
    if (const auto made = make_room_for_report(options.report); !made) return refuse(made.error());
  std::optional<Result<Diagnosis>> result;
  {
    TerminalProgress progress;
    result = reference ? gap::diagnose_since(*reference, campaign, options.search(), progress)
                       : gap::diagnose(campaign, options.search(), progress);
  }
  if (!*result) return refuse(result->error());
  const Diagnosis& d = **result;
  // A folder that can't be written is no reason to throw the diagnosis away: it is printed all the same.
  int status = 0;
  std::vector<OutputFile> files;
  const auto add = [&](const Result<void>& folder, const std::vector<OutputFile>& into_it) {
    if (!folder) status = refuse(folder.error());
    if (folder) files.insert(files.end(), into_it.begin(), into_it.end());
  };
  if (!options.report.empty())
    add(make_room_for_report(options.report), report_files(options.report, campaign, d));
  if (!options.model.empty()) {
    const std::vector<OutputFile> model = model_files(options.model, campaign, d);
    add(clear_model(options.model, !model.empty()), model);
  }
  return std::max(
      status, deliver(files, options.json ? api::json::diagnosis_document(campaign, d) : answer_words(d)));
}

namespace {

// How the search is run, and how its answer is printed.
void add_search(CLI::App& command, DriveQuestion& question) {
  command.add_option("--seed", question.seed, "the same seed gives the same answer")
      ->capture_default_str()
      ->check(CLI::Range(std::uint64_t{0}, kMaxExactWhole));
  command.add_option("--threads", question.threads, "at once; 0: as many as the machine has")
      ->capture_default_str()
      ->check(CLI::Range(0, 1024));
  command.add_flag("--json", question.json, "print the document, for machines");
}

}  // namespace

void add_diagnose_command(CLI::App& app, std::function<int()>& run) {
  const auto options = std::make_shared<DiagnoseCommand>();
  CLI::App* command = app.add_subcommand(
      "diagnose",
      "where prediction and recorded drives part, which effect is missing, how far the gap closes");
  command
      ->add_option("campaign", options->campaign, "folder of a drive campaign, or the name of a shipped one")
      ->required();
  add_data_option(*command, options->data, "rovers and soils");
  command->add_option(
      "--reference", options->reference,
      "folder of drives of the same rover that are taken as healthy: the question is then what "
      "has changed since");
  command->add_option("--without", options->without, "an effect that is not looked for, see slipway effects");
  add_search(*command, *options);
  command->add_option(
      "--report", options->report,
      "folder for report.html, report.md, its pictures and diagnosis.json, made if need be; or "
      "a file that ends in .html for the page alone");
  command->add_option(
      "--model", options->model,
      "folder for rovers/*.json and soils/*.json of the corrected model, where one is offered: put into a "
      "data folder they are planned with");
  command->footer(
      "Example: what do these drives show that the simulator lacks?\n"
      "  slipway diagnose data/gap-practice/p05 --report p05\n"
      "Example: what has changed since these drives were made?\n"
      "  slipway diagnose sols-20-30 --reference sols-1-19\n"
      "Exit status: 0 a diagnosis, whatever its verdict, 1 none, 2 input that can't be read, with every "
      "fault.");
  command->callback([options, &run] { run = [options] { return diagnose(*options); }; });
}

void add_watch_command(CLI::App& app, std::function<int()>& run) {
  const auto options = std::make_shared<WatchCommand>();
  CLI::App* command = app.add_subcommand(
      "watch",
      "whether drives, in their order, still are what healthy ones were: since when, and what changed");
  command
      ->add_option("campaign", options->campaign,
                   "folder of a drive campaign, its drives in their order, or the name of a shipped one; or "
                   "a table of measured steps (*.csv)")
      ->required();
  command->add_option("--rover", options->rover, "rover that made the steps of a table")
      ->capture_default_str();
  add_data_option(*command, options->data, "rovers and soils");
  CLI::Option* const reference = command->add_option(
      "--reference", options->reference, "folder of drives of the same rover that are taken as healthy");
  command
      ->add_option("--learn", options->learn,
                   "without a reference: so many of the campaign's first drives are taken as healthy")
      ->capture_default_str()
      ->check(CLI::Range(gap::kFewestLearnt, gap::kMostLearnt))
      ->excludes(reference);
  command
      ->add_option("--alpha", options->alpha,
                   "chance of an alarm while nothing changes, however long one watches")
      ->capture_default_str()
      ->check(CLI::Range(1e-9, 0.5));
  command->add_option("--without", options->without, "an effect that is not looked for, see slipway effects");
  command->add_flag("!--no-diagnosis", options->diagnose, "after an alarm, do not diagnose what has changed");
  add_search(*command, *options);
  command->add_option("--report", options->report,
                      "folder for report.html, report.md, its pictures and watch.json, made if need be; or a "
                      "file that ends in .html for the page alone");
  command->footer(
      "Example: is the rover still what it was in its first twelve drives?\n"
      "  slipway watch data/gap-practice/p01 --report p01.html\n"
      "Exit status: 0 nothing has changed, 6 something has, 1 no answer, 2 input that can't be read.");
  command->callback([options, &run] { run = [options] { return watch(*options); }; });
}

}  // namespace slipway::server
