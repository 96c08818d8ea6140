#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"

// The container of SPICE's binary kernels, by NAIF's "DAF Required Reading": records of 1024 bytes, a file
// record, a chain of summary records, each followed by one of names, and arrays of double precision words.
namespace slipway::steps {

enum class DafKind { kSpk, kCk };

// An array of the file: two numbers and six whole numbers describe it, and it has words of its own.
struct DafArray {
  std::string name;
  std::array<double, 2> numbers{};      // of an SPK its times, of a CK its clock ticks: from, to
  std::array<std::int32_t, 4> whole{};  // of an SPK target, centre, frame, type; of a CK instrument,
                                        // reference, type, whether there are rates
  std::size_t first_byte = 0;           // of its words in the file
  std::size_t words = 0;
};

// A whole file. Every array lies in it, and no two share a word, so that decoding all of them takes no more
// memory than the file does.
class DafFile {
 public:
  // Errors: unreadable_data with the byte at which the file is wrong. The bytes must outlive the result.
  static Result<DafFile> read(std::string_view bytes, std::string_view file);

  DafKind kind() const { return kind_; }
  const std::vector<DafArray>& arrays() const { return arrays_; }
  const std::string& name() const { return file_; }
  // All words of one of its arrays.
  std::vector<double> words_of(const DafArray& array) const;
  // The fault of an array's words, which begin with word 0.
  tl::unexpected<Error> refuse(const DafArray& array, std::size_t word, std::string_view why) const;

 private:
  friend class DafReader;
  std::string_view bytes_;
  std::string file_;
  bool big_endian_ = false;
  DafKind kind_ = DafKind::kSpk;
  std::vector<DafArray> arrays_;
};

// Whether the bytes begin like such a file.
bool looks_like_daf(std::string_view bytes);

}  // namespace slipway::steps
