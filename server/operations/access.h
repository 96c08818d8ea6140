#pragma once

#include <chrono>
#include <cstddef>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>

#include "core/result.h"
#include "server/http/http_message.h"

// Who may do what.
namespace slipway::server {

// Whether only this machine reaches the address, or has it.
bool is_loopback(std::string_view address);

// A viewer reads; an operator also asks for work and dismisses what was asked for under the same token; an
// administrator dismisses anybody's.
enum class Role { kViewer, kOperator, kAdmin };
std::string_view describe(Role role);
std::optional<Role> role_of(std::string_view name);

struct AccessOptions {
  std::string tokens = {};          // a TOML file, see Access::open; empty: without tokens
  double max_requests_per_s = 0.0;  // of one token, or of one address where there are none; 0: any number
};

// A new token, 64 hexadecimal digits of the machine's entropy, and what stands in the file for it.
struct NewToken {
  std::string token, entry;
};
NewToken new_token(std::string_view name, Role role);

// The tokens that are known, as hashes. Thread-safe.
class Access {
 public:
  // The file has a table a token: [[tokens]] with name, role ("viewer", "operator", "admin") and sha256, the
  // hash of the token in hexadecimal digits. Errors: unreadable_data with every fault of the file.
  static Result<std::unique_ptr<Access>> open(const AccessOptions& options);

  // Reads the file of tokens anew, as open() does: who is no longer in it is not known from then on. An error
  // leaves the tokens that were. How many are known now.
  Result<std::size_t> read_again();

  // Whether the request may be answered; it knows who asks in either case. Errors: unauthorized (no token, or
  // one that is not known), forbidden (the role does not allow it), too_many_requests.
  Result<void> admit(HttpRequest& request);

  // Whether a token of this SHA-256 (HttpRequest::token) is still known.
  bool knows(const std::string& token) const;

  // The name of the token that a request of this method, path and Authorization header comes with; empty
  // without one, or where nobody needs one.
  std::string name_of(std::string_view method, std::string_view path,
                      const std::optional<std::string>& authorization) const;

  // Whether admit() will refuse a request of this method, path and Authorization header for the sake of its
  // token: then nobody needs its body.
  bool refuses(std::string_view method, std::string_view path,
               const std::optional<std::string>& authorization) const;

 private:
  using Clock = std::chrono::steady_clock;
  struct Holder {
    std::string name;
    Role role = Role::kViewer;
  };
  // So many requests may come at once as come in a second; each second lets in as many.
  struct Bucket {
    double left = 0.0;
    Clock::time_point filled;
  };

  explicit Access(AccessOptions options) : options_(std::move(options)) {}
  using Holders = std::map<std::string, Holder, std::less<>>;  // by the token's hash
  static Result<Holders> read_tokens(const std::string& path);
  // Who asks, whatever that holder may do; nothing where nobody needs a token. Errors: unauthorized.
  Result<std::optional<Holder>> holder_of(std::string_view method, std::string_view path,
                                          const std::optional<std::string>& authorization) const;
  static bool may(const Holder& holder, std::string_view method);
  bool is_within_rate(const std::string& who);

  AccessOptions options_;
  mutable std::mutex mutex_;
  Holders holders_;
  std::map<std::string, Bucket, std::less<>> buckets_;
};

}  // namespace slipway::server
