#include "swiftlet/analysis/pages/page.hpp"

#include <gtest/gtest.h>

namespace swiftlet::pages::page_test {

Page example() {
  Page page("a <title>");
  page.heading("b & c");
  page.paragraph("d \"e\"", "quiet");
  page.table({"<name>", "value"}, {{"mass", "1 < 2"}});
  plot::Figure figure = plot::one_panel("<caption> 'of' \"it\"", "x", "y");
  figure.panels[0].series = {{plot::Style::kLine, plot::Colour::kBlue, "", {{0.0, 0.0}, {1.0, 1.0}}}};
  page.figures({figure, figure});
  page.paragraph("after the figures", "finding");
  return page;
}

TEST(Page, EscapesTexts) {
  const std::string html = example().html();
  for (const char* const part :
       {"<title>a &lt;title&gt;</title>", "<h1>a &lt;title&gt;</h1>", "<h2>b &amp; c</h2>",
        "<p class=\"quiet\">d &quot;e&quot;</p>", "<th>&lt;name&gt;</th><th>value</th>",
        "<td>mass</td><td data-label=\"value\">1 &lt; 2</td>",
        "<figcaption>&lt;caption&gt; 'of' &quot;it&quot;</figcaption>",
        "{&quot;caption&quot;:&quot;&lt;caption&gt; 'of' \\&quot;it\\&quot;&quot;,"})
    EXPECT_NE(html.find(part), std::string::npos) << part;
}

// On a telephone each cell is a line of its own, behind the name of its column.
TEST(Page, NamesTheColumnsInTheCellsOfAWideTable) {
  Page page("table");
  page.table({"parameter", "value", "unit"}, {{"inertia.zz", "3.7853e-08", "kg"}});
  EXPECT_NE(page.html().find("<div class=\"wide stacks\">"), std::string::npos);
  EXPECT_NE(page.html().find("<td>inertia.zz</td><td data-label=\"value\">3.7853e\u221208</td>"
                             "<td data-label=\"unit\">kg</td>"),
            std::string::npos)
      << "a browser breaks the line after a hyphen";
}

TEST(Page, HasItsFiguresInTheirPlaces) {
  const std::string html = example().html();
  std::size_t at = 0;
  for (const char* const part :
       {"</h1>", "id=\"d0\"", "id=\"d1\"", "<figure data-panel=", "</figure>", "id=\"d3\"",
        "<figure data-panel=", "</figure>", "</div>", "after the figures", "<script>", "</body></html>\n"}) {
    at = html.find(part, at);
    ASSERT_NE(at, std::string::npos) << part;
  }
}

TEST(Page, NamesPanelsThatShareAFigure) {
  Page page("batch");
  plot::Figure figure{
      "headline", 800, 600, {{"margins", {}, {"axis"}, {"deg"}}, {"", {}, {"mass (kg)"}, {"error (mm)"}}}};
  page.figures({figure});
  const std::string html = page.html();
  EXPECT_NE(html.find("<figcaption>margins</figcaption>"), std::string::npos);
  EXPECT_NE(html.find("<figcaption>error (mm) over mass (kg)</figcaption>"), std::string::npos);
}

}  // namespace swiftlet::pages::page_test
