#include "api/job_kind.h"

#include <algorithm>
#include <stdexcept>

#include "api/continued_request.h"
#include "api/model_reference.h"

namespace slipway::api {
namespace {

// No document has a line's end in it: within strings it is escaped.
constexpr char kBetweenParts = '\n';

}  // namespace

KeptAnswer parts_of(std::string_view kept) {
  const std::size_t end = kept.find(kBetweenParts);
  if (end == std::string_view::npos) return {kept, {}};
  return {kept.substr(0, end), kept.substr(end + 1)};
}

std::string kept_answer(const std::string& document, const std::string& page) {
  if (document.find(kBetweenParts) != std::string::npos)
    throw std::logic_error("a job's document must be one line");
  return document + kBetweenParts + page;
}

std::vector<std::string> in_pieces(std::string_view file) {
  constexpr std::size_t kPiece = std::size_t{1} << 20U;
  std::vector<std::string> pieces;
  for (std::size_t at = 0; at < file.size(); at += kPiece) pieces.emplace_back(file.substr(at, kPiece));
  return pieces;
}

Result<std::vector<std::string>> series_of(std::string_view whole) {
  const auto csv = json::station_csv(whole);
  if (!csv) return fail(csv.error());
  constexpr std::size_t kPageBytes = 1'000'000;
  std::vector<std::string> pages;
  for (std::size_t begin = 0; begin < csv->size();) {
    const std::size_t line = csv->find('\n', std::min(begin + kPageBytes, csv->size()) - 1);
    const std::size_t end = line == std::string::npos ? csv->size() : line + 1;
    pages.push_back(csv->substr(begin, end - begin));
    begin = end;
  }
  return pages;
}

Result<std::string> recorded_request(std::string_view body, std::string_view kind, JobStore& store,
                                     NamesJob names,
                                     const std::function<std::optional<Error>(std::string_view)>& fault_of) {
  if (names == NamesJob::kModel) return recordable_request(body, store, fault_of);
  if (names == NamesJob::kContinued) return continued_request(body, kind, store, fault_of);
  if (auto fault = fault_of(body)) return fail(*std::move(fault));
  return std::string(body);
}

}  // namespace slipway::api
