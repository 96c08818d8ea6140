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
  std::string jobs = "var/jobs.sqlite";      // empty: in memory, lost with the process
  std::vector<std::string> allowed_origins;  // of web pages that may read the answers, "https://HOST:PORT"
};

// Serves until a signal ends it. The exit status: 0 ended by a signal, 1 not started, 2 options with faults.
int serve(const ServeOptions& options);

// Adds the subcommand; `run` then runs it where it is given.
void add_serve_command(CLI::App& app, std::function<int()>& run);

}  // namespace slipway::server
