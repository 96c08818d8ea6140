#include "research/validation/report/csv_table.h"

#include <gtest/gtest.h>

#include <fstream>

namespace slipway::validation {
namespace {

std::filesystem::path file_with(const char* name, const char* content) {
  const std::filesystem::path path = std::filesystem::path(testing::TempDir()) / name;
  std::ofstream(path) << content;
  return path;
}

TEST(CsvTable, ReadsTextsAndNumbersByTheNameOfTheirColumn) {
  const auto path = file_with("good.csv", "wheel,slip,pull_n\r\nsmooth,0.1,-6.5\r\nlugged,0.2,\r\n");
  const auto table = CsvTable::read(path, {{"slip"}, {"pull_n"}, {"wheel"}});
  ASSERT_TRUE(table) << table.error().detail;
  EXPECT_EQ(table->rows(), 2U);
  EXPECT_EQ(table->text(1, "wheel"), "lugged");
  EXPECT_EQ(table->number(0, "pull_n"), -6.5);
  EXPECT_TRUE(table->empty(1, "pull_n"));
  EXPECT_EQ(table->numbers("slip"), (std::vector<double>{0.1, 0.2}));
}

TEST(CsvTable, NamesEveryFaultWithItsPlace) {
  const auto path = file_with("bad.csv", "slip,pull_n\n0.1,x\nnan,2\n,3\n");
  const auto table = CsvTable::read(path, {{"slip", "pull_n"}, {}, {}});
  ASSERT_FALSE(table);
  EXPECT_EQ(table.error().code, ErrorCode::kUnreadableData);
  std::vector<std::string> pointers;
  for (const Fault& fault : table.error().faults) pointers.push_back(fault.pointer);
  EXPECT_EQ(pointers, (std::vector<std::string>{"/3/slip", "/4/slip", "/2/pull_n"}));
}

TEST(CsvTable, RefusesMissingColumnsAndShortLines) {
  const auto path = file_with("short.csv", "slip,pull_n\n0.1\n");
  const auto table = CsvTable::read(path, {{"slip", "torque_nm"}, {}, {}});
  ASSERT_FALSE(table);
  ASSERT_EQ(table.error().faults.size(), 2U);
  EXPECT_EQ(table.error().faults[0].pointer, "/torque_nm");
  EXPECT_EQ(table.error().faults[1].pointer, "/2");
  EXPECT_FALSE(CsvTable::read(path.parent_path() / "absent.csv", {}));
}

}  // namespace
}  // namespace slipway::validation
