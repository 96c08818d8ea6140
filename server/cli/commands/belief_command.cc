#include "server/cli/commands/belief_command.h"

#include <fmt/format.h>

#include <cmath>

#include "api/documents/soil/soil_belief_document.h"
#include "api/requests/soil_belief.h"
#include "server/cli/inquiry/command_parts.h"
#include "server/cli/inquiry/data_folder.h"
#include "server/cli/terminal/terminal_progress.h"
#include "server/cli/terminal/text_table.h"

namespace slipway::server {
namespace {

std::string with_std(double mean, double std) {
  return fmt::format("{:.3f} +- {:.3f}", mean, std);
}

std::string interval(const gap::SpreadInterval& of) {
  return fmt::format("{:.3f} ({:.3f} to {:.3f})", of.median, of.low, of.high);
}

std::string correlation_of(const gap::NumbersOfSoil& numbers) {
  return numbers.correlation.rows() < 2 ? std::string("-")
                                        : fmt::format("{:+.2f}", numbers.correlation(1, 0));
}

std::string name_of_number(const gap::SoilBelief& belief, std::size_t k) {
  const std::string name = belief.between[k].name;
  if (belief.between[k].soil == gap::SoilParameter::kFrictionAngle) return "ln tan " + name;
  return belief.logarithm[k] ? "ln " + name : name;
}

// Each tested soil's numbers, and of a soil that was not tested.
std::string soils_table(const gap::SoilBelief& belief) {
  std::vector<std::string> head{"soil", "readings", "variance"};
  for (std::size_t k = 0; k < belief.between.size(); ++k) {
    head.push_back(name_of_number(belief, k) + " alone");
    head.push_back("with the others");
  }
  head.push_back("correlation");
  TextTable table(head);
  for (const gap::TestedSoilBelief& soil : belief.soils) {
    std::vector<std::string> row{soil.name, fmt::format("{}", soil.readings),
                                 fmt::format("{:.2f}", soil.residual_variance)};
    for (Eigen::Index k = 0; k < soil.alone.mean.size(); ++k) {
      row.push_back(with_std(soil.alone.mean[k], soil.alone.std[k]));
      row.push_back(with_std(soil.among.mean[k], soil.among.std[k]));
    }
    row.push_back(correlation_of(soil.among));
    table.add(row);
  }
  std::vector<std::string> next{"one not tested", "-", "-"};
  for (Eigen::Index k = 0; k < belief.all.next.mean.size(); ++k) {
    next.push_back("-");
    next.push_back(with_std(belief.all.next.mean[k], belief.all.next.std[k]));
  }
  next.push_back(correlation_of(belief.all.next));
  table.add(next);
  return table.print();
}

std::string between_table(const gap::SoilBelief& belief) {
  TextTable table({"number", "mean of soils", "spread between soils (90 %)"});
  for (std::size_t k = 0; k < belief.between.size(); ++k) {
    const auto at = static_cast<Eigen::Index>(k);
    table.add({name_of_number(belief, k), with_std(belief.all.mean[at], belief.all.mean_std[at]),
               interval(belief.all.spread[k])});
  }
  return table.print();
}

std::string left_out_table(const gap::SoilBelief& belief) {
  std::vector<std::string> head{"left out"};
  for (std::size_t k = 0; k < belief.between.size(); ++k) {
    head.push_back(name_of_number(belief, k) + " predicted");
    head.push_back("own at");
  }
  head.insert(head.end(), {"readings held", "by the file's own"});
  TextTable table(head);
  for (const gap::TestedSoilBelief& soil : belief.soils) {
    std::vector<std::string> row{soil.name};
    for (std::size_t k = 0; k < belief.between.size(); ++k) {
      const auto at = static_cast<Eigen::Index>(k);
      row.push_back(with_std(soil.left_out.predicted.mean[at], soil.left_out.predicted.std[at]));
      row.push_back(
          fmt::format("{:.0f} %{}", 100.0 * soil.left_out.rank[k], soil.left_out.held(k) ? "" : " missed"));
    }
    const gap::ReadingsHeld& held = soil.left_out.readings;
    row.push_back(fmt::format("{} of {}", held.by_belief, held.all));
    row.push_back(fmt::format("{} of {}", held.by_file, held.all));
    table.add(row);
  }
  return table.print();
}

std::string words_of(const api::SoilBeliefRequest& request, const gap::SoilBelief& belief) {
  std::string out = request.summary + "\n\n" + soils_table(belief) + "\n" + between_table(belief);
  if (belief.between.size() > 1)
    out += fmt::format("correlation of {} and {} between soils: {}\n", belief.between[0].name,
                       belief.between[1].name, interval(belief.all.correlation));
  return out +
         "\neach soil predicted by the others alone, where its own median lies, and its readings in the "
         "90 % interval\n" +
         left_out_table(belief);
}

}  // namespace

int believe(const BeliefCommand& options) {
  const auto folder = data_folder(options.ask.data);
  if (!folder) return refuse(folder.error());
  const auto catalogue = open_catalogue(options.ask.data);
  if (!catalogue) return refuse_unreadable(catalogue.error());
  const auto request = api::json::load_soil_belief_request(options.file, *folder);
  if (!request) return refuse_unreadable(request.error());
  TerminalProgress progress;
  const auto belief = api::believe_soils(*catalogue, *request, progress);
  if (!belief) return refuse(belief.error());
  return deliver({}, options.ask.json ? api::json::soil_belief_document(*request, *belief) + "\n"
                                      : words_of(*request, *belief));
}

}  // namespace slipway::server
