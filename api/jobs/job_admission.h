#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "api/jobs/job_store.h"

// What every job store says in the same way of who may append and of what waits.
namespace slipway::api {

// Why a job died whose worker let its lease end.
inline constexpr std::string_view kLeaseEnded = "its worker no longer renewed its lease";

// The share of a job's work that its parts are.
inline constexpr double kShareOfParts = 0.9;

// The refusal of one more job; nothing where it may come in.
std::optional<Error> refused_by(const Admission& admission, std::int64_t unfinished,
                                std::int64_t unfinished_of_owner);

// The refusal of a key under which the owner asked for something else.
Error another_request();

// What a job is as it is accepted.
Job accepted_job(const NewJob& wanted, std::int64_t now);

// What a job is that becomes a part of another.
NewJob new_part(const Job& whole, const std::string& request);

// How a job in parts stands after `ended` of them: its stage, and its progress, of which putting the parts
// together has a share too.
inline constexpr const char* kStageOfParts = "%s of %s parts are done";
std::string stage_of_parts(int ended, int count);
double progress_of_parts(int ended, int count);

// How many parts may be claimed at once of those that a job still waits for, if `most` are wanted: at most
// one in kShareAtOnce, so that many workers end at about the same time.
inline constexpr int kShareAtOnce = 16;
int parts_at_once(const JobParts& parts, int most);

// The place of a job in the queue, from what is before it.
class QueueSum {
 public:
  // So many jobs of one kind, which usually take so long [s]. Of a running one half is taken to be left.
  void add(bool running, int count, std::optional<double> each_s);
  QueuePlace place() const;

 private:
  int ahead_ = 0;
  double work_s_ = 0.0;
  bool known_ = true;
};

}  // namespace slipway::api
