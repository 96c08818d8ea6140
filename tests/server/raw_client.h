#pragma once

#include <chrono>
#include <cstddef>
#include <string>
#include <string_view>

#include "server/http/http_server.h"

namespace slipway::server {

// A client that can be as rude as a test wants: it sends bytes, not requests.
class RawClient {
 public:
  explicit RawClient(int port);
  ~RawClient();
  RawClient(RawClient&& other) noexcept;
  RawClient(const RawClient&) = delete;
  RawClient& operator=(const RawClient&) = delete;
  RawClient& operator=(RawClient&&) = delete;

  bool connected() const { return fd_ >= 0; }
  // False when the server has closed, or takes no more for five seconds.
  bool send(std::string_view bytes);
  void finish_sending();

  struct Answer {
    int status = 0;    // 0: the connection ended, or the time did, before a whole answer was there
    std::string head;  // with its empty line
    std::string body;
    // The header's value, or "" when it is not there.
    std::string header(std::string_view name) const;
  };
  Answer read_answer(bool to_head_request = false,
                     std::chrono::milliseconds patience = std::chrono::seconds(5));
  Answer ask(std::string_view request);
  // What has come, or comes within this time: 64 kB at most.
  std::string read_some(std::chrono::milliseconds patience = std::chrono::seconds(5));
  // All that comes until the server closes.
  std::string read_rest(std::chrono::milliseconds patience = std::chrono::seconds(5));

  // True when the server closes within this time; what it sends until then is dropped.
  bool closed_within(std::chrono::milliseconds patience);

 private:
  bool receive(std::chrono::steady_clock::time_point until);

  int fd_ = -1;
  std::string input_;
};

// One whole request on a connection of its own.
RawClient::Answer ask_once(int port, std::string_view request);

std::string get(std::string_view target, std::string_view more_headers = "");
std::string post(std::string_view target, std::string_view body, std::string_view more_headers = "");

// A problem document written as the real one is, but by hand.
HttpResponse test_problem(const Error& error, const HttpRequest* request);

// A server with the addresses the tests ask at, stopped at the end.
struct TestServer {
  explicit TestServer(HttpOptions options = {});
  HttpServer server;
  int port = 0;
};

std::size_t resident_kib();

// Sanitizers multiply memory and time; what is measured then says nothing.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool kMeasuring = false;
#else
inline constexpr bool kMeasuring = true;
#endif

}  // namespace slipway::server
