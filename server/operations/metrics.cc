#include "server/operations/metrics.h"

#include <dirent.h>
#include <fmt/format.h>
#include <prometheus/counter.h>
#include <prometheus/gauge.h>
#include <prometheus/histogram.h>
#include <prometheus/registry.h>
#include <prometheus/text_serializer.h>
#include <unistd.h>

#include <fstream>
#include <mutex>
#include <set>

#include "core/version.h"

namespace slipway::server {
namespace {

using prometheus::BuildCounter;
using prometheus::BuildGauge;
using prometheus::BuildHistogram;
using prometheus::Counter;
using prometheus::Family;
using prometheus::Gauge;
using prometheus::Histogram;

// From a poll that finds nothing new to a picture of a long drive.
const Histogram::BucketBoundaries kSeconds{0.0005, 0.001, 0.0025, 0.005, 0.01, 0.025, 0.05,
                                           0.1,    0.25,  0.5,    1.0,   5.0,  30.0};

double resident_bytes() {
  std::ifstream statm("/proc/self/statm");
  double pages = 0.0, resident = 0.0;
  statm >> pages >> resident;
  return resident * static_cast<double>(::sysconf(_SC_PAGESIZE));
}

double open_descriptors() {
  DIR* const folder = ::opendir("/proc/self/fd");
  if (folder == nullptr) return 0.0;
  int count = -3;  // ".", "..", and the folder itself
  while (::readdir(folder) != nullptr) ++count;
  ::closedir(folder);
  return count;
}

}  // namespace

struct ServiceMetrics::Families {
  std::mutex mutex;  // one text at a time
  prometheus::Registry registry;
  Family<Counter>& requests = BuildCounter()
                                  .Name("slipway_http_requests_total")
                                  .Help("Requests answered, by route and status")
                                  .Register(registry);
  Family<Histogram>& seconds = BuildHistogram()
                                   .Name("slipway_http_request_duration_seconds")
                                   .Help("Time that handlers took, by route")
                                   .Register(registry);
  Gauge& connections = BuildGauge()
                           .Name("slipway_http_connections")
                           .Help("Connections that are open")
                           .Register(registry)
                           .Add({});
  Family<Counter>& refused =
      BuildCounter()
          .Name("slipway_http_refused_total")
          .Help(
              "What was not answered: requests and connections that were refused, and requests "
              "whose client had left (abandoned)")
          .Register(registry);
  Family<Gauge>& jobs =
      BuildGauge().Name("slipway_jobs").Help("Jobs that are kept, by kind and state").Register(registry);
  std::set<Gauge*> jobs_shown;
  Counter& deaths = BuildCounter()
                        .Name("slipway_worker_deaths_total")
                        .Help("Worker processes that ended without being asked to")
                        .Register(registry)
                        .Add({});
  Gauge& resident = BuildGauge()
                        .Name("process_resident_memory_bytes")
                        .Help("Memory of the service, its workers apart")
                        .Register(registry)
                        .Add({});
  Gauge& descriptors =
      BuildGauge().Name("process_open_fds").Help("Descriptors that are open").Register(registry).Add({});

  void set_total(Family<Counter>& family, const char* what, std::uint64_t total) {
    Counter& counter = family.Add({{"what", what}});
    counter.Increment(static_cast<double>(total) - counter.Value());
  }
};

ServiceMetrics::ServiceMetrics() : families_(std::make_unique<Families>()) {
  BuildGauge()
      .Name("slipway_build_info")
      .Help("Always 1; the label says which program this is")
      .Register(families_->registry)
      .Add({{"version", std::string(version())}})
      .Set(1.0);
}

ServiceMetrics::~ServiceMetrics() = default;

void ServiceMetrics::count_answer(const AnsweredRequest& answered) {
  // What no route answers has one name for all addresses, so that nobody can make names without end.
  const std::string& pattern = answered.request.route;
  const std::string route = pattern.empty() ? "none" : pattern;
  families_->requests
      .Add({{"method", answered.request.method},
            {"route", route},
            {"status", fmt::format("{}", answered.response.status)}})
      .Increment();
  families_->seconds.Add({{"route", route}}, kSeconds).Observe(answered.seconds);
}

void ServiceMetrics::count_worker_death() {
  families_->deaths.Increment();
}

std::string ServiceMetrics::text(const HttpCounters& http, const std::vector<api::JobCount>& jobs) {
  Families& f = *families_;
  const std::scoped_lock lock(f.mutex);
  f.connections.Set(static_cast<double>(http.open_connections));
  f.set_total(f.refused, "requests", http.requests_refused);
  f.set_total(f.refused, "connections", http.connections_refused);
  f.set_total(f.refused, "abandoned", http.requests_abandoned);
  f.resident.Set(resident_bytes());
  f.descriptors.Set(open_descriptors());
  for (Gauge* const gauge : f.jobs_shown) gauge->Set(0.0);  // a state that no job is in any more
  for (const api::JobCount& count : jobs) {
    Gauge& gauge = f.jobs.Add({{"kind", count.kind}, {"state", std::string(api::describe(count.state))}});
    gauge.Set(static_cast<double>(count.count));
    f.jobs_shown.insert(&gauge);
  }
  return prometheus::TextSerializer().Serialize(f.registry.Collect());
}

}  // namespace slipway::server
