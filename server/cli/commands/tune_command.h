#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace slipway::server {

struct TuneCommand {
  std::string data;
  std::string table;                    // a file or a shipped table's name
  std::string measured;                 // a campaign's folder or a survey's CSV
  std::vector<std::string> parameters;  // "soil.n=0.8..1.2", "soil.k_phi=1e5..1e7:log"
  std::vector<std::string> priors;      // "soil.n=1,0.1"
  int coarse = 5, fine = 5;
  std::vector<std::string> drives;  // ids with * and ?; empty: all
  double position_scale_m = 0.1, heading_scale_deg = 5.0;
  bool scales_are_errors = false;
  std::string loss = "none";         // a name of gap::robust_loss_names()
  std::optional<double> loss_scale;  // nothing: the loss's usual one
  double within = 1.5, good_enough = 0.1;
  bool each_tilt = false, sweep_only = false;
  int threads = 0;  // 0: as many as the machine has
  std::string out;  // folder; empty: none
  bool json = false;
};

// The exit status: 0 an answer (also "no safe route"), 1 no answer, 2 a question that can't be asked. The
// answer goes to standard output, problems and progress to standard error.
int tune(const TuneCommand& options);

// Adds the subcommand; `run` then runs it where it is given.
void add_tune_command(CLI::App& app, std::function<int()>& run);

}  // namespace slipway::server
