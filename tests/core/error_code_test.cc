#include "core/error_code.h"

#include <gtest/gtest.h>

#include <set>
#include <string_view>

namespace slipway {
namespace {

TEST(ErrorTable, EveryCodeUpToTheLastHasOneRow) {
  for (int code = 0; code <= static_cast<int>(ErrorCode::kInternal); ++code)
    EXPECT_EQ(static_cast<int>(error_row(static_cast<ErrorCode>(code)).code), code);
  EXPECT_EQ(error_table().size(), static_cast<std::size_t>(ErrorCode::kInternal) + 1);
}

TEST(ErrorTable, NamesAreUniqueAndStatusesAreRefusals) {
  std::set<std::string_view> names;
  for (const ErrorRow& row : error_table()) {
    EXPECT_TRUE(names.insert(row.name).second) << row.name;
    EXPECT_GE(row.http_status, 400) << row.name;
    EXPECT_LT(row.http_status, 600) << row.name;
    EXPECT_TRUE(row.help.ends_with(".")) << row.name;
  }
}

}  // namespace
}  // namespace slipway
