#include "server/cli/worlds_command.h"

#include <fmt/format.h>

#include <filesystem>
#include <iostream>
#include <utility>
#include <vector>

#include "api/files/whole_file.h"
#include "server/cli/command_parts.h"
#include "server/cli/validate_command.h"
#include "validation/worlds/comparisons.h"

namespace slipway::server {
namespace {

using validation::Report;
using validation::WorldScore;

Result<std::vector<WorldScore>> studied(const WorldsCommand& options) {
  const auto catalogue = open_catalogue(options.data);
  if (!catalogue) return fail(catalogue.error());
  const auto rover = catalogue->rovers.find(options.rover);
  if (rover == catalogue->rovers.end())
    return fail(ErrorCode::kInvalidRequest, "an unknown rover was asked for",
                {{"/rover", fmt::format("the data folder has no rover {}", options.rover)}});
  validation::WorldStudyOptions study = options.study;
  study.threads = static_cast<std::size_t>(options.threads);
  const auto tell = [&](int done) { std::cerr << fmt::format("[{}/{}] worlds\n", done, study.worlds); };
  return validation::study_worlds(study, rover->second, tell, Interruptible());
}

Result<void> write_plots(const std::string& folder, const Report& report) {
  if (folder.empty()) return {};
  if (const auto made = api::make_folder(folder); !made) return made;
  return api::write_whole_file(std::filesystem::path(folder) / "worlds_reliability.svg", report.plot);
}

}  // namespace

int worlds(const WorldsCommand& options) {
  const auto scores =
      options.scores.empty() ? studied(options) : validation::read_world_scores(options.scores);
  if (!scores) return refuse(scores.error());
  const Report reliability = validation::reliability_report(*scores);
  const std::string printed = validation::planners_report(*scores).markdown() +
                              validation::slip_report(*scores).markdown() + reliability.markdown();
  if (const auto written = write_plots(options.plots, reliability); !written) return refuse(written.error());
  const auto page = settle_page(options.write, options.check, printed, "slipway worlds --scores ...");
  std::vector<OutputFile> files;
  if (!options.csv.empty()) files.push_back({options.csv, validation::csv_of(*scores)});
  const int status = deliver(files, printed);
  if (!page) return refuse(page.error());
  return *page ? status : 1;
}

}  // namespace slipway::server
