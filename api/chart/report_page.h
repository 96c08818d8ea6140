#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "api/chart/chart.h"

namespace slipway::api {

// Words of one line, parts of them strong or as code.
struct ReportText {
  enum class Style { kPlain, kStrong, kCode };
  struct Span {
    std::string text;
    Style style = Style::kPlain;
  };
  std::vector<Span> spans;

  ReportText(std::string text) : spans{{std::move(text)}} {}
  ReportText(const char* text) : spans{{text}} {}
  ReportText(std::string_view text) : spans{{std::string(text)}} {}
  ReportText(std::vector<Span> parts) : spans(std::move(parts)) {}
};

// A report for people: said once, shown as Markdown with its pictures in files beside it, or as one HTML page
// with its pictures in it. The same report gives the same bytes.
class ReportPage {
 public:
  explicit ReportPage(std::string title) : title_(std::move(title)) {}

  // Large words on a colour, under the title: what the page has to say above all.
  enum class Tone { kGood, kBad, kOpen };
  void banner(std::string words, Tone tone);
  void section(std::string heading);
  void paragraph(ReportText text);
  void item(ReportText text);  // of a list, with its neighbours
  void table(std::vector<std::string> heads);
  // A table that the HTML page shows only when its summary is opened; in Markdown the summary stands above
  // it.
  void folded_table(std::string summary, std::vector<std::string> heads);
  void row(std::vector<ReportText> cells);  // of the table before
  // The chart's name is its file's.
  void picture(NamedChart chart, std::string caption);

  std::string markdown() const;
  // Nothing is loaded from anywhere and no script runs; all text is escaped.
  std::string html() const;

 private:
  enum class Kind { kBanner, kSection, kParagraph, kItem, kTable, kPicture };
  struct Block {
    Kind kind = Kind::kParagraph;
    ReportText text = "";  // of a section, a picture, a folded table: heading, caption and summary
    std::vector<std::string> heads = {};
    std::vector<std::vector<ReportText>> rows = {};
    NamedChart chart = {};
    Tone tone = Tone::kOpen;
    bool folded = false;  // of a table
  };

  std::string title_;
  std::vector<Block> blocks_;
};

// What an HTML page of ours may do, as the value of Content-Security-Policy.
inline constexpr std::string_view kReportPolicy =
    "default-src 'none'; style-src 'unsafe-inline'; img-src data:; base-uri 'none'; form-action 'none'";

}  // namespace slipway::api
