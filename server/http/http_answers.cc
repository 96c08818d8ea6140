#include "server/http/http_answers.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <random>
#include <utility>

#include "server/http/http_cross_origin.h"
#include "server/http/http_head.h"
#include "server/http/http_host.h"

namespace slipway::server {
namespace {

// For when the function that writes problems is missing or fails itself. Nothing in it needs escaping: it is
// all from the table of errors.
HttpResponse bare_problem(ErrorCode code) {
  const ErrorRow& row = error_row(code);
  return {
      row.http_status,
      "application/problem+json",
      fmt::format(R"({{"type":"/errors#{}","title":"{}","status":{}}})", row.name, row.name, row.http_status),
      {}};
}

std::string text_of(const std::exception_ptr& thrown) {
  try {
    std::rethrow_exception(thrown);
  } catch (const std::exception& e) {
    return e.what();
  } catch (...) {
    return "something that is not a std::exception";
  }
}

// The client's, or the next of this process: its own random number with a count behind.
std::string id_of(const HttpRequest& request) {
  constexpr std::size_t kLongest = 128;
  const auto visible = [](char c) { return c > ' ' && c <= '~'; };
  auto id = request.header("X-Request-Id");
  if (id && !id->empty() && id->size() <= kLongest && std::all_of(id->begin(), id->end(), visible))
    return *std::move(id);
  static const std::uint32_t process = std::random_device{}();
  static std::atomic<std::uint64_t> count{0};
  return fmt::format("{:08x}-{}", process, ++count);
}

// Last resort, when even cpp-httplib threw: out of memory, most likely.
constexpr std::string_view kNothingWorks =
    "HTTP/1.1 500 Internal Server Error\r\nConnection: close\r\nContent-Length: 0\r\n\r\n";

}  // namespace

HttpEngine::Outgoing Answers::to_request(HttpEngine& engine, HttpEngine::Exchange exchange) const {
  const std::string_view head = exchange.head;
  try {
    return engine.respond(std::move(exchange), [this](HttpRequest& request) { return routed(request); });
  } catch (...) {
    log(fmt::format("a request could not be answered: {}", text_of(std::current_exception())));
    return instead(engine, head, {ErrorCode::kInternal, "the request could not be answered", {}});
  }
}

HttpEngine::Outgoing Answers::instead(HttpEngine& engine, std::string_view head, const Error& error) const {
  return {to_refused(engine, {head.substr(0, head.find(' ')), header_in(head, "Origin")}, error), {}};
}

const Route* Answers::route_of(const RequestHead& head) const {
  return routes_.find(head.method == "HEAD" ? "GET" : head.method, head.path);
}

std::string Answers::to_refused(HttpEngine& engine, const Refused& refused, const Error& error) const {
  try {
    HttpResponse response = problem(error, nullptr);
    // What stands in the way here is slow or many clients, and both pass soon.
    if (response.status == 503 && !response.header("Retry-After"))
      response.headers.emplace_back("Retry-After", "1");
    HttpRequest asked;
    if (refused.origin) asked.headers.emplace_back("Origin", *refused.origin);
    share_across_origins(options_.cross_origin, asked, response);
    HttpEngine::Outgoing out = engine.respond_without_request(refused.method, std::move(response));
    return out.front + out.body;
  } catch (...) {
    log(fmt::format("a refusal could not be written: {}", text_of(std::current_exception())));
  }
  return std::string(kNothingWorks);
}

HttpResponse Answers::routed(HttpRequest& request) const {
  const auto begun = std::chrono::steady_clock::now();
  request.id = id_of(request);
  HttpResponse response = answered(request);
  share_across_origins(options_.cross_origin, request, response);
  response.headers.emplace_back("X-Request-Id", request.id);
  if (options_.answered) {
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begun;
    options_.answered({request, response, took.count()});
  }
  return response;
}

HttpResponse Answers::answered(HttpRequest& request) const {
  const auto as_problem = [this](const Error& error, const HttpRequest* r) { return problem(error, r); };
  try {
    if (const auto host = request.header("Host");
        options_.host_names && host && !names_this_server(*host, *options_.host_names))
      return problem(
          {ErrorCode::kForeignHost,
           fmt::format("this server is not called {}; the operator may allow it the name with --allow-host",
                       *host),
           {}},
          &request);
    if (options_.admit)
      if (auto refusal = options_.admit(request)) return *std::move(refusal);
    return routes_.answer(request, as_problem);
  } catch (...) {
    // Its text may hold what is nobody's business, so only the operator sees it.
    log(fmt::format("{} {} threw: {}", request.method, request.raw_path, text_of(std::current_exception())));
  }
  return problem({ErrorCode::kInternal, "the server failed while it answered; its log says how", {}},
                 &request);
}

HttpResponse Answers::problem(const Error& error, const HttpRequest* request) const {
  if (!options_.problem) return bare_problem(error.code);
  try {
    return options_.problem(error, request);
  } catch (...) {
    log(fmt::format("the problem document itself threw: {}", text_of(std::current_exception())));
  }
  return bare_problem(error.code);
}

void Answers::log(std::string_view line) const {
  std::string printable(line);
  for (char& c : printable) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = ' ';
  }
  try {
    if (options_.log) {
      options_.log(printable);
    } else {
      fmt::print(stderr, "slipway http: {}\n", printable);
    }
  } catch (const std::exception&) {
    // Nobody is left to tell.
    return;
  }
}

}  // namespace slipway::server
