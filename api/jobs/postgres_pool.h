#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "api/jobs/postgres_connection.h"
#include "core/result.h"

namespace slipway::api {

// Connections of one kind, each used by one thread at a time. Thread-safe.
class PostgresPool {
 public:
  // A call ends within `deadline`, or as many of them as it asks for, whatever the server does.
  PostgresPool(PostgresAddress address, CommitKind kind, std::chrono::milliseconds deadline)
      : address_(std::move(address)), kind_(kind), deadline_(deadline) {}

  // What the work returns. Where the server is away for a moment, or the connection is lost, the work is done
  // again with another: it must look whether it took place already. Errors: storage, also where the deadline
  // is over; storage_full; damaged_store.
  template <class Work>
  auto run(const Work& work, int deadlines = 1)
      -> Result<decltype(work(std::declval<PostgresConnection&>()))> {
    std::optional<decltype(work(std::declval<PostgresConnection&>()))> answer;
    if (auto error = repeat([&](PostgresConnection& connection) { answer.emplace(work(connection)); },
                            deadlines * deadline_))
      return fail(*std::move(error));
    return *std::move(answer);
  }

 private:
  static constexpr std::size_t kMaxConnections = 8;

  // One connection while it is used.
  class Loan {
   public:
    Loan(PostgresPool& pool, PostgresConnection::Clock::time_point until);
    ~Loan();
    Loan(const Loan&) = delete;
    Loan& operator=(const Loan&) = delete;
    PostgresConnection& operator*() const { return *connection_; }

   private:
    void give_back();

    PostgresPool& pool_;
    std::unique_ptr<PostgresConnection> connection_;
  };

  std::optional<Error> repeat(const std::function<void(PostgresConnection&)>& work,
                              std::chrono::milliseconds deadline);

  const PostgresAddress address_;
  const CommitKind kind_;
  const std::chrono::milliseconds deadline_;
  std::mutex mutex_;
  std::condition_variable freed_;
  std::vector<std::unique_ptr<PostgresConnection>> idle_;
  std::size_t taken_ = 0;
};

}  // namespace slipway::api
