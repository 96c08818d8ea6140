// Times and numbers as people read them.
#include <gtest/gtest.h>

#include "core/number_words.h"
#include "core/utc.h"

namespace slipway {
namespace {

TEST(UtcWords, HaveOneFormatToTheMinuteOrTheSecond) {
  const auto words = [](const char* time) { return utc_words(utc_of_text(time).value()); };
  EXPECT_EQ(words("2016-03-22T08:38:00Z"), "2016-03-22 08:38 UTC");
  EXPECT_EQ(words("2016-03-22T08:58:17Z"), "2016-03-22 08:58:17 UTC");
  EXPECT_EQ(words("2016-03-22T08:58:16.875Z"), "2016-03-22 08:58:17 UTC");
  EXPECT_EQ(words("2016-03-22T08:59:59.900Z"), "2016-03-22 09:00 UTC");
  EXPECT_EQ(words("1969-12-31T23:59:30Z"), "1969-12-31 23:59:30 UTC");
}

TEST(UtcWords, AnArrivalIsToldNoEarlierThanItIs) {
  EXPECT_EQ(minute_after(0), 0);
  EXPECT_EQ(minute_after(1), 60'000);
  EXPECT_EQ(minute_after(60'000), 60'000);
  EXPECT_EQ(minute_after(-1), 0);
}

TEST(SpanWords, TellNoMoreThanThereIs) {
  EXPECT_EQ(span_words(17.9), "17 s");
  EXPECT_EQ(span_words(-44.5 * 60.0), "44 min");
  EXPECT_EQ(span_words(3.99 * 3600.0), "3.9 h");
}

TEST(PlainNumber, HasNoPowerOfTen) {
  EXPECT_EQ(plain_number(0.6194), "0.619");
  EXPECT_EQ(plain_number(12.0), "12");
  EXPECT_EQ(plain_number(999.7), "1000");
  EXPECT_EQ(plain_number(-8142566.4), "-8142566");
}

TEST(NumberBeside, CanBeToldFromTheOther) {
  EXPECT_EQ(number_beside(9.99812, 10.0, 2), "9.998");
  EXPECT_EQ(number_beside(3.0, 10.0, 2), "3.00");
  EXPECT_EQ(number_beside(10.0, 10.0, 2), "10.00");
}

}  // namespace
}  // namespace slipway
