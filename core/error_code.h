#pragma once

#include <span>
#include <string_view>

namespace slipway {

// Every way in which a correct caller can be refused. Each has one row in error_table().
enum class ErrorCode {
  kMalformedHttp,
  kMalformedJson,
  kInvalidRequest,
  kUnauthorized,
  kForbidden,
  kNotFound,
  kMethodNotAllowed,
  kNotAcceptable,
  kRequestTimeout,
  kConflict,
  kPayloadTooLarge,
  kUnsupportedMediaType,
  kRangeNotSatisfiable,
  kForeignHost,
  kHeaderTooLarge,
  kTooManyRequests,
  kOverQuota,
  kTooManyJobs,
  kUnreadableRaster,
  kUnsupportedCrs,
  kUnreadableData,
  kOffMap,
  kNoData,
  kNotConverged,
  kNotReady,
  kJobTooLarge,
  kCancelled,
  kStorage,
  kStorageFull,
  kDamagedStore,
  kUnwritableFile,
  kInternal,
};

struct ErrorRow {
  ErrorCode code;
  std::string_view name;  // the name in problem documents and in documentation
  int http_status;
  std::string_view help;  // one sentence: what the caller can do
};

// The one table of errors: the HTTP status, the problem's type and docs/reference/errors.md all come from
// here.
std::span<const ErrorRow> error_table();

const ErrorRow& error_row(ErrorCode code);

}  // namespace slipway
