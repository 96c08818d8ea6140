#include "steps/spice_daf.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>
#include <utility>

namespace slipway::steps {
namespace {

constexpr std::size_t kRecord = 1024;
constexpr std::size_t kWord = 8;
constexpr std::size_t kWordsOfRecord = kRecord / kWord;
// Two numbers and six whole numbers, two of which share a word: SPK and CK alike.
constexpr std::int32_t kNumbers = 2;
constexpr std::int32_t kWholeNumbers = 6;
constexpr std::size_t kSummaryWords = 5;
constexpr std::size_t kSummariesOfRecord = (kWordsOfRecord - 3) / kSummaryWords;
// The file record: its name, the counts, the chain's ends, the byte order and what a text transfer would
// spoil.
constexpr std::size_t kCountsAt = 8;
constexpr std::size_t kFirstSummaryAt = 76;
constexpr std::size_t kFormatAt = 88;
constexpr std::size_t kTransferAt = 699;
constexpr std::string_view kTransferBegin = "FTPSTR";
constexpr std::string_view kTransfer("FTPSTR:\r:\n:\r\n:\r\0:\x81:\x10\xCE:ENDFTP", 28);

template <class Bits>
Bits bits_at(std::string_view bytes, std::size_t at, bool big_endian) {
  Bits value = 0;
  for (std::size_t k = 0; k < sizeof(Bits); ++k) {
    const std::size_t from = big_endian ? at + k : at + sizeof(Bits) - 1 - k;
    value = static_cast<Bits>((value << 8U) | static_cast<unsigned char>(bytes[from]));
  }
  return value;
}

double number_at(std::string_view bytes, std::size_t at, bool big_endian) {
  return std::bit_cast<double>(bits_at<std::uint64_t>(bytes, at, big_endian));
}

std::int32_t whole_at(std::string_view bytes, std::size_t at, bool big_endian) {
  return static_cast<std::int32_t>(bits_at<std::uint32_t>(bytes, at, big_endian));
}

std::string trimmed_name(std::string_view name) {
  std::string plain;
  for (const char c : name) plain += c >= ' ' && c <= '~' ? c : ' ';
  const std::size_t end = plain.find_last_not_of(' ');
  return plain.substr(0, end == std::string::npos ? 0 : end + 1);
}

}  // namespace

class DafReader {
 public:
  DafReader(std::string_view bytes, std::string_view file) {
    daf_.bytes_ = bytes;
    daf_.file_ = file;
  }

  Result<DafFile> read() {
    if (auto read = read_file_record(); !read) return fail(read.error());
    if (auto read = read_chain(); !read) return fail(read.error());
    if (daf_.arrays_.empty()) return refuse(kFirstSummaryAt, "the file has no array");
    if (auto whole = check_overlap(); !whole) return fail(whole.error());
    if (!kind_) kind_ = kind_of_summaries();
    daf_.kind_ = *kind_;
    return std::move(daf_);
  }

 private:
  tl::unexpected<Error> refuse(std::size_t byte, std::string_view why) const {
    return fail(ErrorCode::kUnreadableData, fmt::format("{} can't be read as a SPICE kernel", daf_.file_),
                {{fmt::format("{}, byte {}", daf_.file_, byte), std::string(why)}});
  }

  Result<void> read_file_record() {
    const std::string_view bytes = daf_.bytes_;
    if (bytes.size() < kRecord || bytes.size() % kRecord != 0)
      return refuse(bytes.size(), "the file ends within a record of 1024 bytes: it is cut short");
    const std::string_view id = bytes.substr(0, 8);
    if (id == "DAF/SPK ")
      kind_ = DafKind::kSpk;
    else if (id == "DAF/CK  ")
      kind_ = DafKind::kCk;
    else if (id != "NAIF/DAF")
      return refuse(0, "neither DAF/SPK nor DAF/CK");
    const std::string_view format = bytes.substr(kFormatAt, 8);
    if (format != "BIG-IEEE" && format != "LTL-IEEE")
      return refuse(kFormatAt, "the byte order is neither BIG-IEEE nor LTL-IEEE");
    daf_.big_endian_ = format == "BIG-IEEE";
    if (whole_at(bytes, kCountsAt, daf_.big_endian_) != kNumbers ||
        whole_at(bytes, kCountsAt + 4, daf_.big_endian_) != kWholeNumbers)
      return refuse(kCountsAt, "a summary must have 2 numbers and 6 whole numbers");
    if (bytes.substr(kTransferAt, kTransferBegin.size()) == kTransferBegin &&
        bytes.substr(kTransferAt, kTransfer.size()) != kTransfer)
      return refuse(kTransferAt, "a transfer as text has changed the file's bytes");
    return {};
  }

  // A summary record names the next one and the one before; it holds at most 25 summaries.
  Result<void> read_chain() {
    const std::size_t records = daf_.bytes_.size() / kRecord;
    std::vector<bool> seen(records + 1, false);
    double before = 0.0;
    double record = whole_at(daf_.bytes_, kFirstSummaryAt, daf_.big_endian_);
    std::size_t named_at = kFirstSummaryAt;
    while (record != 0.0) {
      // A record of names follows.
      if (!(record >= 2.0 && record + 1.0 <= static_cast<double>(records)) || record != std::floor(record))
        return refuse(named_at, "a summary record that is not in the file");
      const auto number = static_cast<std::size_t>(record);
      if (seen[number]) return refuse(named_at, "the chain of summary records runs in a circle");
      seen[number] = true;
      const std::size_t at = (number - 1) * kRecord;
      if (number_at(daf_.bytes_, at + kWord, daf_.big_endian_) != before)
        return refuse(at + kWord, "the summary record does not name the one before it");
      if (auto read = read_summaries(at); !read) return read;
      before = record;
      named_at = at;
      record = number_at(daf_.bytes_, at, daf_.big_endian_);
    }
    return {};
  }

  Result<void> read_summaries(std::size_t at) {
    const double count = number_at(daf_.bytes_, at + 2 * kWord, daf_.big_endian_);
    if (!(count >= 0.0 && count <= static_cast<double>(kSummariesOfRecord)) || count != std::floor(count))
      return refuse(at + 2 * kWord, "the number of summaries must be whole, from 0 to 25");
    for (std::size_t k = 0; k < static_cast<std::size_t>(count); ++k) {
      const std::size_t summary = at + (3 + k * kSummaryWords) * kWord;
      const std::size_t name = at + kRecord + k * kSummaryWords * kWord;
      DafArray array;
      array.name = trimmed_name(daf_.bytes_.substr(name, kSummaryWords * kWord));
      for (std::size_t n = 0; n < array.numbers.size(); ++n) {
        array.numbers[n] = number_at(daf_.bytes_, summary + n * kWord, daf_.big_endian_);
        if (!std::isfinite(array.numbers[n]))
          return refuse(summary + n * kWord, "a time is no finite number");
      }
      const std::size_t whole = summary + array.numbers.size() * kWord;
      for (std::size_t n = 0; n < array.whole.size(); ++n)
        array.whole[n] = whole_at(daf_.bytes_, whole + 4 * n, daf_.big_endian_);
      const std::int64_t first = whole_at(daf_.bytes_, whole + 16, daf_.big_endian_);
      const std::int64_t last = whole_at(daf_.bytes_, whole + 20, daf_.big_endian_);
      const auto words = static_cast<std::int64_t>(daf_.bytes_.size() / kWord);
      if (first <= static_cast<std::int64_t>(kWordsOfRecord) || last < first || last > words)
        return refuse(whole + 16,
                      fmt::format("the array has words {} to {}, the file {}", first, last, words));
      array.first_byte = static_cast<std::size_t>(first - 1) * kWord;
      array.words = static_cast<std::size_t>(last - first + 1);
      daf_.arrays_.push_back(std::move(array));
    }
    return {};
  }

  Result<void> check_overlap() const {
    std::vector<std::pair<std::size_t, std::size_t>> parts;
    for (const DafArray& array : daf_.arrays_)
      parts.emplace_back(array.first_byte, array.first_byte + array.words * kWord);
    std::sort(parts.begin(), parts.end());
    for (std::size_t k = 1; k < parts.size(); ++k)
      if (parts[k].first < parts[k - 1].second) return refuse(parts[k].first, "two arrays share words");
    return {};
  }

  // Old files say only that they are a DAF. A CK has its type third, and fourth whether it has rates; an SPK
  // has its frame third, which is no small number but for the inertial ones, and fourth its type.
  DafKind kind_of_summaries() const {
    return std::all_of(daf_.arrays_.begin(), daf_.arrays_.end(),
                       [](const DafArray& a) {
                         return a.whole[2] >= 1 && a.whole[2] <= 6 && (a.whole[3] == 0 || a.whole[3] == 1);
                       })
               ? DafKind::kCk
               : DafKind::kSpk;
  }

  DafFile daf_;
  std::optional<DafKind> kind_;
};

Result<DafFile> DafFile::read(std::string_view bytes, std::string_view file) {
  return DafReader(bytes, file).read();
}

std::vector<double> DafFile::words_of(const DafArray& array) const {
  std::vector<double> words(array.words);
  for (std::size_t k = 0; k < words.size(); ++k)
    words[k] = number_at(bytes_, array.first_byte + k * kWord, big_endian_);
  return words;
}

tl::unexpected<Error> DafFile::refuse(const DafArray& array, std::size_t word, std::string_view why) const {
  return fail(ErrorCode::kUnreadableData, fmt::format("{} can't be read as a SPICE kernel", file_),
              {{fmt::format("{}, byte {}", file_, array.first_byte + word * kWord),
                fmt::format("segment \"{}\": {}", array.name, why)}});
}

bool looks_like_daf(std::string_view bytes) {
  return bytes.starts_with("DAF/") || bytes.starts_with("NAIF/DAF");
}

}  // namespace slipway::steps
