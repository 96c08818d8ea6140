#include "server/cli/terminal/printable_output.h"

namespace slipway::server {
namespace {

bool commands_terminal(unsigned char c) {
  constexpr unsigned char kSpace = 0x20;
  constexpr unsigned char kDelete = 0x7f;
  return (c < kSpace && c != '\n' && c != '\t') || c == kDelete;
}

}  // namespace

std::string printable(std::string_view text) {
  constexpr unsigned char kLeadOfControls = 0xc2;  // of U+0080 to U+00BF, whose first half are controls
  constexpr unsigned char kFirstControl = 0x80;
  constexpr unsigned char kLastControl = 0x9f;
  std::string out;
  out.reserve(text.size());
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto c = static_cast<unsigned char>(text[i]);
    const auto next = static_cast<unsigned char>(i + 1 < text.size() ? text[i + 1] : '\0');
    if (c == kLeadOfControls && next >= kFirstControl && next <= kLastControl) {
      out += '?';
      ++i;
    } else {
      out += commands_terminal(c) ? '?' : text[i];
    }
  }
  return out;
}

PrintableOutput::~PrintableOutput() {
  stream_.rdbuf(behind_);
}

PrintableOutput::int_type PrintableOutput::overflow(int_type character) {
  if (traits_type::eq_int_type(character, traits_type::eof())) return traits_type::not_eof(character);
  const char one = traits_type::to_char_type(character);
  return xsputn(&one, 1) == 1 ? character : traits_type::eof();
}

std::streamsize PrintableOutput::xsputn(const char* text, std::streamsize size) {
  const std::string shown = printable({text, static_cast<std::size_t>(size)});
  const auto length = static_cast<std::streamsize>(shown.size());
  return behind_->sputn(shown.data(), length) == length ? size : 0;
}

}  // namespace slipway::server
