#include "api/documents/job_document.h"

#include "api/json/problem_document.h"
#include "api/json/writer.h"
#include "core/utc.h"

namespace slipway::api::json {
namespace {

void write_members(Writer& w, const Job& job) {
  w.text("id", job.id).text("kind", job.kind).text("state", describe(job.state));
  w.text("stage", job.stage).significant("progress", job.progress).whole("attempt", job.attempt);
  w.text("created", utc_text(job.created_ms));
  w.whole("urgency", job.urgency);
  if (job.state == JobState::kRunning && !job.best_so_far.empty()) w.key("best_so_far").raw(job.best_so_far);
  if (!job.last_death.empty()) w.text("interrupted", job.last_death);
  if (job.started_ms) w.text("started", utc_text(*job.started_ms));
  if (job.ended_ms) w.text("ended", utc_text(*job.ended_ms));
  if (!job.whole.empty()) w.text("whole", job.whole).whole("part", job.part);
  if (job.parts.count > 0) {
    w.key("parts").begin_object().whole("count", job.parts.count).whole("ended", job.parts.ended);
    w.whole("failed", job.parts.failed).end_object();
  }
  if (!job.whole.empty() || job.parts.count > 0) w.significant("cpu_s", job.cpu_s + job.parts.cpu_s);
  w.key("links").begin_object().text("self", "/v1/jobs/" + job.id);
  if (job.state == JobState::kSuccessful) w.text("result", "/v1/jobs/" + job.id + "/result");
  if (job.parts.count > 0) w.text("parts", "/v1/jobs/" + job.id + "/parts");
  w.end_object();
}

}  // namespace

std::string write_job(const Job& job, const std::optional<std::string>& problem,
                      const std::optional<QueueEstimate>& queue) {
  Writer w;
  w.begin_object();
  write_members(w, job);
  if (queue) {
    w.key("queue").begin_object().whole("ahead", queue->ahead);
    if (queue->wait_s) w.significant("estimated_wait_s", *queue->wait_s);
    if (queue->shortage) w.text("shortage", *queue->shortage);
    w.end_object();
  }
  constexpr std::size_t kLong = std::size_t{1} << 20U;  // of a program that did not bound it
  if (job.state == JobState::kFailed && problem)
    w.key("problem").raw(problem->size() > kLong ? write_problem(read_problem(*problem)) : *problem);
  w.end_object();
  return w.take();
}

std::string write_jobs(const std::vector<Job>& jobs) {
  Writer w;
  w.begin_object().key("jobs").begin_array();
  for (const Job& job : jobs) {
    w.begin_object();
    write_members(w, job);
    w.end_object();
  }
  w.end_array().end_object();
  return w.take();
}

}  // namespace slipway::api::json
