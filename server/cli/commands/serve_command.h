#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <ratio>
#include <string>
#include <vector>

#include "api/jobs/open_job_store.h"

namespace CLI {
class App;
}

namespace slipway::server {

// What one job may use.
struct JobLimits {
  double memory_mb = 4096.0;  // of its worker process; 0: no limit
  double minutes = 240.0;     // of one attempt

  std::chrono::milliseconds max_time() const {
    return std::chrono::duration_cast<std::chrono::milliseconds>(
        std::chrono::duration<double, std::ratio<60>>(minutes));
  }
};

// How long a worker may be silent before its job is given to another.
struct LeaseOption {
  double seconds = 30.0;

  std::chrono::milliseconds time() const {
    return std::chrono::duration_cast<std::chrono::milliseconds>(std::chrono::duration<double>(seconds));
  }
};

// Where clients' files are.
struct UploadPlace {
  std::optional<std::string> given;  // nothing: beside the file of the jobs; empty: nowhere
  double keep_mb = 65536.0;          // megabytes of it at most

  // Empty where no files are taken.
  std::string folder(const std::string& jobs) const {
    if (jobs.empty()) return {};
    if (api::is_database(jobs)) return given.value_or("");  // on a file system that all its workers share
    return given.value_or((std::filesystem::path(jobs).parent_path() / "uploads").string());
  }
  std::int64_t max_bytes() const { return static_cast<std::int64_t>(1e6 * keep_mb); }
};

// Where large artefacts of jobs are that several machines work on.
struct ArtefactPlace {
  std::string folder;        // that they share; empty: with the jobs
  std::string cache;         // of this machine alone; empty: none
  double cache_mb = 2048.0;  // megabytes of it at most
};

struct ServeOptions {
  std::string data;
  std::string address = "127.0.0.1";
  int port = 8080;
  std::string jobs = "var/jobs.sqlite";  // or a database; empty: in memory, lost with the process
  std::vector<std::string>
      allowed_hosts;  // names under which requests may come, beside localhost and addresses
  int max_connections = 4096,
      max_connections_per_address = 2048;  // the latter 0: as many as there are in all
  UploadPlace uploads = {};
  ArtefactPlace artefacts = {};
  double upload_mb = 4096.0;                 // ... and of one file
  int keep_jobs = 1000;                      // ended jobs that are kept at most, ...
  double keep_days = 90.0;                   // ... and for how long
  double keep_mb = 4096.0;                   // ... and with how many megabytes of requests and answers
  std::vector<std::string> allowed_origins;  // of web pages that may read the answers, "https://HOST:PORT"
  int most_jobs = 64;                        // that wait or run at once, ...
  int most_jobs_per_address = 32;            // ... and of one address
  JobLimits of_job = {};
  LeaseOption lease = {};
  bool no_workers = false;      // others work on the store
  std::string tokens;           // TOML file of who may ask; empty: who reaches the service
  bool no_tokens = false;       // who reaches an address beyond loopback may ask without a token
  int override_persons = 2;     // who ask for and confirm an override; 1: one may do both
  std::string audit;            // file to which requests that change something are appended
  double requests_per_s = 0.0;  // of one token or address; 0: any number
  bool log_json = false;        // events as JSON, one a line
  bool access_log = false;      // every request is an event
};

// A process that works on the jobs of a store, which services on this or other machines fill.
struct WorkerOptions {
  std::string data;
  std::string jobs = "var/jobs.sqlite";
  UploadPlace uploads = {};
  ArtefactPlace artefacts = {};
  std::vector<std::string> kinds;  // of jobs; empty: all
  std::string name;                // under which jobs are claimed; empty: one that no other worker has
  JobLimits of_job = {};
  LeaseOption lease = {};
  bool until_empty = false;  // ends when no job of its kinds waits or is worked on
  bool bell = false;  // bytes at the standard input mean that there may be work; its end ends the worker
};

// The store at the place, with its artefacts where they are to be.
Result<std::unique_ptr<api::JobStore>> open_store(const std::string& jobs, const ArtefactPlace& artefacts,
                                                  api::StoreCheck how_far);

// Serves until a signal ends it. The exit status: 0 ended by a signal, 1 not started, 2 options with faults.
int serve(const ServeOptions& options);

// What a store holds.
struct JobsOptions {
  std::string jobs = "var/jobs.sqlite";
  bool open = false;  // only how many jobs wait or are worked on
};

// Works until a signal ends it, or the bell's end, or, where it is to, until nothing is left. The exit
// status: 0 ended so, 1 not started, or its work gave no sign of life any more, 2 options with faults.
int work(const WorkerOptions& options);

// Prints how many jobs of each kind and state there are. The exit status: 0, 1 the store does not answer, 2
// there is none.
int print_jobs(const JobsOptions& options);

// Prints a new token and what stands in the file of tokens for it. The exit status: 0, 2 options with faults.
int print_new_token(const std::string& name, const std::string& role);

// Adds the subcommands serve, worker, jobs and token; `run` then runs it where it is given.
void add_serve_command(CLI::App& app, std::function<int()>& run);

}  // namespace slipway::server
