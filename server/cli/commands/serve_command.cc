#include "server/cli/commands/serve_command.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "api/files/terrain_site.h"
#include "api/json/toml_parse.h"
#include "server/cli/inquiry/command_parts.h"
#include "server/cli/inquiry/data_option.h"

namespace slipway::server {
namespace {

using api::json::JsonValue;

void add_job_limits(CLI::App& command, JobLimits& limits) {
  command.add_option("--job-memory-mb", limits.memory_mb, "memory of one worker process in MB; 0: no limit")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 1e9));
  command.add_option("--job-minutes", limits.minutes, "minutes that one attempt at a job may take")
      ->capture_default_str()
      ->check(CLI::Range(0.01, 1e6));
}

void add_store(CLI::App& command, std::string& jobs, LeaseOption& lease, const char* when_empty) {
  command
      .add_option("--jobs", jobs,
                  fmt::format("SQLite file of the jobs, or the PostgreSQL database "
                              "postgresql://USER@HOST:PORT/DATABASE that several machines share{}",
                              when_empty))
      ->capture_default_str();
  command
      .add_option("--lease-s", lease.seconds,
                  "seconds for which a worker may be silent before its job is given to another")
      ->capture_default_str()
      ->check(CLI::Range(1.0, 3600.0));
}

void add_artefact_place(CLI::App& command, ArtefactPlace& place) {
  command.add_option(
      "--artefacts", place.folder,
      "folder that all machines share for the large files of jobs; without it they are kept with "
      "the jobs");
  command.add_option(
      "--artefact-cache", place.cache,
      "folder of this machine for copies of what it has read there; without it there are none");
  command.add_option("--artefact-cache-mb", place.cache_mb, "megabytes of those copies at most")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 1e9));
}

void add_upload_place(CLI::App& command, UploadPlace& place) {
  command.add_option("--uploads", place.given,
                     "folder of maps and drives that clients send, else the folder uploads beside the file "
                     "of the jobs; \"\" "
                     "takes none, nor does a service with its jobs in memory");
  command.add_option("--keep-uploads-mb", place.keep_mb, "megabytes of that folder at most")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 1e9));
}

// A value of the file in the words of a flag.
std::vector<std::string> words_of(const JsonValue& value) {
  if (value.is(JsonValue::Kind::kString)) return {value.text};
  if (value.is(JsonValue::Kind::kBoolean)) return {value.boolean ? "true" : "false"};
  if (value.is(JsonValue::Kind::kNumber)) return {fmt::format("{}", value.number)};
  std::vector<std::string> words;
  for (const JsonValue& element : value.elements)
    for (std::string& word : words_of(element)) words.push_back(std::move(word));
  return words;
}

// Sets the options that the command line does not give. Throws CLI::ValidationError with every fault.
void take_settings(CLI::App& command, const std::string& path) {
  const auto bytes = api::read_data_file(path);
  if (!bytes) throw CLI::ValidationError("--config", in_one_line(bytes.error()));
  const auto document = api::json::parse_toml(*bytes, path);
  if (!document) throw CLI::ValidationError("--config", in_one_line(document.error()));
  std::string faults;
  const auto fault = [&](const std::string& what) { faults += (faults.empty() ? "" : "; ") + what; };
  for (std::size_t k = 0; k < document->keys.size(); ++k) {
    const std::string& name = document->keys[k];
    CLI::Option* const option = command.get_option_no_throw("--" + name);
    if (option == nullptr || name == "config" || name == "help") {
      fault(fmt::format("{} has {}, which is no option of {}", path, name, command.get_name()));
      continue;
    }
    if (option->count() > 0) continue;
    try {
      option->add_result(words_of(document->elements[k]));
      option->run_callback();
    } catch (const CLI::Error& wrong) {
      fault(fmt::format("{}: {}", path, wrong.what()));
    }
  }
  if (!faults.empty()) throw CLI::ValidationError("--config", faults);
}

void add_settings(CLI::App& command, std::string& path) {
  command.add_option("--config", path,
                     "TOML file with any of these options by name, as in port = 8080; flags go before it");
}

void add_worker_command(CLI::App& app, std::function<int()>& run) {
  const auto options = std::make_shared<WorkerOptions>();
  CLI::App* command = app.add_subcommand("worker", "work on the jobs of a store until interrupted");
  add_data_option(*command, options->data, "rovers, soils and terrains");
  add_store(*command, options->jobs, options->lease, "");
  add_upload_place(*command, options->uploads);
  add_artefact_place(*command, options->artefacts);
  command->add_option("--kind", options->kinds, "work on jobs of this kind only; may be repeated")
      ->allow_extra_args(false);
  command->add_option("--name", options->name,
                      "name under which jobs are claimed; no two workers may share one");
  add_job_limits(*command, options->of_job);
  command->add_flag("--until-empty", options->until_empty,
                    "end when no job of these kinds waits or is worked on, as a pilot in a cluster does");
  command->add_flag(
      "--bell", options->bell,
      "the standard input rings for new work, the standard output after each job; the worker ends "
      "with the former");
  const auto settings = std::make_shared<std::string>();
  add_settings(*command, *settings);
  command->footer(
      "\"slipway serve\" starts workers of its own. Examples of one more, beside them and on another "
      "machine:\n"
      "  slipway worker --jobs var/jobs.sqlite --kind plan\n"
      "  slipway worker --jobs postgresql://slipway@db/slipway --until-empty");
  command->callback([options, settings, command, &run] {
    if (!settings->empty()) take_settings(*command, *settings);
    run = [options] { return work(*options); };
  });
}

void add_jobs_command(CLI::App& app, std::function<int()>& run) {
  const auto options = std::make_shared<JobsOptions>();
  CLI::App* command = app.add_subcommand("jobs", "how many jobs of each kind and state a store holds");
  command->add_option("--jobs", options->jobs, "SQLite file or PostgreSQL database of the jobs")
      ->capture_default_str();
  command->add_flag("--open", options->open, "print only how many wait or are worked on");
  command->footer("Example:\n  slipway jobs --jobs postgresql://slipway@db/slipway");
  command->callback([options, &run] { run = [options] { return print_jobs(*options); }; });
}

void add_token_command(CLI::App& app, std::function<int()>& run) {
  struct Wanted {
    std::string name, role = "operator";
  };
  const auto wanted = std::make_shared<Wanted>();
  CLI::App* command =
      app.add_subcommand("token", "make a token, and what stands for it in the service's file");
  command->add_option("name", wanted->name, "who is to hold it")->required();
  command->add_option("--role", wanted->role, "viewer, operator or admin")->capture_default_str();
  command->footer("Example:\n  slipway token dashboard --role viewer");
  command->callback(
      [wanted, &run] { run = [wanted] { return print_new_token(wanted->name, wanted->role); }; });
}

}  // namespace

void add_serve_command(CLI::App& app, std::function<int()>& run) {
  const auto options = std::make_shared<ServeOptions>();
  CLI::App* command = app.add_subcommand("serve", "answer over HTTP until interrupted");
  add_data_option(*command, options->data, "rovers, soils and terrains");
  command->add_option("--address", options->address, "address to listen on")->capture_default_str();
  command->add_option("--port", options->port, "port; 0 takes a free one")
      ->capture_default_str()
      ->check(CLI::Range(0, 65535));
  add_store(*command, options->jobs, options->lease, "; \"\" keeps them in memory");
  command->add_flag("--no-workers", options->no_workers,
                    "start no workers: others, on this machine or elsewhere, work on the store");
  add_upload_place(*command, options->uploads);
  add_artefact_place(*command, options->artefacts);
  command->add_option("--upload-mb", options->upload_mb, "megabytes of one file that is sent")
      ->capture_default_str()
      ->check(CLI::Range(0.001, 1e6));
  command->add_option("--keep-jobs", options->keep_jobs, "ended jobs that are kept at most")
      ->capture_default_str()
      ->check(CLI::Range(0, 10'000'000));
  command->add_option("--keep-days", options->keep_days, "days for which ended jobs are kept at most")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 36500.0));
  command
      ->add_option("--keep-mb", options->keep_mb, "megabytes of requests and answers of ended jobs at most")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 1e7));
  command->add_option("--max-connections", options->max_connections, "connections at once")
      ->capture_default_str()
      ->check(CLI::Range(1, 1'000'000));
  command
      ->add_option("--max-connections-per-address", options->max_connections_per_address,
                   "connections of one address at once; 0: no limit, for a server behind a reverse proxy")
      ->capture_default_str()
      ->check(CLI::Range(0, 1'000'000));
  command
      ->add_option("--allow-host", options->allowed_hosts,
                   "answer under this name too, beside localhost and addresses as numbers; may be repeated")
      ->allow_extra_args(false);
  command
      ->add_option("--allow-origin", options->allowed_origins,
                   "let web pages of this origin, https://HOST[:PORT], read the answers; may be repeated")
      ->allow_extra_args(false);
  command->add_option("--most-jobs", options->most_jobs, "jobs that wait or run at once")
      ->capture_default_str()
      ->check(CLI::Range(1, 1'000'000));
  command->add_option("--most-jobs-per-address", options->most_jobs_per_address, "of one client's address")
      ->capture_default_str()
      ->check(CLI::Range(1, 1'000'000));
  add_job_limits(*command, options->of_job);
  command->add_option("--tokens", options->tokens,
                      "TOML file of the tokens that may ask, see \"slipway token\"; SIGHUP reads it again");
  command->add_flag(
      "--no-tokens", options->no_tokens,
      "let who reaches an address beyond loopback ask without a token, behind a proxy that knows them");
  command
      ->add_option(
          "--override-persons", options->override_persons,
          "persons whom the override of a check takes: 2, one who asks and another who confirms, or 1")
      ->capture_default_str()
      ->check(CLI::Range(1, 2));
  command->add_option("--audit", options->audit,
                      "append every request that changes something to this file, as JSON");
  command
      ->add_option("--requests-per-s", options->requests_per_s,
                   "requests of one token, or of one address without tokens, in a second; 0: any number")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 1e6));
  command->add_flag("--log-json", options->log_json,
                    "write events to standard error as JSON, an object a line");
  command->add_flag("--access-log", options->access_log, "write every request as an event");
  const auto settings = std::make_shared<std::string>();
  add_settings(*command, *settings);
  command->footer("Example:\n  slipway serve --port 8080\n  curl http://127.0.0.1:8080/v1/terrains");
  command->callback([options, settings, command, &run] {
    if (!settings->empty()) take_settings(*command, *settings);
    run = [options] { return serve(*options); };
  });
  add_worker_command(app, run);
  add_jobs_command(app, run);
  add_token_command(app, run);
}

}  // namespace slipway::server
