#include "swiftlet/ground/plot/page.hpp"

#include <gtest/gtest.h>

#include "tests/support/program_path.hpp"
#include "tests/support/temporary_folder.hpp"

namespace swiftlet::plot {
namespace {

Page example() {
  Page page("a <title>");
  page.heading("b & c");
  page.paragraph("d \"e\"", "quiet");
  page.table({"<name>", "value"}, {{"mass", "1 < 2"}});
  Figure figure = one_panel("<caption>", "x", "y");
  figure.panels[0].series = {{Style::kLine, Colour::kBlue, "", {{0.0, 0.0}, {1.0, 1.0}}}};
  page.figures({figure, figure});
  page.paragraph("after the figures", "finding");
  return page;
}

TEST(Page, EscapesTexts) {
  const Page::Html html = example().html();
  EXPECT_EQ(html.fault, "");
  for (const char* const part :
       {"<title>a &lt;title&gt;</title>", "<h1>a &lt;title&gt;</h1>", "<h2>b &amp; c</h2>",
        "<p class=\"quiet\">d &quot;e&quot;</p>", "<th>&lt;name&gt;</th><th>value</th>",
        "<td>mass</td><td>1 &lt; 2</td>", "<figcaption>&lt;caption&gt;</figcaption>"})
    EXPECT_NE(html.text.find(part), std::string::npos) << part << "\n" << html.text;
}

TEST(Page, HasItsFiguresInTheirPlaces) {
  const std::string text = example().html().text;
  std::size_t at = 0;
  for (const char* const part :
       {"</h1>", "<figure><svg ", "</svg>", "<figcaption>", "<figure><svg ", "</svg>", "<figcaption>",
        "</div>", "after the figures", "</body></html>\n"}) {
    at = text.find(part, at);
    ASSERT_NE(at, std::string::npos) << part;
  }
  EXPECT_EQ(text.find("<svg", text.find("after the figures")), std::string::npos);
}

TEST(Page, HasTheReasonWhereFiguresCannotBeDrawn) {
  const tests::TemporaryFolder empty;
  const tests::ProgramPath path(empty.path());
  const Page::Html html = example().html();
  EXPECT_EQ(html.fault, "no picture was drawn: gnuplot is not installed");
  EXPECT_NE(
      html.text.find("<figure><p class=\"warning\">no picture was drawn: gnuplot is not installed.</p>\n"
                     "<figcaption>&lt;caption&gt;"),
      std::string::npos);
  EXPECT_NE(html.text.find("after the figures"), std::string::npos);
}

}  // namespace
}  // namespace swiftlet::plot
