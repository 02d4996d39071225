// An HTML page of texts, tables and figures, in one file without network access.
//
//   Page page("Identification of mine");
//   page.paragraph("from the bench data", "quiet");
//   page.table({"parameter", "value"}, {{"mass", "0.9 kg"}});
//   page.figures({mass_figure});
//   io::write_atomically("report.html", page.html());
#pragma once

#include <string>
#include <vector>

#include "swiftlet/analysis/pages/html.hpp"
#include "swiftlet/analysis/plot/figure.hpp"

namespace swiftlet::pages {

class Page {
 public:
  // All texts are escaped, except those of add().
  explicit Page(std::string title);
  void heading(const std::string& text);
  // kind: "quiet", "finding" or "warning".
  void paragraph(const std::string& text, const std::string& kind);
  void table(const Row& head, const std::vector<Row>& rows);
  // Side by side if there is room. Panels in space are not drawn: FlightLog is for those.
  void figures(const std::vector<plot::Figure>& figures);
  void add(const std::string& html);

  std::string html() const;

 private:
  std::string title_;
  std::string body_;
  std::size_t elements_ = 0;  // of data
};

}  // namespace swiftlet::pages
