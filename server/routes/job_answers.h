#pragma once

#include <cstdint>
#include <filesystem>
#include <mutex>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "api/job_kind.h"
#include "api/jobs/job_store.h"
#include "api/service.h"
#include "server/http/http_message.h"
#include "server/routes/byte_range.h"
#include "server/routes/drawn_cache.h"
#include "server/routes/drawn_file.h"

namespace slipway::server {

inline constexpr int kPollSeconds = 1;  // between two looks at a job that has not ended

// The job that the request's path names. Errors: not_found, those of the store.
Result<api::Job> find_job(api::JobStore& store, const HttpRequest& request);

// What jobs have answered, in every form in which it can be had. Thread-safe.
class JobAnswers {
 public:
  // All must outlive this, and the answers that are being sent.
  // What is too large to be drawn in memory is drawn in the folder.
  JobAnswers(const api::Service& service, api::JobStore& store, const std::vector<api::JobKind>& kinds,
             std::filesystem::path drawing_folder)
      : service_(service), store_(store), kinds_(kinds), drawing_folder_(std::move(drawing_folder)) {}

  // The answer of a successful job, the problem of a failed one, the reason why there is neither.
  HttpResponse of(const api::Job& job, const HttpRequest& request);
  HttpResponse result(const HttpRequest& request);
  // A page of all stations as CSV.
  HttpResponse stations(const HttpRequest& request);
  // The answers of a successful batch, one a line.
  HttpResponse answers(const HttpRequest& request);
  // The raster of a successful job, or the range of its bytes that is asked for.
  HttpResponse raster(const HttpRequest& request);
  // Routes, stations, rules and checks of a successful job for GIS tools; ranges likewise.
  HttpResponse vectors(const HttpRequest& request, bool geopackage);
  // The picture of a successful job's answer.
  HttpResponse map(const HttpRequest& request);
  // The report of a successful job, as a page.
  HttpResponse report(const HttpRequest& request);

 private:
  // Its series is no table of stations.
  bool has_file(const api::Job& job) const;
  // All pages of what is kept apart, one after the other.
  Result<BodyPieces> pieces_of(const api::Job& job);
  // The same as pages of which any can be read. All are read once to learn how long they are.
  Result<PagedBody> pages_of(const api::Job& job);
  // Into a file that is not there yet, of which a piece at a time is in memory.
  Result<void> write_vectors(const api::Job& job, bool geopackage, bool lonlat,
                             const std::filesystem::path& path);
  // A page of what is kept apart; of an answer that has all its stations, what it has.
  Result<api::SeriesPage> page_of_stations(const api::Job& job, std::int64_t page);
  // What is kept of a job that has ended.
  Result<std::string> kept_outcome(const api::Job& job);
  HttpResponse answer(const api::Job& job, const std::string& bytes, const HttpRequest& request);
  HttpResponse csv_answer(const api::Job& job, const std::string& bytes, const HttpRequest& request);

  static constexpr std::size_t kMostJobsPaged = 1000;     // of so many jobs, then it begins anew
  static constexpr std::size_t kDrawnBytes = 16'000'000;  // of pictures and pages that are kept in memory
  static constexpr std::size_t kDrawnFileBytes = 256'000'000;  // of files that are kept on the disk

  const api::Service& service_;
  api::JobStore& store_;
  const std::vector<api::JobKind>& kinds_;
  std::filesystem::path drawing_folder_;
  DrawnCache<std::string> drawn_{kDrawnBytes};
  DrawnCache<DrawnFile> drawn_files_{kDrawnFileBytes, /*one_by_one=*/true};
  std::mutex page_bytes_mutex_;
  std::unordered_map<std::string, std::vector<std::uint64_t>>
      page_bytes_;  // of jobs' pages, which never change
};

}  // namespace slipway::server
