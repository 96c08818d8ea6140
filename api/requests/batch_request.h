#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace slipway::api {

inline constexpr int kMaxBatch = 10'000;                // answers of one batch
inline constexpr std::size_t kMaxBatchRequests = 1000;  // that differ in more than their seed

// POST /v1/batches asks for the answers to many requests of one kind.
struct BatchRequest {
  std::string kind;
  std::vector<std::string> requests;       // documents, in the order of the answers
  std::vector<std::string> terrains = {};  // that the requests are about
  std::size_t seeds = 1;                   // so many in a row are one request with different seeds
};

struct BatchAnswer {
  std::string kind;
  std::vector<std::string> documents;  // each on one line
};

}  // namespace slipway::api
