#pragma once

#include <functional>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace slipway::server {

struct ServeOptions {
  std::string data;
  std::string address = "127.0.0.1";
  int port = 8080;
  std::string jobs = "var/jobs.sqlite";  // empty: in memory, lost with the process
  std::vector<std::string>
      allowed_hosts;  // names under which requests may come, beside localhost and addresses
  int max_connections = 4096,
      max_connections_per_address = 2048;    // the latter 0: as many as there are in all
  int keep_jobs = 1000;                      // ended jobs that are kept at most, ...
  double keep_days = 90.0;                   // ... and for how long
  double keep_mb = 4096.0;                   // ... and with how many megabytes of requests and answers
  std::vector<std::string> allowed_origins;  // of web pages that may read the answers, "https://HOST:PORT"
};

// Serves until a signal ends it. The exit status: 0 ended by a signal, 1 not started, 2 options with faults.
int serve(const ServeOptions& options);

// Adds the subcommand; `run` then runs it where it is given.
void add_serve_command(CLI::App& app, std::function<int()>& run);

}  // namespace slipway::server
