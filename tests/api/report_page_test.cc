#include "api/chart/report_page.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace slipway::api {
namespace {

using Style = ReportText::Style;

// A name as a campaign's file could have it.
const std::string kHostile =
    "<script>alert(1)</script> <img src=x onerror=y> [x](javascript:z) ![p](q) a|b `c` **d** "
    "\x1b[31m\x07\x7f\nend &lt;";

ReportPage page_of(const std::string& name) {
  ReportPage page("Diagnosis of " + name);
  page.section(name);
  page.paragraph(std::vector<ReportText::Span>{{name}, {name, Style::kStrong}, {name, Style::kCode}});
  page.item(name);
  page.table({"name"});
  page.row({name});
  return page;
}

// On a narrow screen a picture scrolls in its figure; smaller, its words could not be read.
TEST(ReportPage, PicturesKeepTheirSizeOnANarrowScreen) {
  const std::string page = page_of("x").html();
  EXPECT_NE(page.find("@media screen and (max-width:1000px)"), std::string::npos);
  EXPECT_NE(page.find("figure svg{max-width:none}"), std::string::npos);
  EXPECT_NE(page.find("figure{margin:1.2rem 0;overflow-x:auto}"), std::string::npos);
}

TEST(ReportPage, TheMarkdownOfAHostileNameIsText) {
  const std::string text = page_of(kHostile).markdown();
  EXPECT_TRUE(std::none_of(text.begin(), text.end(), [](char c) {
    return (static_cast<unsigned char>(c) < 0x20 && c != '\n') || c == 0x7f;
  }));
  std::size_t in_code = 0;
  for (std::size_t at = text.find("<script>"); at != std::string::npos; at = text.find("<script>", at + 1)) {
    EXPECT_EQ(text[at - 1], '`') << "HTML stands between backticks alone, where it is text";
    ++in_code;
  }
  EXPECT_EQ(in_code, 1U);
  EXPECT_EQ(text.find(" [x]("), text.find(" [x](", text.find("`<script>"))) << "a link only where it is code";
  EXPECT_NE(text.find("\\[x\\](javascript:z)"), std::string::npos) << text;
  EXPECT_NE(text.find("a\\|b"), std::string::npos) << text;
  EXPECT_NE(text.find("&amp;lt;"), std::string::npos) << "what looks like an entity stays as it was written";
}

TEST(ReportPage, TheMarkdownOfAPlainNameIsTheName) {
  const std::string text = page_of("tilt_10-r1 (10.5 deg), motor_temperature").markdown();
  EXPECT_NE(text.find("# Diagnosis of tilt_10-r1 (10.5 deg), motor_temperature\n"), std::string::npos)
      << text;
}

TEST(ReportPage, TheHtmlOfAHostileNameIsText) {
  const std::string text = page_of(kHostile).html();
  EXPECT_EQ(text.find("<script"), std::string::npos);
  EXPECT_EQ(text.find("<img"), std::string::npos);
  EXPECT_EQ(text.find('\x1b'), std::string::npos);
}

// HTML shows it when it is opened; Markdown has no folds that all readers know, and shows it.
TEST(ReportPage, AFoldedTableIsWithinItsSummary) {
  ReportPage page("Page");
  page.folded_table("All <options>", {"name", "value"});
  page.row({"one", "1"});
  const std::string html = page.html();
  const std::size_t summary = html.find("<details>\n<summary>All &lt;options&gt;</summary>");
  ASSERT_NE(summary, std::string::npos) << html;
  EXPECT_LT(html.find("<td>one</td>", summary), html.find("</details>", summary));
  EXPECT_NE(page.markdown().find("All &lt;options>:\n\n| name | value |\n|---|---|\n| one | 1 |\n"),
            std::string::npos)
      << page.markdown();
}

}  // namespace
}  // namespace slipway::api
