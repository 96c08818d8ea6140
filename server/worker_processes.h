#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/result.h"

namespace slipway::server {

struct WorkerProcessOptions {
  // One command line for each worker, the program first. "{name}" in it becomes the worker's name.
  std::vector<std::vector<std::string>> commands;
  std::string family = "slipway";  // a worker is named "slipway/32 hexadecimal digits", anew at each start
  std::chrono::milliseconds first_pause{100};  // before a worker that died at once is started again; doubles
  std::chrono::milliseconds longest_pause{5000};
  std::chrono::milliseconds patience{10'000};  // with which workers are waited for when all are stopped
};

// Keeps worker processes running: what dies is started again. They and this process ring each other's bells,
// bytes without meaning over their standard input and output: the truth is in the store that they share. A
// worker whose standard input ends gives back its job and ends, so that none outlives this process.
class WorkerProcesses {
 public:
  // `on_bell` is called when a worker has rung; `on_death` with the name of a worker that ended without being
  // asked to, and why, in words for a person. Both from one thread of this object's.
  WorkerProcesses(WorkerProcessOptions options, std::function<void()> on_bell,
                  std::function<void(const std::string& name, const std::string& reason)> on_death);
  ~WorkerProcesses();  // stop()
  WorkerProcesses(const WorkerProcesses&) = delete;
  WorkerProcesses& operator=(const WorkerProcesses&) = delete;

  // Errors: internal, where the system starts no process.
  Result<void> start();
  // Asks the workers to end, and kills those that do not. Idempotent.
  void stop();
  // Rings at every worker. Thread-safe.
  void ring();
  // Why not all workers work: how many do not run or have not rung since they began, as one does that could
  // open its store, and how the last one ended. Nothing where all do.
  std::optional<std::string> shortage() const;

 private:
  class Supervisor;
  std::unique_ptr<Supervisor> supervisor_;
};

}  // namespace slipway::server
