#pragma once

#include <memory>
#include <string>
#include <vector>

#include "api/jobs/job_store.h"
#include "server/http/http_options.h"

namespace slipway::server {

// What the service counts of itself, for Prometheus: requests by route and status with the time they took,
// connections, jobs by kind and state, deaths of workers, memory and descriptors. Thread-safe.
class ServiceMetrics {
 public:
  ServiceMetrics();
  ~ServiceMetrics();
  ServiceMetrics(const ServiceMetrics&) = delete;
  ServiceMetrics& operator=(const ServiceMetrics&) = delete;

  void count_answer(const AnsweredRequest& answered);
  void count_worker_death();
  // All of it in Prometheus' text format, version 0.0.4, with what the server and the store count.
  std::string text(const HttpCounters& http, const std::vector<api::JobCount>& jobs);

 private:
  struct Families;
  std::unique_ptr<Families> families_;
};

}  // namespace slipway::server
