// An HTML page of texts, tables and figures, in one file without script, font file and network access.
//
//   Page page("Identification of mine");
//   page.paragraph("from the bench data", "quiet");
//   page.table({"parameter", "value"}, {{"mass", "0.9 kg"}});
//   page.figures({mass_figure});
//   runtime::write_atomically("report.html", page.html().text);
#pragma once

#include <string>
#include <vector>

#include "swiftlet/ground/plot/figure.hpp"

namespace swiftlet::plot {

class Page {
 public:
  using Row = std::vector<std::string>;

  // All texts are escaped, except those of add().
  explicit Page(const std::string& title);
  void heading(const std::string& text);
  // kind: "quiet", "finding" or "warning".
  void paragraph(const std::string& text, const std::string& kind);
  void table(const Row& head, const std::vector<Row>& rows);
  void figures(const std::vector<Figure>& figures);  // side by side if there is room
  void add(const std::string& html);

  struct Html {
    std::string text;
    std::string fault;  // why its figures are not drawn; empty if they are
  };
  // Draws the figures. Where that fails, the page has the reason in their place.
  Html html() const;

 private:
  std::vector<std::string> texts_;  // one before each figure, and one after the last
  std::vector<Figure> figures_;
};

// Escapes text for element content and attributes.
std::string html_escaped(std::string text);

}  // namespace swiftlet::plot
