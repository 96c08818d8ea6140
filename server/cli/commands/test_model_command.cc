#include "server/cli/commands/test_model_command.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "api/documents/diagnosis/model_check_document.h"
#include "api/files/campaign/drive_campaign_source.h"
#include "api/files/catalogue.h"
#include "api/requests/model_check.h"
#include "core/largest_exact_whole.h"
#include "server/cli/inquiry/command_parts.h"
#include "server/cli/inquiry/data_folder.h"
#include "server/cli/inquiry/data_option.h"
#include "server/cli/terminal/terminal_progress.h"
#include "server/cli/terminal/text_table.h"

namespace slipway::server {
namespace {

std::string down_words(const gap::ErrorChange& change) {
  if (!change.down_interval) return fmt::format("{:.0f} %", change.down_percent);
  return fmt::format("{:.0f} % ({:.0f} to {:.0f})", change.down_percent, change.down_interval->low,
                     change.down_interval->high);
}

std::string answer_words(const api::ModelCheckAnswer& answer) {
  std::string out =
      fmt::format("{} as predicted with {} on {}, corrected with campaign {}: {} drives, {} windows\n",
                  answer.campaign, answer.rover, fmt::join(answer.soils, ", "), answer.corrected_with,
                  answer.check.drives, answer.check.windows);
  TextTable table({"channel", "slope", "values", "drives", "rms, nominal", "corrected", "down",
                   "median, nominal", "corrected", "down", "in 50 %", "in 90 %", "unit"});
  for (const gap::ChannelCheck& c : answer.check.channels) {
    const double unit = gap::boundary_unit(c.channel);
    table.add({std::string(gap::name_of(c.channel)), std::string(gap::name_of(c.slope)),
               fmt::format("{}", c.values), fmt::format("{}", c.drives),
               fmt::format("{:.3g}", unit * c.rms.nominal), fmt::format("{:.3g}", unit * c.rms.corrected),
               down_words(c.rms), fmt::format("{:.3g}", unit * c.median.nominal),
               fmt::format("{:.3g}", unit * c.median.corrected), down_words(c.median),
               fmt::format("{:.0f} %", 100.0 * c.within_50), fmt::format("{:.0f} %", 100.0 * c.within_90),
               std::string(gap::unit_of(c.channel))});
  }
  out += table.print();
  out += fmt::format("slopes are along the travel, level within {:g} deg; intervals of \"down\" hold 90 %\n",
                     gap::kLevelWithin_deg);
  for (const std::string& note : answer.notes) out += "note: " + note + "\n";
  return out;
}

}  // namespace

int test_model(const TestModelCommand& options) {
  const auto catalogue = open_catalogue(options.data);
  if (!catalogue) return refuse_unreadable(catalogue.error());
  const auto campaign = api::load_drive_campaign(campaign_folder(options.campaign, options.data), *catalogue);
  const auto model = api::load_model_folder(options.model);
  // The faults of both are printed, not those of the first alone.
  const int unread = campaign ? 0 : refuse_unreadable(campaign.error());
  if (!model) return refuse_unreadable(model.error());
  if (unread != 0) return unread;
  gap::ModelCheckOptions how;
  how.threads = static_cast<std::size_t>(options.threads);
  how.seed = options.seed;
  std::optional<Result<api::ModelCheckAnswer>> answer;
  {
    TerminalProgress progress;
    answer = api::check_model(*campaign, *model, options.ground, how, progress);
  }
  if (!*answer) return refuse(answer->error());
  return deliver({}, options.json ? api::json::model_check_document(**answer) : answer_words(**answer));
}

void add_test_model_command(CLI::App& app, std::function<int()>& run) {
  const auto options = std::make_shared<TestModelCommand>();
  CLI::App* command = app.add_subcommand(
      "test-model", "how well a corrected model predicts the drives of a campaign that it was not made of");
  command
      ->add_option("campaign", options->campaign, "folder of a drive campaign, or the name of a shipped one")
      ->required();
  command
      ->add_option("--model", options->model,
                   "folder of a corrected model, as slipway diagnose --model writes it")
      ->required();
  command->add_option(
      "--ground", options->ground,
      "a soil of this campaign that is the model's, where the other campaign called it otherwise");
  add_data_option(*command, options->data, "rovers and soils");
  command->add_option("--seed", options->seed, "of the resampling of drives")
      ->capture_default_str()
      ->check(CLI::Range(std::uint64_t{0}, kMaxExactWhole));
  command->add_option("--threads", options->threads, "at once; 0: as many as the machine has")
      ->capture_default_str()
      ->check(CLI::Range(0, 1024));
  command->add_flag("--json", options->json, "print the document, for machines");
  command->footer(
      "Example: does what the drives of one year showed hold in the next?\n"
      "  slipway diagnose year_1 --model corrected\n"
      "  slipway test-model year_2 --model corrected\n"
      "Exit status: 0 whatever the figures, 1 none, 2 input that can't be read, with every fault.");
  command->callback([options, &run] { run = [options] { return test_model(*options); }; });
}

}  // namespace slipway::server
