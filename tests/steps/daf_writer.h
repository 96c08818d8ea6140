#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

// Writes DAF files for tests, by NAIF's "DAF Required Reading" and without a line of what reads them.
namespace slipway::steps::made {

struct Array {
  std::string name;
  std::array<double, 2> numbers{};
  std::array<std::int32_t, 4> whole{};
  std::vector<double> words;
};

inline void put_bits(std::string& out, std::uint64_t bits, int bytes, bool big_endian) {
  for (int k = 0; k < bytes; ++k) {
    const int shift = 8 * (big_endian ? bytes - 1 - k : k);
    out += static_cast<char>((bits >> shift) & 0xFFU);
  }
}

inline void put(std::string& out, double value, bool big_endian) {
  put_bits(out, std::bit_cast<std::uint64_t>(value), 8, big_endian);
}

inline void put(std::string& out, std::int32_t value, bool big_endian) {
  put_bits(out, static_cast<std::uint32_t>(value), 4, big_endian);
}

// Summary records of `each` arrays, two records for each, then the words, as many as records need.
inline std::string daf(const std::string& id, const std::vector<Array>& arrays, bool big_endian,
                       std::size_t each = 25) {
  const std::size_t summaries = (arrays.size() + each - 1) / each;
  std::vector<std::int32_t> first;
  std::int32_t word = static_cast<std::int32_t>(128 * (1 + 2 * summaries)) + 1;
  for (const Array& array : arrays) {
    first.push_back(word);
    word += static_cast<std::int32_t>(array.words.size());
  }
  std::string out = id;
  put(out, std::int32_t{2}, big_endian);
  put(out, std::int32_t{6}, big_endian);
  out.resize(76, ' ');
  put(out, std::int32_t{2}, big_endian);
  put(out, static_cast<std::int32_t>(2 * summaries), big_endian);
  put(out, word, big_endian);
  out += big_endian ? "BIG-IEEE" : "LTL-IEEE";
  out.resize(699, '\0');
  out += std::string("FTPSTR:\r:\n:\r\n:\r\0:\x81:\x10\xCE:ENDFTP", 28);
  out.resize(1024, '\0');
  for (std::size_t s = 0; s < summaries; ++s) {
    const std::size_t begin = s * each, end = std::min(arrays.size(), begin + each);
    put(out, s + 1 < summaries ? static_cast<double>(2 + 2 * (s + 1)) : 0.0, big_endian);
    put(out, s > 0 ? static_cast<double>(2 + 2 * (s - 1)) : 0.0, big_endian);
    put(out, static_cast<double>(end - begin), big_endian);
    for (std::size_t k = begin; k < end; ++k) {
      for (const double number : arrays[k].numbers) put(out, number, big_endian);
      for (const std::int32_t whole : arrays[k].whole) put(out, whole, big_endian);
      put(out, first[k], big_endian);
      put(out, first[k] + static_cast<std::int32_t>(arrays[k].words.size()) - 1, big_endian);
    }
    out.resize(1024 * (2 + 2 * s), '\0');
    for (std::size_t k = begin; k < end; ++k) {
      std::string name = arrays[k].name;
      name.resize(40, ' ');
      out += name;
    }
    out.resize(1024 * (3 + 2 * s), '\0');
  }
  for (const Array& array : arrays)
    for (const double value : array.words) put(out, value, big_endian);
  out.resize((out.size() + 1023) / 1024 * 1024, '\0');
  return out;
}

struct State {
  double et_s = 0.0;
  std::array<double, 3> m{};
};

// SPK type 8, 9 or 13 of body -76 from site 5; type 8 has the first two times' step.
inline Array spk(int type, const std::vector<State>& states, std::int32_t target = -76,
                 std::int32_t centre = -76505, std::int32_t frame = -76910) {
  Array array{"MSL wrt site", {states.front().et_s, states.back().et_s}, {target, centre, frame, type}, {}};
  for (const State& state : states)
    for (std::size_t c = 0; c < 6; ++c) array.words.push_back(c < 3 ? state.m[c] / 1000.0 : 0.0);
  if (type == 8) {
    array.words.push_back(states.front().et_s);
    array.words.push_back(states.size() > 1 ? states[1].et_s - states[0].et_s : 1.0);
  } else {
    for (const State& state : states) array.words.push_back(state.et_s);
    for (std::size_t k = 99; k + 1 < states.size(); k += 100) array.words.push_back(states[k].et_s);
  }
  array.words.push_back(1.0);
  array.words.push_back(static_cast<double>(states.size()));
  return array;
}

// SPK type 2 or 3 in the frame of J2000, of a body whose place in km is a function of TDB seconds past J2000:
// the Chebyshev sums that meet it at their nodes.
template <class Place>
Array chebyshev(int type, std::int32_t target, std::int32_t centre, double first_s, double interval_s,
                std::size_t intervals, std::size_t coefficients, const Place& place_km) {
  Array array{"made of a series",
              {first_s, first_s + interval_s * static_cast<double>(intervals)},
              {target, centre, 1, type},
              {}};
  const double n = static_cast<double>(coefficients), half_s = 0.5 * interval_s;
  for (std::size_t k = 0; k < intervals; ++k) {
    const double middle_s = first_s + interval_s * (static_cast<double>(k) + 0.5);
    std::vector<double> record(2 + 3 * coefficients, 0.0);
    record[0] = middle_s;
    record[1] = half_s;
    for (std::size_t node = 0; node < coefficients; ++node) {
      const double angle = std::acos(-1.0) * (static_cast<double>(node) + 0.5) / n;
      const auto km = place_km(middle_s + half_s * std::cos(angle));
      for (std::size_t c = 0; c < 3; ++c)
        for (std::size_t j = 0; j < coefficients; ++j)
          record[2 + c * coefficients + j] +=
              (j == 0 ? 1.0 : 2.0) / n * km[c] * std::cos(static_cast<double>(j) * angle);
    }
    // Velocities of a type 3 that are not the positions': who looks at them is found out.
    if (type == 3) record.resize(2 + 6 * coefficients, 1e6);
    array.words.insert(array.words.end(), record.begin(), record.end());
  }
  for (const double word : {first_s, interval_s, static_cast<double>((type == 3 ? 6 : 3) * coefficients + 2),
                            static_cast<double>(intervals)})
    array.words.push_back(word);
  return array;
}

struct Pointing {
  double tick = 0.0;
  std::array<double, 4> q{1.0, 0.0, 0.0, 0.0};
  std::array<double, 3> rate_rad_s{};
  double end_tick = 0.0;  // type 2
};

inline Array ck(int type, const std::vector<Pointing>& records, bool rates,
                const std::vector<double>& starts = {}) {
  Array array{"MSL wrt level",
              {records.front().tick, records.back().tick},
              {-76000, -76910, type, rates ? 1 : 0},
              {}};
  if (type == 2) array.numbers[1] = records.back().end_tick;
  for (const Pointing& record : records) {
    array.words.insert(array.words.end(), record.q.begin(), record.q.end());
    if (rates || type == 2)
      array.words.insert(array.words.end(), record.rate_rad_s.begin(), record.rate_rad_s.end());
    if (type == 2) array.words.push_back(1.0 / 65536.0);
  }
  for (const Pointing& record : records) array.words.push_back(record.tick);
  if (type == 2)
    for (const Pointing& record : records) array.words.push_back(record.end_tick);
  for (std::size_t k = 99; k + 1 < records.size(); k += 100) array.words.push_back(records[k].tick);
  if (type == 3) {
    array.words.insert(array.words.end(), starts.begin(), starts.end());
    for (std::size_t k = 99; k + 1 < starts.size(); k += 100) array.words.push_back(starts[k]);
    array.words.push_back(static_cast<double>(starts.size()));
  }
  if (type != 2) array.words.push_back(static_cast<double>(records.size()));
  return array;
}

// A clock that counts 65,536 ticks a second from 0 at J2000, in TDB.
inline const std::string kClock =
    "KPL/SCLK\n\\begindata\nSCLK_DATA_TYPE_76 = ( 1 )\nSCLK01_TIME_SYSTEM_76 = ( 1 )\nSCLK01_MODULI_76 = "
    "( 4294967296 65536 )\nSCLK01_COEFFICIENTS_76 = ( 0.0 0.0 1.0 )\n\\begintext\n";

}  // namespace slipway::steps::made
