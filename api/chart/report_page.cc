#include "api/chart/report_page.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <string_view>

namespace slipway::api {
namespace {

using Style = ReportText::Style;

constexpr std::string_view kStyle = R"css(
:root{color-scheme:light dark}
body{margin:0;background:#f4f4f2;color:#222;font:16px/1.5 system-ui,sans-serif}
main{max-width:1240px;margin:0 auto;padding:24px 28px 48px;background:#fff}
h1{font-size:1.7rem;margin:0 0 .6rem;overflow-wrap:anywhere}
h2{font-size:1.25rem;margin:2.2rem 0 .5rem;padding-top:.6rem;border-top:1px solid #ddd}
p,ul{max-width:62rem}
p{margin:.6rem 0}
nav{font-size:.9rem;margin:0 0 1rem}
nav a{margin-right:1rem;white-space:nowrap}
a{color:#00558c}
.wide{overflow-x:auto;margin:.8rem 0}
table{border-collapse:collapse;font-size:.92rem;font-variant-numeric:tabular-nums}
th,td{text-align:left;vertical-align:top;padding:.25rem .8rem .25rem 0;border-bottom:1px solid #e4e4e4}
th{font-weight:600;border-bottom-color:#888;white-space:nowrap}
figure{margin:1.2rem 0;overflow-x:auto}
figcaption{font-size:.9rem;color:#555}
svg{display:block;max-width:100%;height:auto}
summary{cursor:pointer}
code{font-size:.92em;overflow-wrap:anywhere;background:#f0f0ee;padding:0 .2em}
.banner{font-size:2.6rem;font-weight:700;line-height:1.1;margin:0 0 .8rem;padding:.5rem 1rem;border-radius:6px;color:#fff;max-width:none}
.good{background:#1a7f37}.bad{background:#b3261e}.open{background:#8a5a00}
@media screen and (prefers-color-scheme:dark){body{background:#111;color:#ddd}main{background:#1b1b1b}
h2{border-top-color:#444}a{color:#7cc4ff}th,td{border-bottom-color:#333}figcaption{color:#aaa}code{background:#2a2a2a}
svg{border-radius:4px}}
@media screen and (max-width:1000px){main{padding:16px 14px 40px}.banner{font-size:2rem}figure svg{max-width:none}}
@page{size:A4;margin:11mm}
@media print{:root{font-size:8.2pt}body,main{background:#fff;padding:0}body{font-size:1rem;line-height:1.3}main{max-width:none}
.wide{overflow:visible;margin:1mm 0;break-inside:avoid}.banner{font-size:22pt;padding:2mm 4mm;print-color-adjust:exact;-webkit-print-color-adjust:exact}
h1{font-size:13pt}h2{font-size:11pt;margin:3mm 0 1mm;padding-top:1mm;break-after:avoid}p,ul{margin:1mm 0;max-width:none}
th,td{padding:.3mm 2mm .3mm 0}figure{margin:2mm 0}svg{max-height:125mm}figure,tr{break-inside:avoid}nav{display:none}}
)css";

bool is_control(char c) {
  constexpr char kDelete = 0x7f;
  return static_cast<unsigned char>(c) < 0x20 || c == kDelete;
}

// Text in one line that is read as text: names out of files make no tables, links, pictures or HTML.
std::string markdown_text(const std::string& text) {
  constexpr std::string_view kSigns = "|\\`*[]";
  std::string out;
  for (const char c : text) {
    if (kSigns.find(c) != std::string_view::npos) out += '\\';
    if (c == '<') {
      out += "&lt;";
    } else if (c == '&') {
      out += "&amp;";
    } else {
      out += is_control(c) ? ' ' : c;
    }
  }
  return out;
}

// Between backticks everything is text but a backtick, and in tables their own sign.
std::string markdown_code(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '|') out += '\\';
    out += is_control(c) ? ' ' : c == '`' ? '\'' : c;
  }
  return out;
}

std::string markdown_of(const ReportText& text) {
  std::string out;
  for (const ReportText::Span& span : text.spans) {
    const std::string_view around = span.style == Style::kStrong ? "**"
                                    : span.style == Style::kCode ? "`"
                                                                 : "";
    const bool is_code = span.style == Style::kCode;
    out += fmt::format("{0}{1}{0}", around, is_code ? markdown_code(span.text) : markdown_text(span.text));
  }
  return out;
}

std::string html_of(const ReportText& text) {
  std::string out;
  for (const ReportText::Span& span : text.spans) {
    const std::string words = xml_text(span.text);
    out += span.style == Style::kStrong ? "<strong>" + words + "</strong>"
           : span.style == Style::kCode ? "<code>" + words + "</code>"
                                        : words;
  }
  return out;
}

// Ids within several pictures on one page differ by the pictures' names.
std::string named_apart(const NamedChart& chart) {
  std::string out;
  const std::string_view svg = chart.svg;
  for (std::size_t at = 0; at < svg.size();) {
    std::string_view sign;
    for (const std::string_view one : {std::string_view(" id=\""), std::string_view("=\"url(#")})
      if (svg.substr(at).starts_with(one)) sign = one;
    if (sign.empty()) {
      out += svg[at++];
    } else {
      out += fmt::format("{}{}-", sign, chart.name);
      at += sign.size();
    }
  }
  return out;
}

std::string_view class_of(ReportPage::Tone tone) {
  switch (tone) {
    case ReportPage::Tone::kGood:
      return "good";
    case ReportPage::Tone::kBad:
      return "bad";
    case ReportPage::Tone::kOpen:
      break;
  }
  return "open";
}

}  // namespace

void ReportPage::banner(std::string words, Tone tone) {
  blocks_.push_back({.kind = Kind::kBanner, .text = std::move(words), .tone = tone});
}

void ReportPage::section(std::string heading) {
  blocks_.push_back({.kind = Kind::kSection, .text = std::move(heading)});
}

void ReportPage::paragraph(ReportText text) {
  blocks_.push_back({.kind = Kind::kParagraph, .text = std::move(text)});
}

void ReportPage::item(ReportText text) {
  blocks_.push_back({.kind = Kind::kItem, .text = std::move(text)});
}

void ReportPage::table(std::vector<std::string> heads) {
  blocks_.push_back({.kind = Kind::kTable, .heads = std::move(heads)});
}

void ReportPage::folded_table(std::string summary, std::vector<std::string> heads) {
  blocks_.push_back(
      {.kind = Kind::kTable, .text = std::move(summary), .heads = std::move(heads), .folded = true});
}

void ReportPage::row(std::vector<ReportText> cells) {
  blocks_.back().rows.push_back(std::move(cells));
}

void ReportPage::picture(NamedChart chart, std::string caption) {
  blocks_.push_back({.kind = Kind::kPicture, .text = std::move(caption), .chart = std::move(chart)});
}

std::string ReportPage::markdown() const {
  std::string out = fmt::format("# {}\n", markdown_text(title_));
  Kind before = Kind::kSection;
  for (const Block& block : blocks_) {
    if (block.kind != Kind::kItem || before != Kind::kItem) out += "\n";
    before = block.kind;
    const std::string words = markdown_of(block.text);
    switch (block.kind) {
      case Kind::kBanner:
        out += fmt::format("**{}**\n", words);
        break;
      case Kind::kSection:
        out += fmt::format("## {}\n", words);
        break;
      case Kind::kParagraph:
        out += words + "\n";
        break;
      case Kind::kItem:
        out += fmt::format("- {}\n", words);
        break;
      case Kind::kPicture:
        out += fmt::format("![{}]({}.svg)\n", words, block.chart.name);
        break;
      case Kind::kTable:
        if (block.folded) out += fmt::format("{}:\n\n", words);
        out += fmt::format("| {} |\n|", fmt::join(block.heads, " | "));
        for (std::size_t k = 0; k < block.heads.size(); ++k) out += "---|";
        out += "\n";
        for (const std::vector<ReportText>& row : block.rows) {
          std::vector<std::string> cells;
          cells.reserve(row.size());
          for (const ReportText& text : row) cells.push_back(markdown_of(text));
          out += fmt::format("| {} |\n", fmt::join(cells, " | "));
        }
        break;
    }
  }
  return out;
}

std::string ReportPage::html() const {
  std::string body, contents;
  bool in_list = false;
  int sections = 0;
  for (const Block& block : blocks_) {
    if (in_list && block.kind != Kind::kItem) body += "</ul>\n";
    if (!in_list && block.kind == Kind::kItem) body += "<ul>\n";
    in_list = block.kind == Kind::kItem;
    const std::string words = html_of(block.text);
    switch (block.kind) {
      case Kind::kBanner:
        body += fmt::format("<p class=\"banner {}\">{}</p>\n", class_of(block.tone), words);
        break;
      case Kind::kSection:
        body += fmt::format("<h2 id=\"section-{}\">{}</h2>\n", ++sections, words);
        contents += fmt::format("<a href=\"#section-{}\">{}</a>\n", sections, words);
        break;
      case Kind::kParagraph:
        body += fmt::format("<p>{}</p>\n", words);
        break;
      case Kind::kItem:
        body += fmt::format("<li>{}</li>\n", words);
        break;
      case Kind::kPicture:
        body += fmt::format("<figure id=\"{}\">\n{}<figcaption>{}</figcaption>\n</figure>\n",
                            xml_text(block.chart.name), named_apart(block.chart), words);
        break;
      case Kind::kTable:
        if (block.folded) body += fmt::format("<details>\n<summary>{}</summary>\n", words);
        body += "<div class=\"wide\"><table>\n<thead><tr>";
        for (const std::string& head : block.heads)
          body += fmt::format("<th scope=\"col\">{}</th>", xml_text(head));
        body += "</tr></thead>\n<tbody>\n";
        for (const std::vector<ReportText>& row : block.rows) {
          body += "<tr>";
          for (const ReportText& text : row) body += fmt::format("<td>{}</td>", html_of(text));
          body += "</tr>\n";
        }
        body += "</tbody></table></div>\n";
        if (block.folded) body += "</details>\n";
        break;
    }
  }
  if (in_list) body += "</ul>\n";
  const std::string title = xml_text(title_);
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\"/>\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"{}\"/>\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n<title>{}</title>\n"
      "<style>{}</style>\n</head>\n<body>\n<main>\n<h1>{}</h1>\n<nav>\n{}</nav>\n{}</main>\n</body>\n</"
      "html>\n",
      kReportPolicy, title, kStyle, title, contents, body);
}

}  // namespace slipway::api
