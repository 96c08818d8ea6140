#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "api/jobs/job_store.h"

namespace slipway::api::testing {

// Where simulated processes keep their jobs, and what may befall them there.
class SimulatedWorld {
 public:
  virtual ~SimulatedWorld() = default;
  // A process begins: its number, by which the others speak of it.
  virtual int begin_process() = 0;
  // The store as that process opens it, the service of them to look through all of it.
  virtual Result<std::unique_ptr<JobStore>> open(int process, bool is_service) = 0;
  static constexpr int kMishaps = 4;
  // One of the world's mishaps, 0 to 3, befalls the call after so many others, until rest().
  virtual void arm(int mishap, int after) = 0;
  virtual void rest() = 0;
  virtual bool is_dead(int process) const = 0;
  virtual void die(int process) = 0;
  // Of all processes at once.
  virtual void lose_power() = 0;
  // Changes what is stored, as a bad disk does. False: this world has none.
  virtual bool rot() { return false; }
};

// Processes that append, claim, split, report, finish, dismiss and forget jobs, driven by one seed. Whatever
// befalls them: nothing accepted is lost, nothing ends twice, nothing altered is served, every refusal has a
// reason; and where nothing has rotted all comes to an end. What was found; empty: nothing.
std::string simulate_jobs(std::uint64_t seed, SimulatedWorld& world);

}  // namespace slipway::api::testing
