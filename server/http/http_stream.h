#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <utility>

namespace slipway::server {

// An answer that goes on after its head: bytes put in here come to the client in their order. Shared by who
// writes and by the connection. Thread-safe.
class AnswerStream {
 public:
  // `wake` tells the connection's owner that there is something to take.
  explicit AnswerStream(std::function<void()> wake) : wake_(std::move(wake)) {}
  AnswerStream(const AnswerStream&) = delete;
  AnswerStream& operator=(const AnswerStream&) = delete;

  // False where the client has gone: nothing more will reach it.
  bool send(std::string_view bytes);
  // The answer ends with what has been sent.
  void end();

  // For the connection's owner. What came since the last call, and whether that was all.
  struct Taken {
    std::string bytes;
    bool ended = false;
  };
  Taken take();
  // The client has gone. Nobody is woken from then on.
  void shut();

 private:
  std::mutex mutex_;
  std::function<void()> wake_;  // empty: shut
  std::string waiting_;
  bool ended_ = false;
};

}  // namespace slipway::server
