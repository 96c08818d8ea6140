#include "api/jobs/postgres_pool.h"

#include <optional>
#include <random>
#include <string>
#include <thread>
#include <utility>

namespace slipway::api {
namespace {

using Clock = PostgresConnection::Clock;
using std::chrono::milliseconds;

// Who lost the server at the same moment does not come back at the same moment.
milliseconds pause_before_next() {
  thread_local std::minstd_rand chance{std::random_device{}()};
  constexpr int kLeast_ms = 50, kMost_ms = 250;
  return milliseconds(std::uniform_int_distribution<int>(kLeast_ms, kMost_ms)(chance));
}

Error error_of(const PostgresFailure& failure) {
  const std::string& code = failure.sqlstate();
  const bool full = code == "53100", damaged = code.starts_with("XX001") || code.starts_with("XX002");
  return {full      ? ErrorCode::kStorageFull
          : damaged ? ErrorCode::kDamagedStore
                    : ErrorCode::kStorage,
          failure.what(),
          {}};
}

}  // namespace

std::optional<Error> PostgresPool::repeat(const std::function<void(PostgresConnection&)>& work,
                                          milliseconds deadline) {
  const Clock::time_point until = Clock::now() + deadline;
  for (;;) {
    Error error;
    try {
      const Loan connection(*this, until);
      work(*connection);
      return std::nullopt;
    } catch (const PostgresDamage& damage) {
      return Error{ErrorCode::kDamagedStore, damage.what(), {}};
    } catch (const PostgresFailure& failure) {
      error = error_of(failure);
      if (!failure.may_pass()) return error;
    }
    const milliseconds pause = pause_before_next();
    if (Clock::now() + pause >= until) return error;
    std::this_thread::sleep_for(pause);
  }
}

PostgresPool::Loan::Loan(PostgresPool& pool, Clock::time_point until) : pool_(pool) {
  {
    std::unique_lock lock(pool.mutex_);
    if (!pool.freed_.wait_until(lock, until, [&] { return pool.taken_ < kMaxConnections; }))
      throw PostgresFailure("PostgreSQL: every connection of this process waits for an answer", "53300");
    ++pool.taken_;
    if (!pool.idle_.empty()) {
      connection_ = std::move(pool.idle_.back());
      pool.idle_.pop_back();
    }
  }
  try {
    if (connection_ == nullptr) connection_ = std::make_unique<PostgresConnection>(pool.address_, pool.kind_);
  } catch (const PostgresFailure&) {
    give_back();
    throw;
  }
  connection_->set_deadline(until);
}

PostgresPool::Loan::~Loan() {
  give_back();
}

void PostgresPool::Loan::give_back() {
  {
    const std::scoped_lock lock(pool_.mutex_);
    --pool_.taken_;
    if (connection_ != nullptr && connection_->is_good())
      pool_.idle_.push_back(std::move(connection_));
    else
      pool_.idle_.clear();  // what ended this one has most likely ended them all
  }
  pool_.freed_.notify_one();
}

}  // namespace slipway::api
