#pragma once

#include <string>
#include <tl/expected.hpp>
#include <utility>
#include <vector>

#include "core/error_code.h"

namespace slipway {

// One fault of an input, and its place in it.
struct Fault {
  std::string pointer;  // JSON pointer (RFC 6901); "" is the whole input; a row of a CSV is "/12/column"
  std::string message;  // "max_slope_deg = 212 deg, must be in [0, 60]"

  bool operator==(const Fault&) const = default;
};

// The reason why a correct caller did not get an answer. All faults of an input are reported together.
struct Error {
  ErrorCode code = ErrorCode::kInternal;
  std::string detail;  // one sentence for a person
  std::vector<Fault> faults;
};

template <class T>
using Result = tl::expected<T, Error>;

inline tl::unexpected<Error> fail(ErrorCode code, std::string detail, std::vector<Fault> faults = {}) {
  return tl::unexpected<Error>(Error{code, std::move(detail), std::move(faults)});
}

inline tl::unexpected<Error> fail(Error error) {
  return tl::unexpected<Error>(std::move(error));
}

}  // namespace slipway
