#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"
#include "server/http/http_body_file.h"
#include "server/http/http_message.h"

namespace slipway::server {

// Cross-origin resource sharing [the Fetch standard, https://fetch.spec.whatwg.org/#http-cors-protocol]:
// without it a browser shows no page of another origin what the server answers. Only pages are held by it,
// and only by their browser: it guards no secret.
struct CrossOrigin {
  std::vector<std::string> origins;  // as browsers send them, see fault_of_origin(); empty: no page may
  // Headers that a page may send besides those that are always allowed, and may read.
  std::vector<std::string> request_headers, response_headers;
  std::chrono::seconds preflight_kept{600};  // how long a browser need not ask again
};

// An answer that is about to be sent.
struct AnsweredRequest {
  const HttpRequest& request;
  const HttpResponse& response;
  double seconds = 0.0;  // that the handler took
};

// Every limit exists because a client without one could take the server from the others. The defaults suit
// one machine that serves a team; a public address belongs behind a reverse proxy.
struct HttpOptions {
  // Only this machine, until someone decides otherwise: there is no authentication here.
  std::string address = "127.0.0.1";
  // 0 lets the kernel choose a free one; start() returns it.
  int port = 0;

  // Handlers run here and nothing else does: no socket that is slow ever holds one of these. Handlers are
  // short (long work is a job), so a few more than there are cores hide their waits on storage.
  std::size_t worker_threads = 8;
  // As many heavy routes are answered at once, see Route: reports, long tables; and as many pictures.
  std::size_t heavy_threads = 2;
  // As many requests for work are checked, or wait for their end, at once.
  std::size_t asking_threads = 6;

  // The largest request is a drive's telemetry as JSON; a day of one rover at 1 Hz is below 4 MiB.
  std::size_t max_body_bytes = std::size_t{4} << 20;
  // Bodies being gathered and answers not yet taken, over all connections: what slow clients can hold in
  // memory. An answer that would take more is 503 instead.
  std::size_t max_buffered_bytes = std::size_t{64} << 20;
  // Request line and headers together; browsers with cookies stay below 8 kB.
  std::size_t max_header_bytes = std::size_t{16} << 10;
  // One line of it. cpp-httplib ends at 8,192 with an empty answer; below that, ours has a reason.
  std::size_t max_line_bytes = 8000;
  // Each one costs an allocation or three, however short.
  std::size_t max_header_count = 100;
  // What a body may be. JSON alone: a web page of another origin can't send that without asking first,
  // whereas forms and bodies without a type it can.
  std::vector<std::string> body_media_types = {"application/json"};

  // What may be larger than that, and goes into files.
  LargeBodies large_bodies = {};

  // From the first byte of a head to its end. A head is one packet or a few.
  std::chrono::milliseconds header_deadline{5'000};
  // From the end of the head to the end of the body. Every second's worth of `min_bytes_per_s` that has
  // come puts it off by a second: what comes steadily is waited for, what drips is not.
  std::chrono::milliseconds body_deadline{5'000};
  // So long an answer is waited for, again and again while the client takes `min_bytes_per_s` of it in each.
  // One that does not read holds memory.
  std::chrono::milliseconds write_deadline{30'000};
  std::size_t min_bytes_per_s = 64'000;
  // Between two requests. Idle connections cost a descriptor and no thread, so this can be generous.
  std::chrono::milliseconds idle_deadline{60'000};
  // After an answer that ends the connection: as long as we go on reading and forgetting what the client
  // still sends, for a close with bytes unread would reset the connection and the client might never see why
  // it was refused.
  std::chrono::milliseconds linger_deadline{1'000};
  // How long stop() waits for requests that have begun.
  std::chrono::milliseconds drain_deadline{5'000};

  // Each costs a descriptor: start() asks the system for as many.
  std::size_t max_connections = 4096;
  // So that one address can't take them all. Behind a reverse proxy every client has the proxy's address:
  // raise it.
  std::size_t max_connections_per_address = 2048;
  // Connections that the kernel has established and we have not accepted yet; cpp-httplib asks for 5.
  int listen_backlog = 256;
  // A connection is closed after so many, which lets a load balancer spread its clients anew.
  std::size_t max_requests_per_connection = 1'000;

  // Names under which requests may come, beside localhost and addresses as numbers, see names_this_server();
  // empty: any.
  std::optional<std::vector<std::string>> host_names;

  // Which web pages of other origins may read the answers (CORS).
  CrossOrigin cross_origin;

  // Turns an error into the response to send, a problem document (RFC 9457). The request is null when its
  // head could not be read. Called from several threads at once.
  std::function<HttpResponse(const Error&, const HttpRequest*)> problem;
  // Whether the body of a request is worth reading, by its method, its path as sent and its Authorization
  // header. One that is not is answered without its body, and its connection ends: admit refuses it. Called
  // from the thread of all sockets. Empty: all are.
  std::function<bool(std::string_view method, std::string_view path,
                     const std::optional<std::string>& authorization)>
      wants_body;
  // Who asks, by the same, so that those who wait for the same threads have their turns one after the other.
  // Called from the thread of all sockets. Empty, or an empty name: each address is somebody.
  std::function<std::string(std::string_view method, std::string_view path,
                            const std::optional<std::string>& authorization)>
      name_of;
  // Asked before the routes are; what it gives is the answer, nothing lets the request through. Empty: all
  // may.
  std::function<std::optional<HttpResponse>(HttpRequest&)> admit;
  // Told of every answer to a whole request, from the thread that made it. Empty: nobody is.
  std::function<void(const AnsweredRequest&)> answered;
  // One line for the operator, already free of control characters. Empty: stderr.
  std::function<void(std::string_view)> log;
};

struct HttpCounters {
  std::uint64_t open_connections = 0;     // now
  std::uint64_t requests_served = 0;      // answered by a route or by the router, since the start
  std::uint64_t requests_refused = 0;     // answered before routing: malformed, too large, too slow
  std::uint64_t requests_abandoned = 0;   // whose clients left before their turn came
  std::uint64_t connections_refused = 0;  // over a cap of connections
};

}  // namespace slipway::server
