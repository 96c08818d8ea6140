#include "steps/spice_text_kernel.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "core/csv_cells.h"
#include "core/fault_words.h"

namespace slipway::steps {
namespace {

constexpr std::string_view kBeginData = "\\begindata";
constexpr std::string_view kBeginText = "\\begintext";
constexpr std::string_view kSpaces = " \t\r,";

struct Token {
  std::string_view text;
  std::size_t line = 0;
  bool quoted = false;

  bool is(std::string_view mark) const { return !quoted && text == mark; }
};

class TextKernelReader {
 public:
  TextKernelReader(std::string_view text, std::string_view file) : text_(text), file_(file) {}

  Result<KernelAssignments> read() {
    if (text_.find('\0') != std::string_view::npos) return refuse(1, "a NUL byte: this is no text");
    if (auto cut = cut_tokens(); !cut) return fail(cut.error());
    for (std::size_t at = 0; at < tokens_.size();)
      if (auto read = read_assignment(at); !read) return fail(read.error());
    return std::move(values_);
  }

 private:
  tl::unexpected<Error> refuse(std::size_t line, std::string message) const {
    return fail(ErrorCode::kUnreadableData, fmt::format("{} can't be read as a text kernel", file_),
                {{fmt::format("{}, line {}", file_, line), std::move(message)}});
  }

  Result<void> cut_tokens() {
    bool data = false;
    std::size_t number = 1;
    for (std::size_t begin = 0; begin < text_.size(); ++number) {
      const std::size_t end = std::min(text_.find('\n', begin), text_.size());
      const std::string_view line = text_.substr(begin, end - begin);
      const std::size_t first = line.find_first_not_of(kSpaces);
      const std::string_view rest = first == std::string_view::npos ? std::string_view() : line.substr(first);
      if (rest.starts_with(kBeginData))
        data = true;
      else if (rest.starts_with(kBeginText))
        data = false;
      else if (data)
        if (auto cut = cut_line(rest, number); !cut) return cut;
      begin = end + 1;
    }
    return {};
  }

  Result<void> cut_line(std::string_view line, std::size_t number) {
    constexpr std::string_view kEnds = " \t\r,()='";
    while (true) {
      const std::size_t first = line.find_first_not_of(kSpaces);
      if (first == std::string_view::npos) return {};
      line.remove_prefix(first);
      if (line.front() == '\'') {
        const std::size_t end = line.find('\'', 1);
        if (end == std::string_view::npos) return refuse(number, "a string has no closing quote");
        tokens_.push_back({line.substr(1, end - 1), number, true});
        line.remove_prefix(end + 1);
        continue;
      }
      std::size_t length = std::min(line.find_first_of(kEnds), line.size());
      if (length == 0) length = 1;  // a mark
      // "+=" is one mark wherever the plus ends a word.
      if (length < line.size() && line[length] == '=' && line[length - 1] == '+') {
        if (length > 1) tokens_.push_back({line.substr(0, length - 1), number});
        tokens_.push_back({line.substr(length - 1, 2), number});
        line.remove_prefix(length + 1);
        continue;
      }
      tokens_.push_back({line.substr(0, length), number});
      line.remove_prefix(length);
    }
  }

  // From `at`, which is moved behind it.
  Result<void> read_assignment(std::size_t& at) {
    const Token& name = tokens_[at];
    if (at + 2 >= tokens_.size() || name.quoted || !(tokens_[at + 1].is("=") || tokens_[at + 1].is("+=")))
      return refuse(name.line, fmt::format("{} is no assignment NAME = value", in_quotes(name.text)));
    KernelValues& values = values_[std::string(name.text)];
    if (tokens_[at + 1].is("=")) values.words.clear();
    values.line = name.line;
    at += 2;
    const bool list = tokens_[at].is("(");
    if (list) ++at;
    for (; at < tokens_.size(); ++at) {
      const Token& token = tokens_[at];
      if (list && token.is(")")) return ++at, Result<void>();
      if (token.is("(") || token.is(")") || token.is("=") || token.is("+="))
        return refuse(token.line,
                      fmt::format("{} within the values of {}", in_quotes(token.text), name.text));
      values.words.push_back(token.text);
      if (!list) return ++at, Result<void>();
    }
    return refuse(name.line, fmt::format("the values of {} have no end", in_quotes(name.text)));
  }

  std::string_view text_, file_;
  std::vector<Token> tokens_;
  KernelAssignments values_;
};

}  // namespace

Result<KernelAssignments> read_text_kernel(std::string_view text, std::string_view file) {
  return TextKernelReader(text, file).read();
}

bool kernel_number(std::string_view word, double& value) {
  std::string plain(word);
  std::replace_if(
      plain.begin(), plain.end(), [](char c) { return c == 'D' || c == 'd'; }, 'e');
  const std::optional<double> number = csv_number(plain);
  if (number) value = *number;
  return number.has_value();
}

Result<std::vector<double>> kernel_numbers(const KernelAssignments& all, std::string_view file,
                                           const std::string& name, std::size_t least) {
  const auto refuse = [file](std::string place, std::string message) {
    return fail(ErrorCode::kUnreadableData, fmt::format("{} can't be read as a text kernel", file),
                {{std::move(place), std::move(message)}});
  };
  const auto found = all.find(name);
  if (found == all.end()) return refuse(std::string(file), fmt::format("there is no {}", name));
  const std::string place = fmt::format("{}, line {}", file, found->second.line);
  std::vector<double> numbers;
  for (const std::string_view word : found->second.words) {
    double value = 0.0;
    if (!kernel_number(word, value))
      return refuse(place, fmt::format("{}: {} is no number", name, in_quotes(word)));
    numbers.push_back(value);
  }
  if (numbers.size() < least)
    return refuse(place, fmt::format("{} has {} numbers, must have {} or more", name, numbers.size(), least));
  return numbers;
}

}  // namespace slipway::steps
