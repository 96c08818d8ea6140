#include "server/cli/commands/compare_answers_command.h"

#include <CLI/CLI.hpp>
#include <fstream>
#include <iterator>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "api/documents/answer_comparison.h"
#include "server/cli/inquiry/command_parts.h"
#include "server/cli/terminal/tables.h"

namespace slipway::server {
namespace {

struct CompareOptions {
  std::string a, b;         // files
  std::vector<int> routes;  // two ranks, or none
  bool json = false;
};

Result<std::string> whole(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) return fail(ErrorCode::kUnreadableData, "cannot open " + path);
  return std::string(std::istreambuf_iterator<char>(file), {});
}

int compare(const CompareOptions& options) {
  const auto a = whole(options.a), b = whole(options.b);
  if (!a) return refuse_unreadable(a.error());
  if (!b) return refuse_unreadable(b.error());
  std::optional<api::json::ComparedRoutes> routes;
  if (options.routes.size() == 2) routes = {options.routes[0], options.routes[1]};
  const auto comparison = api::json::compare_answers(*a, *b, routes);
  if (!comparison) return refuse(comparison.error());
  const auto printed = options.json ? comparison : answer_comparison_table(*comparison);
  if (!printed) return refuse(printed.error());
  return deliver({}, *printed + (options.json ? "\n" : ""));
}

}  // namespace

void add_compare_answers_command(CLI::App& app, std::function<int()>& run) {
  const auto options = std::make_shared<CompareOptions>();
  CLI::App* command = app.add_subcommand(
      "compare-plans",
      "two plans, checks or predictions side by side, or two routes, with what differs in their requests");
  command->add_option("a", options->a, "file of an answer, as --json prints it")->required();
  command
      ->add_option("b", options->b,
                   "file of another one of the same kind; of two routes of one plan the same file")
      ->required();
  command
      ->add_option("--routes", options->routes,
                   "compare these two, by rank: one of the first file and one of the second")
      ->expected(2);
  command->add_flag("--json", options->json, "print the document, for machines");
  command->footer(
      "Example: what does half the limit of slip cost?\n"
      "  slipway plan --start 8142640,-276640 --goal 8142600,-276645 --json > a.json\n"
      "  slipway plan --start 8142640,-276640 --goal 8142600,-276645 --max-slip 0.2 --json > b.json\n"
      "  slipway compare-plans a.json b.json\n"
      "  slipway compare-plans a.json a.json --routes 1 2\n"
      "Exit status: 0 whatever differs, 1 none, 2 answers that can't be compared, with every fault.");
  command->callback([options, &run] { run = [options] { return compare(*options); }; });
}

}  // namespace slipway::server
