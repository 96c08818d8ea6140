#include "server/http/http_stream.h"

namespace slipway::server {

bool AnswerStream::send(std::string_view bytes) {
  const std::lock_guard lock(mutex_);
  if (!wake_ || ended_) return false;
  waiting_.append(bytes);
  wake_();
  return true;
}

void AnswerStream::end() {
  const std::lock_guard lock(mutex_);
  if (!wake_ || ended_) return;
  ended_ = true;
  wake_();
}

AnswerStream::Taken AnswerStream::take() {
  const std::lock_guard lock(mutex_);
  return {std::exchange(waiting_, {}), ended_};
}

void AnswerStream::shut() {
  const std::lock_guard lock(mutex_);
  wake_ = nullptr;
  waiting_ = {};
}

}  // namespace slipway::server
