#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "server/http/http_chunked.h"
#include "server/http/http_head.h"
#include "server/http/http_options.h"

namespace slipway::server {

// Makes requests of the bytes of one connection, whatever pieces they arrive in. It knows no sockets and no
// clock, and holds at most a head and a body at once.
class RequestGatherer {
 public:
  enum class State {
    kIdle,     // nothing of a request has come
    kHead,     // a part of its head has
    kBody,     // its head has, and a part of its body
    kReady,    // it is whole: take it
    kRefused,  // it never will be: refusal() says why, and the connection is not to be read further
  };

  explicit RequestGatherer(const HttpOptions& options) : options_(&options) {}

  // In kReady bytes may be given too: they belong to the next request.
  State feed(std::string_view bytes);
  State state() const { return state_; }

  // How many bytes to offer at most, so that a client that sends ahead is left to its own send buffer.
  std::size_t appetite() const;
  // The bytes held, for the budget over all connections.
  std::size_t held() const { return input_.size() + body_.size(); }
  // The bytes of a request under way that have come, wherever they are.
  std::size_t received() const { return held() + in_file(); }
  // The connection's owner gives up on the request, for a reason of its own.
  void refuse(Error error);
  // Once true after a head that expects it: "100 Continue" is to be sent.
  bool take_continue();

  const Error& refusal() const { return refusal_; }
  // With kBody and kReady, and with what is refused after its head.
  const RequestHead& head() const { return head_; }
  // Of the web page that asks, once the head is whole, even where it is refused.
  const std::optional<std::string>& origin() const { return origin_; }

  struct Gathered {
    RequestHead head;
    std::string body;
    std::shared_ptr<const BodyFile> body_file;
  };
  // In kReady. The next request, if it has come already, is seen by the feed() that has to follow.
  Gathered take();

 private:
  void advance();
  void advance_head();
  void advance_body();
  // Moves what has come of a large body into its file; refuses it where that fails.
  void spool();
  void open_body_file();
  std::size_t in_file() const { return body_file_ ? static_cast<std::size_t>(body_file_->bytes()) : 0; }

  const HttpOptions* options_;
  State state_ = State::kIdle;
  std::string input_;        // not understood yet
  std::size_t scanned_ = 0;  // of input_, in search of the head's end
  RequestHead head_;
  std::optional<std::string> origin_;
  std::string body_;
  std::shared_ptr<BodyFile> body_file_;  // of a large body, which passes through body_
  std::optional<ChunkedBody> chunked_;
  bool continue_due_ = false;
  Error refusal_;
};

}  // namespace slipway::server
