#include "core/text_table.h"

#include <gtest/gtest.h>

#include <string>

namespace slipway {
namespace {

using Cells = std::vector<std::string>;

TextTable read(std::string_view bytes, const TextTableRules& rules = {}) {
  auto table = read_text_table(bytes, "t.csv", rules);
  EXPECT_TRUE(table.has_value());
  return table.value_or(TextTable());
}

std::string utf16(std::string_view ascii, bool big_endian, bool mark) {
  std::string bytes = mark ? (big_endian ? "\xFE\xFF" : "\xFF\xFE") : "";
  for (const char c : ascii) bytes += big_endian ? std::string{'\0', c} : std::string{c, '\0'};
  return bytes;
}

TEST(TextTable, CommasInUtf8NeedNoWord) {
  const TextTable table = read("value,label\n1,plain\n\n2,\"dune, \"\"big\"\"\"\n");
  EXPECT_EQ(table.names(), (Cells{"value", "label"}));
  ASSERT_EQ(table.rows(), 2U);
  EXPECT_EQ(table.cells(0), (Cells{"1", "plain"}));
  EXPECT_EQ(table.cells(1), (Cells{"2", "dune, \"big\""}));
  EXPECT_EQ(table.line(1), 4U);
  EXPECT_TRUE(table.notes().empty());
}

TEST(TextTable, TheSeparatorIsFound) {
  for (const std::string separator : {";", "\t", "|"}) {
    const std::string s = separator;
    const TextTable table = read("value" + s + "label\r\n1" + s + "a, b, c\r\n2" + s + "d\r\n");
    EXPECT_EQ(table.names(), (Cells{"value", "label"})) << separator;
    EXPECT_EQ(table.cells(0), (Cells{"1", "a, b, c"})) << separator;
    EXPECT_EQ(table.notes().size(), 1U) << separator;
  }
  EXPECT_EQ(read("sep=;\na;b,c\n1;2\n").names(), (Cells{"a", "b,c"}));
  EXPECT_EQ(read("sep=;\na;b,c\n1;2\n").line(0), 3U);
  EXPECT_EQ(read("a b\n1 2\n", {.separator = ' '}).cells(0), (Cells{"1", "2"}));
}

TEST(TextTable, NamesWithCommasAndDecimalCommasDoNotMisleadIt) {
  const TextTable table = read("time, s;x, m\n0,5;-1,25\n1,5;+2e1\n");
  EXPECT_EQ(table.names(), (Cells{"time, s", "x, m"}));
  EXPECT_EQ(table.number(table.cells(0)[0]), 0.5);
  EXPECT_EQ(table.number(table.cells(0)[1]), -1.25);
  EXPECT_EQ(table.number(table.cells(1)[1]), 20.0);
  EXPECT_TRUE(table.has_decimal_commas());
  EXPECT_EQ(table.notes().size(), 2U);
}

TEST(TextTable, WhereNumbersHavePointsACommaIsNoPoint) {
  const TextTable table = read("a;b\n1.5;1,500\n");
  EXPECT_FALSE(table.has_decimal_commas());
  EXPECT_EQ(table.number("1.5"), 1.5);
  EXPECT_FALSE(table.number("1,500").has_value());
  EXPECT_FALSE(read("a,b\n1,2\n").number("1,5").has_value());
}

TEST(TextTable, EveryEncodingIsTheSameText) {
  const std::string text = "label,soil\nplain,sand\n";
  for (const std::string& bytes : {"\xEF\xBB\xBF" + text, utf16(text, false, true), utf16(text, true, true),
                                   utf16(text, false, false), utf16(text, true, false)}) {
    const TextTable table = read(bytes);
    EXPECT_EQ(table.names(), (Cells{"label", "soil"}));
    EXPECT_EQ(table.cells(0), (Cells{"plain", "sand"}));
  }
  const TextTable latin = read("label,soil\nd\xFCne \x96,sand\n");
  EXPECT_EQ(latin.cells(0)[0], "d\xC3\xBCne \xE2\x80\x93");
  EXPECT_EQ(latin.notes().size(), 1U);
}

TEST(TextTable, LinesEndAsOnAnySystemAndEmptyOnesAreNone) {
  for (const std::string end : {"\n", "\r\n", "\r"}) {
    const TextTable table = read("a;b;;" + end + "1;2;;" + end + " ; ;;" + end + end + "3;4;;" + end);
    EXPECT_EQ(table.names(), (Cells{"a", "b"}));
    ASSERT_EQ(table.rows(), 2U);
    EXPECT_EQ(table.cells(1), (Cells{"3", "4"}));
    EXPECT_EQ(table.line(1), 5U);
  }
}

TEST(TextTable, WordsForNoValue) {
  for (const char* word :
       {"", "nan", "NaN", "NAN", "NULL", "null", "None", "N/A", "n/a", "NA", "#N/A", "-", "--"})
    EXPECT_TRUE(is_missing_cell(word)) << word;
  for (const char* word : {"0", "nano", "none of it", "-1", "."}) EXPECT_FALSE(is_missing_cell(word)) << word;
}

TEST(TextTable, CommentsAreKeptApart) {
  const TextTable table = read("# rover: x\na,b\n1,2\n# end\n", {.comment = '#'});
  EXPECT_EQ(table.names(), (Cells{"a", "b"}));
  EXPECT_EQ(table.rows(), 1U);
  ASSERT_EQ(table.comments().size(), 2U);
  EXPECT_EQ(table.comments()[1].number, 4U);
}

TEST(TextTable, WhatIsNoTextIsRefusedWithItsPlace) {
  EXPECT_FALSE(read_text_table(std::string("II*\0\x08\0\0\0abc", 11), "t.tif").has_value());
  const auto open = read_text_table("a,b\n1,\"2\n3,4\n", "t.csv");
  ASSERT_FALSE(open.has_value());
  ASSERT_EQ(open.error().faults.size(), 1U);
  EXPECT_EQ(open.error().faults[0].pointer, "t.csv, line 2");
  EXPECT_TRUE(read("").names().empty());
  EXPECT_TRUE(read("\n\n").names().empty());
}

TEST(TextTable, ColumnsAreFoundByTheirNames) {
  std::vector<Fault> faults;
  const CsvHeader header = find_columns(read("b;a\n1;2\n"), "t.csv", {"a", "b"}, faults);
  EXPECT_TRUE(faults.empty());
  EXPECT_EQ(header.places[0], 1U);
  find_columns(read("a b\n1 2\n"), "t.csv", {"a", "b"}, faults);
  ASSERT_EQ(faults.size(), 1U);
  EXPECT_NE(faults[0].message.find("separated by \" \""), std::string::npos);
}

}  // namespace
}  // namespace slipway
