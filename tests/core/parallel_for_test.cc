#include "core/parallel_for.h"

#include <gtest/gtest.h>

#include <stdexcept>
#include <vector>

namespace slipway {
namespace {

TEST(ParallelFor, EveryIndexIsVisitedOnceOnAnyNumberOfThreads) {
  for (const std::size_t threads : {0, 1, 2, 7}) {
    std::vector<int> visits(1000, 0);
    parallel_for(visits.size(), threads, [&](std::size_t i) { ++visits[i]; });
    EXPECT_EQ(visits, std::vector<int>(1000, 1)) << threads << " threads";
  }
}

TEST(ParallelFor, AnEmptyRangeCallsNothing) {
  parallel_for(0, 4, [](std::size_t) { FAIL(); });
}

TEST(ParallelFor, AnExceptionReachesTheCallerAfterAllThreadsEnded) {
  EXPECT_THROW(parallel_for(100, 3,
                            [](std::size_t i) {
                              if (i == 17) throw std::runtime_error("17");
                            }),
               std::runtime_error);
}

}  // namespace
}  // namespace slipway
