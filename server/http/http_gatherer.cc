#include "server/http/http_gatherer.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace slipway::server {
namespace {

// One recv() of a body; larger pieces gain nothing.
constexpr std::size_t kBodyPiece = std::size_t{64} << 10;
// What is kept of a buffer between requests: idle connections are many.
constexpr std::size_t kKeptCapacity = 2048;

}  // namespace

RequestGatherer::State RequestGatherer::feed(std::string_view bytes) {
  if (state_ == State::kRefused) return state_;
  input_.append(bytes);
  if (state_ != State::kReady) advance();
  return state_;
}

std::size_t RequestGatherer::appetite() const {
  switch (state_) {
    case State::kIdle:
    case State::kHead:
      // One more than fits, or a head of just the limit would be refused before its last byte.
      return options_->max_header_bytes + 1 - std::min(options_->max_header_bytes, input_.size());
    case State::kBody:
      return head_.framing == BodyFraming::kLength
                 ? std::min(kBodyPiece,
                            head_.content_length - std::min(head_.content_length, body_.size() + in_file()))
                 : kBodyPiece;
    case State::kReady:
    case State::kRefused:
      break;
  }
  return 0;
}

bool RequestGatherer::take_continue() {
  return std::exchange(continue_due_, false);
}

RequestGatherer::Gathered RequestGatherer::take() {
  Gathered out{std::move(head_), std::move(body_), std::move(body_file_)};
  head_ = {};
  body_ = {};
  body_file_.reset();
  origin_.reset();
  chunked_.reset();
  state_ = State::kIdle;
  if (input_.capacity() > kKeptCapacity) input_.shrink_to_fit();
  return out;
}

void RequestGatherer::advance() {
  if (state_ == State::kIdle || state_ == State::kHead) advance_head();
  if (state_ == State::kBody) advance_body();
}

void RequestGatherer::advance_head() {
  // Empty lines before a request are to be borne with [RFC 9112, 2.2].
  std::size_t blank = 0;
  while (blank + 2 <= input_.size() && input_.compare(blank, 2, "\r\n") == 0) blank += 2;
  if (blank > 0 && scanned_ == 0) input_.erase(0, blank);
  if (input_.empty()) return;
  state_ = State::kHead;
  if (input_ == "\r") return;

  const HeadScan scan = scan_head(input_, scanned_);
  scanned_ = scan.resume_at;
  if (scan.found == HeadScan::Found::kMalformed) {
    return refuse({ErrorCode::kMalformedHttp,
                   "this is not the head of an HTTP/1.1 request with lines that end in CR LF",
                   {}});
  }
  const bool whole = scan.found == HeadScan::Found::kEnd;
  if ((whole ? scan.size : input_.size()) > options_->max_header_bytes) {
    return refuse(
        {ErrorCode::kHeaderTooLarge,
         fmt::format("request line and headers have more than {} bytes", options_->max_header_bytes),
         {}});
  }
  if (!whole) return;

  const std::string_view text = std::string_view(input_).substr(0, scan.size);
  origin_ = header_in(text, "Origin");
  auto head = read_head(text, *options_);
  if (!head) return refuse(std::move(head.error()));
  head_ = std::move(*head);
  const bool unwanted = head_.framing != BodyFraming::kNone && options_->wants_body &&
                        !options_->wants_body(head_.method, head_.path, header_in(text, "Authorization"));
  input_.erase(0, scan.size);
  if (unwanted) {
    // Answered as it is, and nothing that follows on the connection is understood any more.
    head_.framing = BodyFraming::kNone;
    head_.expects_continue = head_.keep_alive = false;
  }
  state_ = head_.framing == BodyFraming::kNone ? State::kReady : State::kBody;
  if (head_.framing == BodyFraming::kChunked) chunked_.emplace(max_body_bytes(head_, *options_));
  if (head_.large && state_ == State::kBody) open_body_file();
  if (state_ == State::kRefused) return;
  // A client that has begun with the body waits for nothing.
  continue_due_ = head_.expects_continue && input_.empty();
}

void RequestGatherer::advance_body() {
  if (head_.framing == BodyFraming::kLength) {
    const std::size_t n = std::min(head_.content_length - body_.size() - in_file(), input_.size());
    body_.append(input_, 0, n);
    input_.erase(0, n);
    spool();
    if (state_ == State::kBody && body_.size() + in_file() == head_.content_length) state_ = State::kReady;
    return;
  }
  std::string_view bytes = input_;
  const ChunkedBody::State chunked = chunked_->feed(bytes, body_);
  input_.erase(0, input_.size() - bytes.size());
  spool();
  if (state_ == State::kRefused) return;
  if (chunked == ChunkedBody::State::kDone) state_ = State::kReady;
  if (chunked == ChunkedBody::State::kMalformed)
    refuse({ErrorCode::kMalformedHttp, "the body's chunks are malformed", {}});
  if (chunked == ChunkedBody::State::kTooLarge) refuse(body_too_large(max_body_bytes(head_, *options_)));
}

void RequestGatherer::open_body_file() {
  auto file = BodyFile::make(options_->large_bodies.folder, options_->large_bodies.under_way);
  if (!file) return refuse(std::move(file.error()));
  body_file_ = *std::move(file);
}

void RequestGatherer::spool() {
  if (!body_file_ || body_.empty()) return;
  const LargeBodies& large = options_->large_bodies;
  const std::uint64_t most = max_body_bytes(head_, *options_);
  if (in_file() + body_.size() > most) return refuse(body_too_large(most));
  if (*large.under_way + static_cast<std::int64_t>(body_.size()) > large.max_total_bytes)
    return refuse({ErrorCode::kTooManyJobs, "too many large requests are under way; try again later", {}});
  if (auto written = body_file_->append(body_); !written) return refuse(std::move(written.error()));
  body_.clear();
}

void RequestGatherer::refuse(Error error) {
  state_ = State::kRefused;
  refusal_ = std::move(error);
  // Nothing of it is used any more, and the connection may linger.
  input_ = {};
  body_ = {};
  body_file_.reset();
}

}  // namespace slipway::server
