#include "core/error_code.h"

#include <algorithm>
#include <array>
#include <stdexcept>

namespace slipway {
namespace {

constexpr std::array kRows{
    ErrorRow{ErrorCode::kMalformedHttp, "malformed_http", 400,
             "The request is not HTTP/1.1 as RFC 9112 has it; the detail says where."},
    ErrorRow{ErrorCode::kMalformedJson, "malformed_json", 400,
             "The body is not one JSON document; mend the syntax at the place named."},
    ErrorRow{ErrorCode::kInvalidRequest, "invalid_request", 422,
             "The request was read but values in it are not allowed; each fault names its place and range."},
    ErrorRow{ErrorCode::kUnauthorized, "unauthorized", 401,
             "Send Authorization: Bearer TOKEN with a token that the operator has given you."},
    ErrorRow{ErrorCode::kForbidden, "forbidden", 403, "Who asks may not do this; the detail says why."},
    ErrorRow{ErrorCode::kNotFound, "not_found", 404, "Nothing is known under this address."},
    ErrorRow{ErrorCode::kMethodNotAllowed, "method_not_allowed", 405,
             "The address exists but not with this method; see the Allow header."},
    ErrorRow{ErrorCode::kNotAcceptable, "not_acceptable", 406,
             "The answer exists only in the media types named in the detail."},
    ErrorRow{ErrorCode::kRequestTimeout, "request_timeout", 408,
             "The request did not arrive in time; send it again without pauses."},
    ErrorRow{ErrorCode::kConflict, "conflict", 409,
             "What is there already does not allow this; the detail says what."},
    ErrorRow{ErrorCode::kPayloadTooLarge, "payload_too_large", 413, "Send a body below the limit named."},
    ErrorRow{ErrorCode::kUnsupportedMediaType, "unsupported_media_type", 415,
             "Send a Content-Type that the detail names, without Content-Encoding."},
    ErrorRow{ErrorCode::kRangeNotSatisfiable, "range_not_satisfiable", 416,
             "Ask for bytes that there are: the header Content-Range says how many."},
    ErrorRow{ErrorCode::kForeignHost, "foreign_host", 421,
             "Ask under an address as numbers, localhost, or a name that the operator allows."},
    ErrorRow{ErrorCode::kHeaderTooLarge, "header_too_large", 431, "Send fewer or shorter headers."},
    ErrorRow{ErrorCode::kTooManyRequests, "too_many_requests", 429, "Ask less often; see Retry-After."},
    ErrorRow{ErrorCode::kOverQuota, "over_quota", 429,
             "Wait until some of your own jobs have ended, or dismiss one; see Retry-After."},
    ErrorRow{ErrorCode::kTooManyJobs, "too_many_jobs", 503,
             "The queue is full; try again after the time in Retry-After."},
    ErrorRow{ErrorCode::kUnreadableRaster, "unreadable_raster", 422,
             "The raster can't be used as it is; the detail says why and what would mend it."},
    ErrorRow{ErrorCode::kUnsupportedCrs, "unsupported_crs", 422,
             "Reproject the raster into a metric projected system with the command in the detail."},
    ErrorRow{ErrorCode::kUnreadableData, "unreadable_data", 422,
             "A data file can't be used as it is; each fault names its place."},
    ErrorRow{ErrorCode::kOffMap, "off_map", 422,
             "The place lies outside the terrain; choose one inside its extent."},
    ErrorRow{ErrorCode::kNoData, "no_data", 422,
             "There is no elevation at that place, or no reading to work with; the detail says which."},
    ErrorRow{ErrorCode::kNotConverged, "not_converged", 500,
             "A solver gave up; the detail says which and where. Please report it."},
    ErrorRow{ErrorCode::kNotReady, "not_ready", 503,
             "The service can't take work now; the detail says why. Ask again soon."},
    ErrorRow{
        ErrorCode::kJobTooLarge, "job_too_large", 422,
        "The work needs more memory or time than one job may use; ask for fewer draws, routes or drives."},
    ErrorRow{ErrorCode::kCancelled, "cancelled", 409, "The work was dismissed before it ended."},
    ErrorRow{ErrorCode::kStorage, "storage", 503,
             "The job store could not be written or read; nothing was accepted. Try again."},
    ErrorRow{ErrorCode::kStorageFull, "storage_full", 507,
             "The disk of the job store is full; nothing was accepted. Free space on it, or keep fewer ended "
             "jobs."},
    ErrorRow{ErrorCode::kDamagedStore, "damaged_store", 500,
             "What is stored was altered or can't be read; the detail says what to do."},
    ErrorRow{ErrorCode::kUnwritableFile, "unwritable_file", 500,
             "A file that was asked for could not be written; its folder must exist and be writable."},
    ErrorRow{ErrorCode::kInternal, "internal", 500,
             "A promise inside the program was broken. Please report it."},
};

}  // namespace

std::span<const ErrorRow> error_table() {
  return kRows;
}

const ErrorRow& error_row(ErrorCode code) {
  const auto row =
      std::find_if(kRows.begin(), kRows.end(), [code](const ErrorRow& r) { return r.code == code; });
  if (row == kRows.end()) throw std::logic_error("an error code has no row in the error table");
  return *row;
}

}  // namespace slipway
