#pragma once

#include <ostream>
#include <streambuf>
#include <string>
#include <string_view>

namespace slipway::server {

// The text with "?" in the place of what would command a terminal: control characters but line ends and tabs,
// in ASCII (ESC and its like) and beyond (U+0080 to U+009F in UTF-8).
std::string printable(std::string_view text);

// Makes everything that is written to the stream printable, as long as this lives.
class PrintableOutput final : public std::streambuf {
 public:
  explicit PrintableOutput(std::ostream& stream) : stream_(stream), behind_(stream.rdbuf(this)) {}
  ~PrintableOutput() override;
  PrintableOutput(const PrintableOutput&) = delete;
  PrintableOutput& operator=(const PrintableOutput&) = delete;

 protected:
  int_type overflow(int_type character) override;
  std::streamsize xsputn(const char* text, std::streamsize size) override;
  int sync() override { return behind_->pubsync(); }

 private:
  std::ostream& stream_;
  std::streambuf* behind_;
};

}  // namespace slipway::server
