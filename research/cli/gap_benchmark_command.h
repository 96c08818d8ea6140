#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace slipway::server {

struct GapBenchmarkCommand {
  std::string data;
  std::string folder;             // of campaigns, with answers.json
  std::string make;               // set of campaigns to make there first; empty: they are there
  std::vector<std::string> only;  // names of campaigns; empty: all
  std::uint64_t seed = 1;
  int threads = 0;                // 0: as many as the machine has
  std::string keep;               // folder for each diagnosis.json; empty: none
  std::string keep_search;        // folder for each search-record.json; empty: none
  std::string replay;             // folder of such records to decide from; empty: diagnose
  std::string csv;                // file for one line a campaign; empty: none
  std::string marginals_csv;      // file for one line a campaign and effect; empty: none
  std::string withheld_csv;       // file for one line an effect withheld; empty: none
  std::string variant = "as-is";  // of the diagnosis: ablations and baselines
  bool without_each = false, oracle = false, json = false;
  bool references = false;     // with the drives in references/NAME taken as healthy
  bool drives_needed = false;  // instead: how many drives a right answer takes
  int random_repeats = 3;      // of that with random drives
};

// The exit status: 0 every campaign has a diagnosis and a score, 1 one has none or the work was interrupted,
// 2 options with faults or a campaign that can't be read.
int gap_benchmark(const GapBenchmarkCommand& options);

// Adds the subcommand; `run` then runs it where it is given.
void add_gap_benchmark_command(CLI::App& app, std::function<int()>& run);

}  // namespace slipway::server
