#include "server/routes/drawn_cache.h"

#include <gtest/gtest.h>

namespace slipway::server {
namespace {

TEST(DrawnCache, DrawsOnceAndForgetsWhatWasAskedForLongestAgo) {
  DrawnCache<std::string> cache(10);
  int drawn = 0;
  const auto ask = [&](const std::string& key, std::size_t bytes) {
    return **cache.get(key, [&]() -> Result<std::string> {
      ++drawn;
      return std::string(bytes, key[0]);
    });
  };
  EXPECT_EQ(ask("a", 4), "aaaa");
  EXPECT_EQ(ask("b", 4), "bbbb");
  EXPECT_EQ(ask("a", 4), "aaaa");
  EXPECT_EQ(drawn, 2);
  ask("c", 4);
  EXPECT_EQ(ask("a", 4), "aaaa");
  EXPECT_EQ(drawn, 3);
  ask("b", 4);
  EXPECT_EQ(drawn, 4) << "it was asked for longest ago when c came";
}

TEST(DrawnCache, KeepsNeitherErrorsNorWhatIsTooLarge) {
  DrawnCache<std::string> cache(10);
  int asked = 0;
  for (int k = 0; k < 2; ++k) {
    EXPECT_FALSE(cache.get("e", [&]() -> Result<std::string> {
      ++asked;
      return fail(ErrorCode::kNoData, "nothing to draw");
    }));
    EXPECT_EQ((*cache.get("large",
                          [&]() -> Result<std::string> {
                            ++asked;
                            return std::string(11, 'x');
                          }))
                  ->size(),
              11u);
  }
  EXPECT_EQ(asked, 4);
}

}  // namespace
}  // namespace slipway::server
