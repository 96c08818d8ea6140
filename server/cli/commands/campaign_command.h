#pragma once

#include <functional>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace slipway::server {

struct CampaignCommand {
  std::string data;
  std::string table;              // a file, a shipped table's name, or "list"
  std::string out;                // folder
  int threads = 0;                // 0: as many as the machine has
  std::vector<std::string> only;  // ids of drives with * and ?; empty: all
  bool start_over = false, dry_run = false, json = false;
};

// The exit status: 0 every drive has an answer, 1 one has none, 2 the table has faults.
int campaign(const CampaignCommand& options);

// Adds the subcommand; `run` then runs it where it is given.
void add_campaign_command(CLI::App& app, std::function<int()>& run);

}  // namespace slipway::server
