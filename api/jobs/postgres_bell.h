#pragma once

#include <array>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>

#include "api/jobs/job_store.h"
#include "api/jobs/postgres_connection.h"
#include "core/file_descriptor.h"

namespace slipway::api {

// Tells other processes on the same database of news, and hears theirs, through LISTEN and NOTIFY on a
// session and a thread of its own. NOTIFY stands in no transaction that anybody waits for: all commits with
// one queue behind each other. Bells that come close together are one. A bell may be lost: who listens looks
// from time to time too. Thread-safe.
class PostgresBell {
 public:
  explicit PostgresBell(PostgresAddress address) : address_(std::move(address)) {}
  ~PostgresBell();
  PostgresBell(const PostgresBell&) = delete;
  PostgresBell& operator=(const PostgresBell&) = delete;

  void ring(StoreNews news);
  // The call comes from the thread of this object; an empty one ends the listening, and is not under way any
  // more when this returns.
  void listen(StoreNews news, std::function<void()> call);

 private:
  static constexpr std::size_t kKinds = 2;  // of StoreNews

  void wake();
  void run();
  bool serve(PostgresConnection& connection, std::array<bool, kKinds>& listening);
  void call(std::size_t kind);

  const PostgresAddress address_;
  std::mutex mutex_;
  std::mutex calling_;  // held while a call is under way
  std::array<bool, kKinds> to_ring_{};
  std::array<std::function<void()>, kKinds> calls_;
  bool stopping_ = false;
  FileDescriptor wake_;
  std::condition_variable stopped_;
  std::thread thread_;
};

}  // namespace slipway::api
