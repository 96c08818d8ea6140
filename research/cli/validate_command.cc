#include "research/cli/validate_command.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <memory>

#include "api/files/whole_file.h"
#include "research/validation/comparison_catalogue.h"
#include "research/validation/document.h"
#include "research/validation/page.h"
#include "server/cli/inquiry/command_parts.h"
#include "server/cli/inquiry/data_folder.h"
#include "server/cli/inquiry/data_option.h"
#include "server/cli/terminal/tables.h"

namespace slipway::server {
namespace {

using validation::Comparison;
using validation::Outcome;

int print_list() {
  std::size_t wide = 0;
  for (const Comparison& c : validation::comparison_catalogue()) wide = std::max(wide, c.name.size());
  std::string list;
  for (const Comparison& c : validation::comparison_catalogue())
    list += fmt::format("{:{}}  {} ({})\n", c.name, wide, c.summary, c.source);
  return deliver({}, list);
}

// The comparisons that are asked for, in the catalogue's order; a name that is none is refused.
Result<std::vector<const Comparison*>> chosen(const std::vector<std::string>& only) {
  std::vector<std::string> known;
  std::vector<const Comparison*> comparisons;
  for (const Comparison& c : validation::comparison_catalogue()) {
    known.emplace_back(c.name);
    if (only.empty() || std::find(only.begin(), only.end(), c.name) != only.end()) comparisons.push_back(&c);
  }
  std::vector<Fault> faults;
  for (const std::string& name : only)
    if (validation::find_comparison(name) == nullptr)
      faults.push_back({"", fmt::format("{} is no comparison; there are {}", name, fmt::join(known, ", "))});
  if (!faults.empty())
    return fail(ErrorCode::kInvalidRequest, "an unknown comparison was asked for", std::move(faults));
  return comparisons;
}

Result<void> write_plot(const std::filesystem::path& folder, const Outcome& outcome) {
  if (outcome.report.plot.empty()) return {};
  if (const auto made = api::make_folder(folder); !made) return made;
  return api::write_whole_file(folder / fmt::format("{}.svg", outcome.comparison->name), outcome.report.plot);
}

}  // namespace

Result<bool> settle_page(const std::string& write, const std::string& check, const std::string& printed,
                         const std::string& command) {
  if (!write.empty()) return validation::write_page(write, printed).map([] { return true; });
  if (check.empty()) return true;
  const auto holds = validation::page_holds(check, printed);
  if (holds && !*holds)
    std::cerr << fmt::format(
        "{0} does not hold what was just measured; look at the difference, then: {1} --write {0}\n", check,
        command);
  return holds;
}

int validate(const ValidateOptions& options) {
  if (options.list) return print_list();
  const auto comparisons = chosen(options.only);
  if (!comparisons) return refuse(comparisons.error());
  const auto data = data_folder(options.data);
  if (!data) return refuse(data.error());
  std::vector<Outcome> outcomes;
  std::string printed;
  bool holds = true;
  for (const Comparison* comparison : *comparisons) {
    if (given_up()) return refuse({ErrorCode::kCancelled, "given up between two comparisons", {}});
    std::cerr << fmt::format("[{}/{}] {}: {}\n", outcomes.size() + 1, comparisons->size(), comparison->name,
                             comparison->summary);
    auto report = comparison->run(*data);
    if (!report) return refuse(report.error());
    for (const validation::StatedBand& band : report->bands)
      if (!band.holds())
        std::cerr << fmt::format("a stated band does not hold: {}: {} is {:g}, must be in [{:g}, {:g}]\n",
                                 comparison->name, band.what, band.value, band.lowest, band.highest);
    holds = holds && report->holds();
    printed += report->markdown();
    outcomes.push_back({comparison, std::move(*report)});
    if (options.plots.empty()) continue;
    if (const auto written = write_plot(options.plots, outcomes.back()); !written)
      return refuse(written.error());
  }
  const auto page = settle_page(options.write, options.check, printed, "slipway validate");
  deliver({}, options.json ? validation::document_of(outcomes) + "\n" : printed);
  if (!page) return refuse(page.error());
  return holds && *page ? 0 : 1;
}

void add_validate_command(CLI::App& app, std::function<int()>& run) {
  const auto options = std::make_shared<ValidateOptions>();
  CLI::App* command =
      app.add_subcommand("validate", "compare with published and measured data, and say how far off");
  add_data_option(*command, options->data, "rovers, soils, terrains and validation data");
  CLI::Option* only =
      command->add_option("--only", options->only, "names of comparisons, see --list; all where not given");
  command->add_option("--plots", options->plots, "write one SVG per comparison into this folder");
  CLI::Option* check = command->add_option("--check", options->check,
                                           "also fail where this page does not hold what is printed");
  CLI::Option* write = command->add_option("--write", options->write, "put what is printed into this page");
  check->excludes(write)->excludes(only);
  write->excludes(only);
  command->add_flag("--json", options->json, "print the whole document, for machines");
  command->add_flag("--list", options->list, "what comparisons there are");
  command->footer(
      "Example: every comparison, with its pictures\n"
      "  slipway validate --plots plots\n"
      "Exit status: 0 every stated band holds, 1 one does not.");
  command->callback([options, &run] { run = [options] { return validate(*options); }; });
}

}  // namespace slipway::server
