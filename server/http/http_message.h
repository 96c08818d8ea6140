#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/result.h"
#include "server/http/http_body_file.h"
#include "server/http/http_stream.h"

namespace slipway::server {

using NamedValues = std::vector<std::pair<std::string, std::string>>;  // in the order in which they came

// A request whose head was checked and whose body was read to its end. All its text is UTF-8, except header
// values.
struct HttpRequest {
  std::string method;      // "GET", "POST", ...; a HEAD that a GET route answers says "HEAD" here
  std::string path;        // percent-decoded, without the query
  std::string raw_path;    // as sent: routes are matched on it, so that an encoded slash is not a separator
  NamedValues query;       // percent-decoded; a name given twice is here twice
  NamedValues headers;     // as sent; read them with header()
  NamedValues parameters;  // what the route's "{name}" segments matched, percent-decoded
  std::string body;        // without chunk framing; empty where it is in the file
  std::shared_ptr<const BodyFile> body_file;  // see LargeBodies
  std::string remote_address;                 // the socket's peer; no header can change it
  // The header X-Request-Id where that is 1 to 128 visible ASCII characters, otherwise one that is made here.
  // The answer bears it too.
  std::string id;
  std::string principal;  // who asks, as HttpOptions::admit knows it
  bool is_admin = false;  // may change what is others', by the same
  std::string token;      // the SHA-256 of the token by which that is known; empty: none was needed
  std::string route;      // the pattern of the route that answers; empty: none does

  // The header's first value. Names are compared without regard to case.
  std::optional<std::string> header(std::string_view name) const;
  // The query parameter's first value.
  std::optional<std::string> query_value(std::string_view name) const;
  // The value of the route's "{name}" segment; empty when the route has none of that name.
  std::string_view parameter(std::string_view name) const;
};

// Gives the pieces of a long body one after the other, of kMaxPieceBytes at most, nothing after the last. An
// error ends the connection in the middle of the body, which the client sees.
inline constexpr std::size_t kMaxPieceBytes = std::size_t{1} << 20;
using BodyPieces = std::function<Result<std::optional<std::string>>()>;

struct HttpResponse {
  int status = 200;
  std::string content_type;  // ignored when the body is empty
  std::string body;
  // Framing (Content-Length, Transfer-Encoding, Connection) is the server's: such names are left out of what
  // is sent.
  NamedValues headers;
  // An answer without a body that goes on: it ends with the connection. Called once with what to write into
  // when the head is on its way; not for HEAD.
  std::function<void(std::shared_ptr<AnswerStream>)> stream = {};
  // A body that is made while it is sent, so that a slow client holds one piece of it: called from any
  // thread, one call at a time, when the client has taken what came before. Not for HEAD.
  BodyPieces pieces = {};
  // How many bytes the pieces have together, which is then said as Content-Length; nothing: that is not known
  // before the last, and they go in chunks.
  std::optional<std::uint64_t> pieces_bytes = {};
  std::string audit = {};        // a JSON object for the audit log, which is not sent
  bool changed_nothing = false;  // though the status is one of success: for the audit log too

  std::optional<std::string> header(std::string_view name) const;
};

// Whether requests of this method change nothing [RFC 9110, 9.2.1].
bool only_reads(std::string_view method);

// ASCII only, as header names and media types are.
bool equal_ignoring_case(std::string_view a, std::string_view b);

}  // namespace slipway::server
