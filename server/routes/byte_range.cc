#include "server/routes/byte_range.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>

#include "server/routes/responses.h"

namespace slipway::server {
namespace {

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

// A place of any number of digits; those beyond all bodies are the last there can be.
std::optional<std::uint64_t> place_of(std::string_view digits) {
  if (digits.empty() || digits.find_first_not_of("0123456789") != std::string_view::npos) return std::nullopt;
  std::uint64_t place = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), place);
  return error == std::errc() ? place : std::numeric_limits<std::uint64_t>::max();
}

// The one value of a header that must not be given twice.
std::optional<std::string_view> only_value(const HttpRequest& request, std::string_view wanted) {
  std::optional<std::string_view> found;
  for (const auto& [name, value] : request.headers) {
    if (!equal_ignoring_case(name, wanted)) continue;
    if (found) return std::nullopt;
    found = value;
  }
  return found;
}

// Of "0-499", "500-" and "-500".
AskedBytes bytes_of(std::string_view range, std::uint64_t size) {
  const std::size_t dash = range.find('-');
  if (dash == std::string_view::npos) return WholeBody{};
  const std::string_view before = range.substr(0, dash), behind = range.substr(dash + 1);
  const auto first = place_of(before), last = place_of(behind);
  if ((!first && !before.empty()) || (!last && !behind.empty()) || (!first && !last)) return WholeBody{};
  if (first && last && *last < *first) return WholeBody{};
  if (!first) {
    const std::uint64_t count = std::min(*last, size);
    return count == 0 ? AskedBytes(UnsatisfiableRange{}) : ByteRange{size - count, size - 1};
  }
  if (*first >= size) return UnsatisfiableRange{};
  return ByteRange{*first, std::min(last.value_or(size - 1), size - 1)};
}

// The part of the pages, which begins in one and ends in the same or another.
BodyPieces pieces_of(PagedBody body, ByteRange part) {
  std::size_t page = 0;
  std::uint64_t page_begin = 0;
  while (page < body.page_bytes.size() && page_begin + body.page_bytes[page] <= part.first)
    page_begin += body.page_bytes[page++];
  return [body = std::move(body), part, page, page_begin]() mutable -> Result<std::optional<std::string>> {
    if (page >= body.page_bytes.size() || page_begin > part.last) return std::nullopt;
    auto bytes = body.read(page);
    if (!bytes) return fail(bytes.error());
    const std::uint64_t size = body.page_bytes[page++];
    if (bytes->size() != size)
      return fail(ErrorCode::kStorage, "a page of the body has another length than it had");
    const std::uint64_t begin = part.first > page_begin ? part.first - page_begin : 0;
    const std::uint64_t end = std::min(size, part.last - page_begin + 1);
    page_begin += size;
    bytes->resize(end);
    bytes->erase(0, begin);
    return *std::move(bytes);
  };
}

}  // namespace

AskedBytes asked_bytes(const HttpRequest& request, std::string_view tag, std::uint64_t size) {
  constexpr std::string_view kUnit = "bytes=";
  if (request.method != "GET") return WholeBody{};
  const auto asked = only_value(request, "Range");
  if (!asked || asked->size() < kUnit.size() || !equal_ignoring_case(asked->substr(0, kUnit.size()), kUnit))
    return WholeBody{};
  // Of a version that the client does not name, or of which it knows the day alone, it gets the whole.
  if (request.header("If-Range") && only_value(request, "If-Range") != tag) return WholeBody{};
  return bytes_of(trimmed(asked->substr(kUnit.size())), size);
}

HttpResponse ranged(HttpResponse answer, PagedBody body, const HttpRequest& request) {
  answer = tagged(std::move(answer), body.tag, request);
  answer.headers.emplace_back("Accept-Ranges", "bytes");
  if (answer.status != 200) return answer;
  const auto size = std::accumulate(body.page_bytes.begin(), body.page_bytes.end(), std::uint64_t{0});
  const AskedBytes asked = asked_bytes(request, body.tag, size);
  if (std::holds_alternative<UnsatisfiableRange>(asked)) {
    HttpResponse refusal =
        problem(ErrorCode::kRangeNotSatisfiable,
                fmt::format("there are {} bytes, none of them in the range", size), request);
    refusal.headers.emplace_back("Content-Range", fmt::format("bytes */{}", size));
    return refusal;
  }
  ByteRange part{0, size - 1};
  if (const auto* const range = std::get_if<ByteRange>(&asked)) {
    part = *range;
    answer.status = 206;
    answer.headers.emplace_back("Content-Range", fmt::format("bytes {}-{}/{}", part.first, part.last, size));
  }
  answer.pieces_bytes = part.last - part.first + 1;
  answer.pieces = pieces_of(std::move(body), part);
  return answer;
}

}  // namespace slipway::server
