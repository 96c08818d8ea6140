#include "server/operations/access.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>
#include <utility>
#include <vector>

#include "api/files/terrain_site.h"
#include "api/jobs/job.h"
#include "api/json/strict_reader.h"
#include "api/json/toml_parse.h"
#include "core/sha256.h"

namespace slipway::server {
namespace {

using api::json::Element;
using api::json::ObjectReader;

constexpr std::array<std::string_view, 3> kRoles{"viewer", "operator", "admin"};
constexpr std::size_t kMostTokens = 1000;
constexpr std::size_t kHashDigits = 64;

// What anybody may ask: whether there is somebody, and how to ask.
constexpr std::array<std::string_view, 6> kOpen{"/healthz", "/readyz", "/openapi.json",
                                                "/errors",  "/",       "/dashboard"};
constexpr std::string_view kOpenFolder = "/dashboard/";  // a page that asks for a token itself

std::string hash_of(std::string_view token) {
  Sha256 hash;
  hash.add(token);
  return hash.digest();
}

// "Bearer TOKEN" [RFC 6750, 2.1].
std::optional<std::string_view> token_in(const std::optional<std::string>& authorization) {
  constexpr std::string_view kBearer = "Bearer ";
  if (!authorization || authorization->size() <= kBearer.size() ||
      !equal_ignoring_case(std::string_view(*authorization).substr(0, kBearer.size()), kBearer))
    return std::nullopt;
  return std::string_view(*authorization).substr(kBearer.size());
}

bool is_hash(std::string_view text) {
  return text.size() == kHashDigits && text.find_first_not_of("0123456789abcdef") == std::string_view::npos;
}

}  // namespace

bool is_loopback(std::string_view address) {
  return address.starts_with("127.") || address == "::1" || address == "localhost";
}

std::string_view describe(Role role) {
  return kRoles.at(static_cast<std::size_t>(role));
}

std::optional<Role> role_of(std::string_view name) {
  const auto found = std::find(kRoles.begin(), kRoles.end(), name);
  if (found == kRoles.end()) return std::nullopt;
  return static_cast<Role>(found - kRoles.begin());
}

NewToken new_token(std::string_view name, Role role) {
  NewToken made;
  made.token = api::new_job_id() + api::new_job_id();
  made.entry = fmt::format("[[tokens]]\nname = \"{}\"\nrole = \"{}\"\nsha256 = \"{}\"\n", name,
                           describe(role), hash_of(made.token));
  return made;
}

Result<std::unique_ptr<Access>> Access::open(const AccessOptions& options) {
  std::unique_ptr<Access> access(new Access(options));
  if (const auto read = access->read_again(); !read) return fail(read.error());
  return access;
}

Result<std::size_t> Access::read_again() {
  if (options_.tokens.empty()) return std::size_t{0};
  auto read = read_tokens(options_.tokens);
  if (!read) return fail(read.error());
  const std::size_t count = read->size();
  const std::scoped_lock lock(mutex_);
  holders_ = *std::move(read);
  return count;
}

Result<Access::Holders> Access::read_tokens(const std::string& path) {
  const auto bytes = api::read_data_file(path);
  if (!bytes) return fail(bytes.error());
  const auto document = api::json::parse_toml(*bytes, path);
  if (!document) return fail(document.error());
  std::vector<Fault> faults;
  ObjectReader reader(*document, "", faults);
  Holders holders;
  std::set<std::string> names;
  for (const Element& element : reader.list("tokens", api::json::kRequired, {1, kMostTokens})) {
    ObjectReader entry = reader.object(element);
    if (!entry.is_object()) continue;
    Holder holder;
    std::string hash;
    std::size_t role = 0;
    const bool good = entry.text("name", api::json::kRequired, {.most = 64, .is_name = true}, holder.name) &
                      entry.choice("role", api::json::kRequired, {kRoles.begin(), kRoles.end()}, role) &
                      entry.text("sha256", api::json::kRequired, {.most = kHashDigits}, hash);
    entry.refuse_unknown();
    if (!good) continue;
    if (!is_hash(hash)) entry.fault("sha256", "sha256 must be 64 hexadecimal digits in lower case");
    if (!names.insert(holder.name).second)
      entry.fault("name", fmt::format("\"{}\" is the name of two tokens", holder.name));
    holder.role = static_cast<Role>(role);
    const std::string name = holder.name;
    if (const auto [known, is_new] = holders.emplace(std::move(hash), std::move(holder)); !is_new)
      entry.fault("sha256", fmt::format("\"{}\" and \"{}\" have the same token: give each person one",
                                        known->second.name, name));
  }
  reader.refuse_unknown();
  if (!faults.empty())
    return fail(ErrorCode::kUnreadableData, fmt::format("{} can't be used", path), std::move(faults));
  return holders;
}

Result<std::optional<Access::Holder>> Access::holder_of(
    std::string_view method, std::string_view path, const std::optional<std::string>& authorization) const {
  const bool open =
      path.starts_with(kOpenFolder) || std::find(kOpen.begin(), kOpen.end(), path) != kOpen.end();
  if (options_.tokens.empty() || open || method == "OPTIONS") return std::nullopt;
  const auto token = token_in(authorization);
  const std::string hash = token ? hash_of(*token) : "";
  const std::scoped_lock lock(mutex_);
  const auto holder = token ? holders_.find(hash) : holders_.end();
  if (holder == holders_.end())
    return fail(ErrorCode::kUnauthorized, token ? "the token is not known here" : "a token is needed here");
  return holder->second;
}

bool Access::knows(const std::string& token) const {
  const std::scoped_lock lock(mutex_);
  return holders_.contains(token);
}

std::string Access::name_of(std::string_view method, std::string_view path,
                            const std::optional<std::string>& authorization) const {
  const auto holder = holder_of(method, path, authorization);
  return holder && *holder ? (*holder)->name : "";
}

bool Access::may(const Holder& holder, std::string_view method) {
  return holder.role != Role::kViewer || only_reads(method);
}

bool Access::refuses(std::string_view method, std::string_view path,
                     const std::optional<std::string>& authorization) const {
  const auto holder = holder_of(method, path, authorization);
  return !holder || (*holder && !may(**holder, method));
}

Result<void> Access::admit(HttpRequest& request) {
  const auto holder = holder_of(request.method, request.path, request.header("Authorization"));
  request.principal = is_loopback(request.remote_address) ? "loopback" : request.remote_address;
  if (!holder) return fail(holder.error());
  if (*holder) {
    request.principal = (*holder)->name;
    request.is_admin = (*holder)->role == Role::kAdmin;
    request.token = hash_of(*token_in(request.header("Authorization")));
    if (!may(**holder, request.method))
      return fail(ErrorCode::kForbidden,
                  fmt::format("{} is a viewer, who changes nothing", request.principal));
  }
  if (!is_within_rate(request.principal))
    return fail(ErrorCode::kTooManyRequests,
                fmt::format("more than {:g} requests a second", options_.max_requests_per_s));
  return {};
}

bool Access::is_within_rate(const std::string& who) {
  if (options_.max_requests_per_s <= 0.0) return true;
  const double most = std::max(1.0, options_.max_requests_per_s);
  const Clock::time_point now = Clock::now();
  const std::scoped_lock lock(mutex_);
  constexpr std::size_t kMostBuckets = 10'000;
  if (buckets_.size() >= kMostBuckets)  // who has not asked for a second has a full bucket anyway
    std::erase_if(buckets_,
                  [&](const auto& entry) { return now - entry.second.filled > std::chrono::seconds(1); });
  const auto [place, is_new] = buckets_.try_emplace(who, Bucket{most, now});
  Bucket& bucket = place->second;
  const double seconds = std::chrono::duration<double>(now - bucket.filled).count();
  bucket.left = std::min(most, bucket.left + options_.max_requests_per_s * seconds);
  bucket.filled = now;
  if (bucket.left < 1.0) return false;
  bucket.left -= 1.0;
  return true;
}

}  // namespace slipway::server
