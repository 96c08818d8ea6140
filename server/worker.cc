#include <fmt/format.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/signalfd.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <filesystem>
#include <iostream>
#include <memory>
#include <utility>

#include "api/job_kinds.h"
#include "api/jobs/artefact_job_store.h"
#include "api/jobs/job_runner.h"
#include "api/jobs/open_job_store.h"
#include "api/service.h"
#include "core/file_descriptor.h"
#include "core/process_limits.h"
#include "server/cli/commands/serve_command.h"
#include "server/cli/inquiry/command_parts.h"
#include "server/cli/inquiry/data_folder.h"
#include "server/cli/inquiry/exit_status.h"
#include "server/signals.h"

namespace slipway::server {
namespace {

using std::chrono::milliseconds;

std::optional<Error> fault_of(const WorkerOptions& options) {
  std::vector<Fault> faults;
  for (const std::string& kind : options.kinds)
    if (api::find_kind(api::job_kinds(), kind) == nullptr)
      faults.push_back({"/kind", fmt::format("\"{}\" is no kind of job", kind)});
  if (options.jobs.empty())
    faults.push_back({"/jobs", "a worker needs a store that it shares with a service: a file or a database"});
  if (faults.empty()) return std::nullopt;
  return Error{ErrorCode::kInvalidRequest, "the worker can't be started so", std::move(faults)};
}

// Who polls is answered first, however many jobs run.
void step_back() {
  constexpr int kNiceness = 10;
  static_cast<void>(::setpriority(PRIO_PROCESS, 0, kNiceness));
}

void ring_at_the_output() {
  static_cast<void>(::write(STDOUT_FILENO, "\n", 1));  // full: it rings already
}

// Whether no job of these kinds waits or is worked on by anybody.
bool is_empty(api::JobStore& store, const std::vector<std::string>& kinds) {
  const auto counts = store.counts();
  return counts && std::none_of(counts->begin(), counts->end(), [&](const api::JobCount& count) {
           const bool mine =
               kinds.empty() || std::find(kinds.begin(), kinds.end(), count.kind) != kinds.end();
           return mine && !api::has_ended(count.state) && count.count > 0;
         });
}

// Until a signal, or with a bell the end of the standard input, says that it is enough, or nothing is left
// where that is the end. False: the work has
// given no sign of life for so long that it never will.
bool wait_for_the_end(api::JobRunner& runner, const FileDescriptor& signals, const WorkerOptions& options,
                      milliseconds patience) {
  for (;;) {
    std::array<pollfd, 2> polled{{{signals.fd(), POLLIN, 0}, {options.bell ? STDIN_FILENO : -1, POLLIN, 0}}};
    constexpr int kLook_ms = 1000;
    ::poll(polled.data(), polled.size(), kLook_ms);
    if (polled[0].revents != 0) return true;
    if (polled[1].revents != 0) {
      std::array<char, 256> rings{};
      if (::read(STDIN_FILENO, rings.data(), rings.size()) <= 0) return true;
      runner.ring();
    }
    if (runner.longest_silence() > patience) return false;
    if (options.until_empty && runner.running() == 0 && is_empty(runner.store(), options.kinds)) return true;
  }
}

}  // namespace

Result<std::unique_ptr<api::JobStore>> open_store(const std::string& jobs, const ArtefactPlace& artefacts,
                                                  api::StoreCheck how_far) {
  auto store = api::open_job_store(jobs, how_far);
  if (!store || jobs.empty()) return store;
  if (artefacts.folder.empty()) return api::with_artefacts(*std::move(store), nullptr);
  auto folder = api::ArtefactFolder::open(
      artefacts.folder,
      {.folder = artefacts.cache, .max_bytes = static_cast<std::int64_t>(1e6 * artefacts.cache_mb)});
  if (!folder) return fail(folder.error());
  return api::with_artefacts(*std::move(store), *std::move(folder));
}

int work(const WorkerOptions& given) {
  WorkerOptions options = given;
  const auto place = api::without_secrets(given.jobs);
  if (!place) return refuse(place.error());
  options.jobs = *place;
  const sigset_t ending = block_signals({SIGINT, SIGTERM});
  std::signal(SIGHUP, SIG_IGN);  // it has nothing to read again
  const FileDescriptor signals(::signalfd(-1, &ending, SFD_CLOEXEC));
  if (const auto fault = fault_of(options)) return refuse(*fault);
  const auto data = data_folder(options.data);
  if (!data) return refuse(data.error());
  // What is asked for beyond it is refused to the work, which fails with a reason.
  if (options.of_job.memory_mb > 0.0) limit_memory(1e6 * options.of_job.memory_mb);
  leave_no_core();
  step_back();
  std::shared_ptr<api::UploadFolder> uploads;
  if (const std::string folder = options.uploads.folder(options.jobs); !folder.empty()) {
    auto opened = api::UploadFolder::open(folder, {.max_total_bytes = options.uploads.max_bytes()});
    if (!opened) return refuse(opened.error());
    uploads = *std::move(opened);
  }
  const auto service = api::Service::open({.data = *data, .uploads = uploads});
  if (!service) return refuse(service.error());
  auto store = open_store(options.jobs, options.artefacts, api::StoreCheck::kSchema);
  if (!store) return refuse(store.error());
  api::JobRunnerOptions how;
  how.workers = {options.kinds};
  how.worker = options.name.empty() ? "worker " + api::new_job_id() : options.name;
  how.max_time = options.of_job.max_time();
  how.kept = std::nullopt;
  how.lease = options.lease.time();
  if (api::is_database(options.jobs)) how.progress_interval = milliseconds(1000);  // many share it
  const milliseconds lease = how.lease;
  api::JobRunner runner(std::move(*store), api::service_work(**service), how,
                        api::service_work_in_parts(**service));
  if (options.bell) runner.on_change(ring_at_the_output);
  if (const auto started = runner.start(); !started) return refuse(started.error());
  if (options.bell) ring_at_the_output();  // it has started
  if (!wait_for_the_end(runner, signals, options, lease)) {
    // Its thread can't be stopped, but its process can: the lease ends, and another attempt is made.
    std::cerr << fmt::format("the work gave no sign of life for {} s: this worker ends\n",
                             lease.count() / 1000);
    ::_exit(kFailed);
  }
  runner.stop();
  return kDone;
}

int print_jobs(const JobsOptions& options) {
  const auto place = api::without_secrets(options.jobs);
  if (!place) return refuse(place.error());
  if (place->empty() || (!api::is_database(*place) && !std::filesystem::exists(*place)))
    return refuse(
        {ErrorCode::kInvalidRequest, "there is no job store", {{"/jobs", "names none that is there"}}});
  const auto store = api::open_job_store(*place, api::StoreCheck::kSchema);
  if (!store) return refuse(store.error());
  const auto counts = (*store)->counts();
  if (!counts) return refuse(counts.error());
  std::int64_t open = 0;
  for (const api::JobCount& count : *counts) {
    if (!api::has_ended(count.state)) open += count.count;
    if (!options.open)
      std::cout << fmt::format("{:16} {:10} {:8}\n", count.kind, api::describe(count.state), count.count);
  }
  if (options.open) std::cout << open << "\n";
  return kDone;
}

}  // namespace slipway::server
