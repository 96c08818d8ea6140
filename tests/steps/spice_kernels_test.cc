// The readers of SPICE's kernels, by small kernels made here.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "daf_writer.h"
#include "steps/spice_ck.h"
#include "steps/spice_clock.h"
#include "steps/spice_daf.h"
#include "steps/spice_spk.h"

namespace slipway::steps {
namespace {

std::string fault_of(const Error& error) {
  EXPECT_EQ(error.code, ErrorCode::kUnreadableData);
  EXPECT_FALSE(error.faults.empty());
  return error.faults.empty() ? "" : error.faults[0].pointer + ": " + error.faults[0].message;
}

// Reads all of a file; its first fault, or nothing.
std::string first_fault(const std::string& bytes) {
  const auto daf = DafFile::read(bytes, "made");
  if (!daf) return fault_of(daf.error());
  for (const DafArray& array : daf->arrays()) {
    if (daf->kind() == DafKind::kSpk && has_polynomials(array)) {
      if (const auto read = read_spk_polynomials(*daf, array); !read) return fault_of(read.error());
    } else if (daf->kind() == DafKind::kSpk) {
      if (const auto read = read_spk_segment(*daf, array); !read) return fault_of(read.error());
    } else {
      if (const auto read = read_ck_segment(*daf, array); !read) return fault_of(read.error());
    }
  }
  return "";
}

void expect_fault(const std::string& bytes, const std::string& part) {
  EXPECT_NE(first_fault(bytes).find(part), std::string::npos) << first_fault(bytes) << "\n" << part;
}

std::vector<made::State> line_of_states(std::size_t n) {
  std::vector<made::State> states;
  for (std::size_t k = 0; k < n; ++k)
    states.push_back({1000.0 + 10.0 * static_cast<double>(k), {static_cast<double>(k), -2.5, 0.125}});
  return states;
}

std::array<double, 3> cubic_km(double et_s) {
  const double t = et_s / 10.0;
  return {1.0 + t, t * t - 3.0, 0.5 * t * t * t - t};
}

std::vector<made::Pointing> turning(std::size_t n, double rad_each) {
  std::vector<made::Pointing> records;
  for (std::size_t k = 0; k < n; ++k) {
    const double half = 0.5 * rad_each * static_cast<double>(k);
    records.push_back(
        {65536.0 * static_cast<double>(k), {std::cos(half), 0.0, 0.0, -std::sin(half)}, {}, 0.0});
  }
  return records;
}

double heading_rad(const Eigen::Quaterniond& q) {
  const Eigen::Matrix3d level_to_body = q.toRotationMatrix();
  return std::atan2(level_to_body(0, 1), level_to_body(0, 0));
}

TEST(SpiceDaf, SegmentsOfBothByteOrdersOverSeveralSummaryRecords) {
  for (const bool big : {false, true}) {
    std::vector<made::Array> arrays;
    for (std::size_t n = 1; n < 8; ++n) arrays.push_back(made::spk(9, line_of_states(n)));
    const std::string bytes = made::daf("DAF/SPK ", arrays, big, 3);
    const auto daf = DafFile::read(bytes, "made");
    ASSERT_TRUE(daf) << fault_of(daf.error());
    EXPECT_EQ(daf->kind(), DafKind::kSpk);
    ASSERT_EQ(daf->arrays().size(), arrays.size());
    for (std::size_t k = 0; k < arrays.size(); ++k) {
      EXPECT_EQ(daf->arrays()[k].name, "MSL wrt site");
      EXPECT_EQ(daf->arrays()[k].whole, arrays[k].whole);
      EXPECT_EQ(daf->words_of(daf->arrays()[k]), arrays[k].words);
    }
  }
}

TEST(SpiceDaf, AnOldFileIsToldByItsSummaries) {
  const auto spk = made::daf("NAIF/DAF", {made::spk(8, line_of_states(2), -76900, 499, 10014)}, false);
  EXPECT_EQ(DafFile::read(spk, "made")->kind(), DafKind::kSpk);
  const auto ck = made::daf("NAIF/DAF", {made::ck(3, turning(2, 0.1), true, {0.0})}, false);
  EXPECT_EQ(DafFile::read(ck, "made")->kind(), DafKind::kCk);
}

TEST(SpiceDaf, WhatIsWrongIsToldWithItsByte) {
  const std::string good = made::daf("DAF/SPK ", {made::spk(9, line_of_states(3))}, true);
  ASSERT_EQ(first_fault(good), "");
  const auto with = [&good](std::size_t at, const std::string& bytes) {
    std::string changed = good;
    changed.replace(at, bytes.size(), bytes);
    return changed;
  };
  const auto number = [](double value) {
    std::string bytes;
    made::put(bytes, value, true);
    return bytes;
  };
  const auto whole = [](std::int32_t value) {
    std::string bytes;
    made::put(bytes, value, true);
    return bytes;
  };
  expect_fault(with(0, "DAF/PCK "), "made, byte 0: neither DAF/SPK nor DAF/CK");
  expect_fault(with(8, whole(3)), "made, byte 8: a summary must have 2 numbers");
  expect_fault(with(76, whole(99)), "byte 76: a summary record that is not in the file");
  expect_fault(with(76, whole(-2)), "byte 76: a summary record that is not in the file");
  expect_fault(with(76, whole(0)), "byte 76: the file has no array");
  expect_fault(with(88, "VAX-GFLT"), "byte 88: the byte order is neither");
  expect_fault(with(706, "\n\n"), "byte 699: a transfer as text");
  expect_fault(with(1024, number(2.0)), "byte 1024: the chain of summary records runs in a circle");
  expect_fault(with(1024, number(2.5)), "byte 1024: a summary record that is not in the file");
  expect_fault(with(1024, number(std::nan(""))), "byte 1024: a summary record that is not in the file");
  expect_fault(with(1024, number(3.0)), "byte 2056: the summary record does not name the one before it");
  expect_fault(with(1032, number(7.0)), "byte 1032: the summary record does not name the one before it");
  expect_fault(with(1040, number(26.0)), "byte 1040: the number of summaries must be whole, from 0 to 25");
  expect_fault(with(1040, number(-1.0)), "byte 1040: the number of summaries");
  expect_fault(with(1040, number(1e300)), "byte 1040: the number of summaries");
  expect_fault(with(1048, number(INFINITY)), "byte 1048: a time is no finite number");
  expect_fault(with(1080, whole(1)), "byte 1080: the array has words 1 to");
  expect_fault(with(1080, whole(INT32_MIN)), "byte 1080: the array has words");
  expect_fault(with(1084, whole(INT32_MAX)), "byte 1080: the array has words");
  expect_fault(with(1084, whole(385)), "segment \"MSL wrt site\"");
  std::string twice = with(1040, number(2.0));
  twice.replace(1088, 40, twice.substr(1048, 40));
  expect_fault(twice, "byte 3072: two arrays share words");
}

// The last words of an array and the file's length are told by different parts of it; each of them must
// notice.
TEST(SpiceDaf, AFileThatIsCutShortIsRefusedAtEveryLength) {
  for (const bool big : {false, true}) {
    const std::string spk =
        made::daf("DAF/SPK ", {made::spk(9, line_of_states(12)), made::spk(13, line_of_states(9))}, big);
    const std::string ck = made::daf("DAF/CK  ", {made::ck(3, turning(15, 0.1), true, {0.0})}, big);
    const std::string polynomials =
        made::daf("DAF/SPK ", {made::chebyshev(2, 301, 399, 0.0, 10.0, 9, 5, cubic_km)}, big);
    for (const std::string& whole : {spk, ck, polynomials}) {
      ASSERT_EQ(first_fault(whole), "");
      for (std::size_t length = 0; length < whole.size(); ++length)
        ASSERT_NE(first_fault(whole.substr(0, length)), "") << length;
    }
  }
}

// Every byte is changed in turn: what is read then is numbers, or a fault with its place, and nothing
// crashes.
TEST(SpiceDaf, AFileWithAChangedByteIsReadOrRefused) {
  const std::string spk = made::daf("DAF/SPK ", {made::spk(9, line_of_states(3))}, false);
  const std::string ck = made::daf("DAF/CK  ", {made::ck(3, turning(3, 0.1), false, {0.0})}, true);
  const std::string polynomials =
      made::daf("DAF/SPK ", {made::chebyshev(3, 301, 399, 0.0, 10.0, 3, 4, cubic_km)}, false);
  for (const std::string& whole : {spk, ck, polynomials})
    for (std::size_t at = 0; at < whole.size(); ++at)
      for (const char change : {'\x00', '\x7F', '\xFF', '\x01'}) {
        std::string changed = whole;
        changed[at] = change;
        first_fault(changed);
      }
}

TEST(SpiceSpk, StatesOfTypes8And9And13) {
  for (const bool big : {false, true})
    for (const int type : {8, 9, 13})
      for (const std::size_t n : {1U, 2U, 100U, 101U, 250U}) {
        const std::string bytes = made::daf("DAF/SPK ", {made::spk(type, line_of_states(n))}, big);
        const auto daf = DafFile::read(bytes, "made");
        ASSERT_TRUE(daf);
        const auto segment = read_spk_segment(*daf, daf->arrays()[0]);
        ASSERT_TRUE(segment) << fault_of(segment.error());
        EXPECT_EQ(segment->target, -76);
        EXPECT_EQ(segment->centre, -76505);
        EXPECT_EQ(segment->frame, -76910);
        ASSERT_EQ(segment->states.size(), n);
        const SpkState& last = segment->states.back();
        EXPECT_DOUBLE_EQ(last.et_s, 1000.0 + 10.0 * static_cast<double>(n - 1));
        EXPECT_NEAR(last.position_m[0], static_cast<double>(n - 1), 1e-9);
        EXPECT_NEAR(last.position_m[1], -2.5, 1e-9);
        EXPECT_NEAR(last.position_m[2], 0.125, 1e-9);
      }
}

TEST(SpiceSpk, StatesThatCanNotBe) {
  const auto changed = [](int type, auto change) {
    made::Array array = made::spk(type, line_of_states(3));
    change(array.words);
    return made::daf("DAF/SPK ", {array}, true);
  };
  using Words = std::vector<double>;
  expect_fault(changed(9, [](Words& w) { w.back() = 4.0; }),
               "byte 3248: segment \"MSL wrt site\": the number of states");
  expect_fault(changed(9, [](Words& w) { w.back() = 1e300; }), "the number of states does not fit");
  expect_fault(changed(9, [](Words& w) { w.back() = -3.0; }), "the number of states does not fit");
  expect_fault(changed(9, [](Words& w) { w.back() = NAN; }), "the number of states does not fit");
  expect_fault(changed(8, [](Words& w) { w.back() = 2.0; }), "the number of states does not fit");
  expect_fault(changed(9, [](Words& w) { w[1] = NAN; }),
               "byte 3080: segment \"MSL wrt site\": a position is no number");
  expect_fault(changed(9, [](Words& w) { w[19] = 1.0; }),
               "byte 3224: segment \"MSL wrt site\": a time is before");
  expect_fault(changed(13, [](Words& w) { w[19] = INFINITY; }), "a time is no number or beyond 1e12 s");
  expect_fault(changed(9, [](Words& w) { w[0] = 1e13; }), "or beyond the solar system");
  expect_fault(changed(8, [](Words& w) { w[19] = -1.0; }), "a time is before the one that precedes it");
  made::Array other = made::spk(9, line_of_states(3));
  other.whole[3] = 5;
  expect_fault(made::daf("DAF/SPK ", {other}, true), "only SPK types 8, 9 and 13 are read");
}

TEST(SpiceSpk, EqualTimesStayInTheOrderOfTheFile) {
  const std::string bytes =
      made::daf("DAF/SPK ", {made::spk(9, {{5.0, {1.0, 0, 0}}, {5.0, {2.0, 0, 0}}})}, true);
  const auto daf = DafFile::read(bytes, "made");
  const auto segment = read_spk_segment(*daf, daf->arrays()[0]);
  ASSERT_TRUE(segment);
  EXPECT_NEAR(segment->states[1].position_m[0], 2.0, 1e-12);
}

// The one segment of a kernel that is made of it.
template <class Segment>
Segment segment_of(const char* kind, const made::Array& array, bool big_endian,
                   Result<Segment> (*read)(const DafFile&, const DafArray&)) {
  const std::string bytes = made::daf(kind, {array}, big_endian);
  const auto daf = DafFile::read(bytes, "made");
  EXPECT_TRUE(daf);
  auto segment = read(*daf, daf->arrays()[0]);
  EXPECT_TRUE(segment) << (segment ? "" : fault_of(segment.error()));
  return segment ? *std::move(segment) : Segment{};
}

SpkPolynomials polynomials_of(const made::Array& array, bool big_endian) {
  return segment_of("DAF/SPK ", array, big_endian, &read_spk_polynomials);
}

// A cubic is met by four coefficients, in every interval and on both of its ends; its derivative is the
// velocity, whatever a type 3 says of it.
TEST(SpiceSpk, PolynomialsOfTypes2And3) {
  for (const bool big : {false, true})
    for (const int type : {2, 3})
      for (const std::size_t coefficients : {4U, 7U}) {
        const SpkPolynomials of =
            polynomials_of(made::chebyshev(type, 301, 399, -20.0, 10.0, 6, coefficients, cubic_km), big);
        EXPECT_EQ(of.target, 301);
        EXPECT_EQ(of.centre, 399);
        EXPECT_EQ(of.frame, 1);
        for (double et_s = -20.0; et_s <= 40.0; et_s += 0.625) {
          const SpkMotion motion = of.at(et_s);
          const auto km = cubic_km(et_s);
          for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(motion.position_m[c], 1000.0 * km[static_cast<std::size_t>(c)], 1e-8) << et_s;
          EXPECT_NEAR(motion.velocity_m_s.x(), 100.0, 1e-8);
          EXPECT_NEAR(motion.velocity_m_s.y(), 200.0 * et_s / 10.0, 1e-8);
          EXPECT_NEAR(motion.velocity_m_s.z(), 150.0 * et_s * et_s / 100.0 - 100.0, 1e-8);
        }
      }
}

// What runs backwards has the same places and the opposite velocities.
TEST(SpiceSpk, PolynomialsAreTheSameBackwards) {
  const auto turning_km = [](double et_s) {
    return std::array<double, 3>{std::cos(et_s / 30.0), std::sin(et_s / 30.0), std::sin(et_s / 50.0)};
  };
  const SpkPolynomials forth =
      polynomials_of(made::chebyshev(2, 301, 399, 5.0, 20.0, 5, 12, turning_km), true);
  const SpkPolynomials back = polynomials_of(
      made::chebyshev(2, 301, 399, -105.0, 20.0, 5, 12, [&](double et_s) { return turning_km(-et_s); }),
      true);
  for (double et_s = 5.0; et_s <= 105.0; et_s += 0.5) {
    const SpkMotion there = forth.at(et_s), mirrored = back.at(-et_s);
    EXPECT_LT((there.position_m - mirrored.position_m).norm(), 1e-6) << et_s;
    EXPECT_LT((there.velocity_m_s + mirrored.velocity_m_s).norm(), 1e-6) << et_s;
  }
}

// A step between two intervals is the later one's.
TEST(SpiceSpk, TheLaterIntervalSaysWhereTwoMeet) {
  made::Array array = made::chebyshev(2, 301, 399, 0.0, 10.0, 2, 1, [](double et_s) {
    return std::array<double, 3>{et_s < 10.0 ? 1.0 : 2.0, 0.0, 0.0};
  });
  const SpkPolynomials of = polynomials_of(array, false);
  EXPECT_EQ(of.at(std::nextafter(10.0, 0.0)).position_m.x(), 1000.0);
  EXPECT_EQ(of.at(10.0).position_m.x(), 2000.0);
  EXPECT_EQ(of.at(20.0).position_m.x(), 2000.0);
}

TEST(SpiceSpk, PolynomialsThatCanNotBe) {
  const auto changed = [](auto change) {
    made::Array array = made::chebyshev(2, 301, 399, 0.0, 10.0, 3, 4, cubic_km);
    change(array);
    return made::daf("DAF/SPK ", {array}, true);
  };
  using Array = made::Array;
  const std::size_t last = 3 * 14;  // first of the four words behind the intervals
  ASSERT_EQ(first_fault(changed([](Array&) {})), "");
  for (const double count : {4.0, 2.0, 0.0, -3.0, 2.5, 1e300, double(NAN)})
    expect_fault(changed([&](Array& a) { a.words[last + 3] = count; }),
                 "byte 3432: segment \"made of a series\": the number of intervals does not fit");
  for (const double words : {13.0, 15.0, 0.0, -1.0, double(NAN), double(INFINITY)})
    expect_fault(changed([&](Array& a) { a.words[last + 2] = words; }),
                 "the number of intervals does not fit");
  for (const double length : {0.0, 1e-300, -10.0, double(NAN), double(INFINITY)})
    expect_fault(changed([&](Array& a) { a.words[last + 1] = length; }),
                 "byte 3416: segment \"made of a series\": the length of the intervals must be 0.001 s to");
  for (const double first : {double(NAN), 1e300, -double(INFINITY)})
    expect_fault(changed([&](Array& a) { a.words[last] = first; }), "a time is no number or beyond 1e12 s");
  for (const double moved : {1.0, double(NAN), double(INFINITY)}) {
    expect_fault(changed([&](Array& a) { a.words[14] = moved; }),
                 "byte 3184: segment \"made of a series\": an interval is not where");
    expect_fault(changed([&](Array& a) { a.words[15] = moved; }), "an interval is not where");
  }
  for (const double coefficient : {double(NAN), -double(INFINITY), 1e13})
    expect_fault(changed([&](Array& a) { a.words[15 + 5] = coefficient; }),
                 "byte 3232: segment \"made of a series\": a coefficient is no number or beyond");
  expect_fault(changed([](Array& a) { a.numbers[0] = -1.0; }), "the segment's times go beyond its intervals");
  expect_fault(changed([](Array& a) { a.numbers[1] = 31.0; }), "the segment's times go beyond its intervals");
  expect_fault(changed([](Array& a) { std::swap(a.numbers[0], a.numbers[1]); }), "go beyond its intervals");
  made::Array five = made::chebyshev(2, 301, 399, 0.0, 10.0, 3, 5, cubic_km);
  five.whole[3] = 3;
  expect_fault(made::daf("DAF/SPK ", {five}, true), "the number of coefficients does not fit");
  expect_fault(changed([](Array& a) { a.words.resize(4); }), "the segment has no interval");
}

CkSegment attitudes(const made::Array& array, bool big) {
  return segment_of("DAF/CK  ", array, big, &read_ck_segment);
}

TEST(SpiceCk, Type3IsInterpolatedWithinItsIntervals) {
  for (const bool big : {false, true})
    for (const bool rates : {false, true})
      for (const std::size_t n : {4U, 101U, 230U}) {
        const CkSegment segment = attitudes(made::ck(3, turning(n, 0.01), rates, {0.0, 2 * 65536.0}), big);
        ASSERT_EQ(segment.records.size(), n);
        EXPECT_NEAR(heading_rad(*attitude_at(segment, 0.5 * 65536.0, 0.0)), 0.005, 1e-12);
        EXPECT_FALSE(attitude_at(segment, 1.5 * 65536.0, 0.0));
        EXPECT_NEAR(heading_rad(*attitude_at(segment, 2.25 * 65536.0, 0.0)), 0.0225, 1e-12);
        EXPECT_NEAR(heading_rad(*attitude_at(segment, 1.5 * 65536.0, 0.5 * 65536.0)), 0.01, 1e-12);
        EXPECT_FALSE(attitude_at(segment, -1.0, 0.0));
        EXPECT_TRUE(attitude_at(segment, -1.0, 1.0));
        EXPECT_FALSE(attitude_at(segment, 65536.0 * static_cast<double>(n), 0.0));
      }
}

TEST(SpiceCk, Type1HoldsAtItsInstantsAlone) {
  for (const bool rates : {false, true}) {
    const CkSegment segment = attitudes(made::ck(1, turning(130, 0.01), rates), true);
    ASSERT_EQ(segment.records.size(), 130U);
    EXPECT_NEAR(heading_rad(*attitude_at(segment, 129 * 65536.0, 0.0)), 1.29, 1e-12);
    EXPECT_NEAR(heading_rad(*attitude_at(segment, 65536.0 + 9.0, 10.0)), 0.01, 1e-12);
    EXPECT_FALSE(attitude_at(segment, 65536.0 + 11.0, 10.0));
  }
}

TEST(SpiceCk, Type2TurnsAtAConstantRateWithinItsIntervals) {
  for (const std::size_t n : {1U, 3U, 120U}) {
    std::vector<made::Pointing> records = turning(n, 0.1);
    for (made::Pointing& record : records) {
      record.rate_rad_s = {0.0, 0.0, 0.02};  // clockwise about down: the heading grows
      record.end_tick = record.tick + 0.5 * 65536.0;
    }
    const CkSegment segment = attitudes(made::ck(2, records, true), false);
    ASSERT_EQ(segment.records.size(), n);
    EXPECT_NEAR(heading_rad(*attitude_at(segment, 0.25 * 65536.0, 0.0)), 0.005, 1e-12);
    EXPECT_FALSE(attitude_at(segment, 0.75 * 65536.0, 0.0));
    if (n > 1) {
      EXPECT_NEAR(heading_rad(*attitude_at(segment, 1.25 * 65536.0, 0.0)), 0.105, 1e-12);
    }
  }
}

TEST(SpiceCk, AttitudesThatCanNotBe) {
  const auto changed = [](int type, auto change) {
    std::vector<made::Pointing> records = turning(3, 0.1);
    for (made::Pointing& record : records) record.end_tick = record.tick + 9.0;
    made::Array array = made::ck(type, records, false, {0.0, 65536.0});
    change(array.words);
    return made::daf("DAF/CK  ", {array}, true);
  };
  using Words = std::vector<double>;
  ASSERT_EQ(first_fault(changed(3, [](Words&) {})), "");
  expect_fault(changed(3, [](Words& w) { w.back() = 4.0; }),
               "the number of records does not fit the segment");
  expect_fault(changed(3, [](Words& w) { w[w.size() - 2] = 1e9; }), "the number of records does not fit");
  expect_fault(changed(3, [](Words& w) { w[w.size() - 2] = 0.0; }), "the number of records does not fit");
  expect_fault(changed(1, [](Words& w) { w.back() = NAN; }), "the number of records does not fit");
  expect_fault(changed(2, [](Words& w) { w.push_back(0.0); }), "the number of records does not fit");
  expect_fault(changed(3, [](Words& w) { w[4] = 3.0; }),
               "byte 3104: segment \"MSL wrt level\": a quaternion is not of");
  expect_fault(changed(3, [](Words& w) { w[4] = NAN; }), "a quaternion is not of unit length");
  expect_fault(changed(3, [](Words& w) { w[13] = 0.0; }),
               "byte 3176: segment \"MSL wrt level\": a tick is not above");
  expect_fault(changed(3, [](Words& w) { w[12] = -INFINITY; }), "a tick is no number or beyond 1e18");
  expect_fault(changed(3, [](Words& w) { w[16] = 0.0; }), "starts of intervals must rise");
  expect_fault(changed(2, [](Words& w) { w[5] = NAN; }), "a rate is no number or beyond 1e9 rad");
  expect_fault(changed(2, [](Words& w) { w[28] = -1.0; }), "an interval ends before it starts");
  made::Array other = made::ck(3, turning(3, 0.1), false, {0.0});
  other.whole[2] = 5;
  expect_fault(made::daf("DAF/CK  ", {other}, true), "only CK types 1, 2 and 3 are read");
}

TEST(SpiceClock, TicksBecomeEphemerisTimeAndBack) {
  const std::string text =
      "KPL/SCLK\nSCLK_DATA_TYPE_76 = ( 9 )  of the comments\n\\begindata\n"
      "SCLK_KERNEL_ID = ( @2013-10-22/00:10:02.00 )\nSCLK_DATA_TYPE_76=(1)\nSCLK01_TIME_SYSTEM_76 = ( 2 )\n"
      "SCLK01_MODULI_76 = ( 4294967296, 65536 )\nSCLK01_COEFFICIENTS_76 = (\n 0.0D+00 100.0 1.0\n"
      " 6553600.0E0 200.0 2.0 )\nSCLK01_COEFFICIENTS_76 += ( 13107200 400 1.5 )\n\\begintext\nnothing (\n";
  const auto clock = read_spacecraft_clock(text, "clock.tsc", 76);
  ASSERT_TRUE(clock) << fault_of(clock.error());
  ASSERT_EQ(clock->coefficients.size(), 3U);
  for (const double tick : {-65536.0, 0.0, 3276800.0, 6553600.0, 9830400.0, 13107200.0, 2e9})
    EXPECT_NEAR(clock->tick_of(clock->et_of(tick)), tick, 0.01) << tick;
  // TDB less TDT is below 2 ms.
  EXPECT_NEAR(clock->et_of(9830400.0), 300.0, 0.002);
  EXPECT_NE(clock->et_of(9830400.0), 300.0);
}

TEST(SpiceClock, WhatIsWrongIsToldWithItsLine) {
  const auto fault = [](std::string from, std::string to) {
    std::string text = made::kClock;
    text.replace(text.find(from), from.size(), to);
    const auto clock = read_spacecraft_clock(text, "clock.tsc", 76);
    return clock ? std::string("it was read") : fault_of(clock.error());
  };
  EXPECT_EQ(fault("KPL", "KPL"), "it was read");
  EXPECT_EQ(fault("SCLK_DATA_TYPE_76", "SCLK_DATA_TYPE_77"), "clock.tsc: there is no SCLK_DATA_TYPE_76");
  EXPECT_EQ(fault("_76 = ( 1 )\nSCLK01_T", "_76 = ( 2 )\nSCLK01_T"),
            "clock.tsc: the clock is not of SCLK type 1");
  EXPECT_EQ(fault("SYSTEM_76 = ( 1 )", "SYSTEM_76 = ( 3 )"),
            "clock.tsc: the parallel time must be TDB (1) or TDT (2)");
  EXPECT_EQ(fault("65536", "0"), "clock.tsc: the moduli of the clock's fields must be 1 or more");
  EXPECT_EQ(fault("0.0 0.0 1.0", "0.0 0.0"),
            "clock.tsc, line 6: SCLK01_COEFFICIENTS_76 has 2 numbers, must have 3 or more");
  EXPECT_EQ(fault("0.0 0.0 1.0", "0 0 1 2"),
            "clock.tsc, line 6: SCLK01_COEFFICIENTS_76 has 4 numbers, must have three in each row");
  EXPECT_EQ(fault("0.0 0.0 1.0", "0.0 x 1.0"),
            "clock.tsc, line 6: SCLK01_COEFFICIENTS_76: \"x\" is no number");
  EXPECT_EQ(
      fault("0.0 0.0 1.0", "0 0 0"),
      "clock.tsc, line 6: SCLK01_COEFFICIENTS_76, row 1: ticks and times must rise and the rate be above 0");
  EXPECT_EQ(fault("0.0 0.0 1.0 )", "0.0 0.0 1.0"),
            "clock.tsc, line 6: the values of \"SCLK01_COEFFICIENTS_76\" have no end");
  EXPECT_EQ(fault("MODULI_76 =", "MODULI_76"),
            "clock.tsc, line 5: \"SCLK01_MODULI_76\" is no assignment NAME = value");
  EXPECT_EQ(fault("( 1 )", "( '1 )"), "clock.tsc, line 3: a string has no closing quote");
}

TEST(SpiceClock, ConstantsOfLeapSecondKernels) {
  const std::string text =
      "KPL/LSK\n\\begindata\nDELTET/K = 1.657D-3\nDELTET/EB = 1.671D-2\nDELTET/M = ( 6.239996D0 "
      "1.99096871D-7 )\n"
      "DELTET/DELTA_AT = ( 10, @1972-JAN-1 11, @1972-JUL-1 )\n";
  const auto time = read_leap_seconds(text, "naif.tls");
  ASSERT_TRUE(time) << fault_of(time.error());
  EXPECT_EQ(time->tdb_of(4e8), EphemerisTime().tdb_of(4e8));
  EXPECT_FALSE(read_leap_seconds("KPL/LSK\n\\begindata\nDELTET/K = 1\n", "naif.tls"));
  EXPECT_TRUE(looks_like_leap_seconds(text));
  EXPECT_FALSE(looks_like_clock(text));
}

}  // namespace
}  // namespace slipway::steps
