#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "server/http/http_message.h"
#include "server/http/http_options.h"

namespace slipway::server {

// From a request in memory to its answer in memory, through cpp-httplib. One for each thread that answers.
//
// Of httplib::Server this keeps what it does well once its input is known to be sound: parsing, decoding, and
// writing responses. Its sockets, its threads, its body reader, its router and its file server are not used;
// measured, they let eight slow clients stop the service, accept 256 MiB in chunks under a limit of 1 MiB,
// and follow symbolic links. So process_request() is given a Stream that holds one checked head, and
// everything is answered in the pre-routing handler, before any of those come into play.
class HttpEngine {
 public:
  explicit HttpEngine(const HttpOptions& options);
  ~HttpEngine();
  HttpEngine(const HttpEngine&) = delete;
  HttpEngine& operator=(const HttpEngine&) = delete;

  struct Exchange {
    std::string_view head;  // RequestHead::forwarded
    std::string body;
    std::shared_ptr<const BodyFile> body_file;
    std::string remote_address;
    bool close = false;  // the answer says that the connection ends with it
  };

  // What to send. A large body stays apart, for joining the two would copy it.
  struct Outgoing {
    std::string front;  // the head, and a small body
    std::string body;
    std::function<void(std::shared_ptr<AnswerStream>)> stream = {};
    BodyPieces pieces = {};  // already as they are sent: in chunks, where the client knows them
  };

  // `answer` may throw: it is not caught here.
  Outgoing respond(Exchange exchange, const std::function<HttpResponse(HttpRequest&)>& answer);

  // The same for a request that was refused before it had a head to pass on. The method decides about a body.
  Outgoing respond_without_request(std::string_view method, HttpResponse response);

 private:
  class Adapter;
  std::unique_ptr<Adapter> adapter_;
};

}  // namespace slipway::server
