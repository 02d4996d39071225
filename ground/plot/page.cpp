#include "swiftlet/ground/plot/page.hpp"

#include <boost/algorithm/string/replace.hpp>

#include "swiftlet/ground/plot/gnuplot.hpp"

namespace swiftlet::plot {
namespace {

constexpr const char* kStyle = R"(<style>
body { font: 15px/1.45 sans-serif; color: #1a1a1a; background: #fff; max-width: 1360px; margin: 24px auto; padding: 0 20px; }
h1 { font-size: 25px; margin-bottom: 4px; } h2 { font-size: 19px; margin: 34px 0 6px; border-bottom: 1px solid #ccc; }
table { border-collapse: collapse; margin: 8px 0; } th, td { padding: 3px 14px 3px 0; text-align: left; }
th { border-bottom: 1px solid #999; font-weight: 600; } td { font-variant-numeric: tabular-nums; }
td:not(:last-child) { white-space: nowrap; }
.figures { display: grid; grid-template-columns: repeat(auto-fill, minmax(520px, 1fr)); gap: 14px 22px; align-items: end; }
figure { margin: 0; } figcaption { font-size: 13px; color: #444; padding-left: 48px; } svg { width: 100%; height: auto; display: block; pointer-events: none; }
.warning { background: #fff3cd; border-left: 4px solid #e0a800; padding: 4px 10px; margin: 5px 0; }
.finding { margin: 4px 0; } .quiet { color: #555; font-size: 14px; }
</style>
)";

std::string element(const std::string& name, const std::string& text) {
  return "<" + name + ">" + html_escaped(text) + "</" + name + ">";
}

std::string row_of(const Page::Row& cells, const std::string& name) {
  std::string out = "<tr>";
  for (const std::string& cell : cells) out += element(name, cell);
  return out + "</tr>\n";
}

std::string paragraph_of(const std::string& text, const std::string& kind) {
  return "<p class=\"" + kind + "\">" + html_escaped(text) + "</p>\n";
}

}  // namespace

Page::Page(const std::string& title)
    : texts_{"<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">" + element("title", title) +
             "\n" + kStyle + "</head><body>\n" + element("h1", title) + "\n"} {}

void Page::heading(const std::string& text) { add(element("h2", text) + "\n"); }

void Page::paragraph(const std::string& text, const std::string& kind) { add(paragraph_of(text, kind)); }

void Page::table(const Row& head, const std::vector<Row>& rows) {
  add("<table>" + row_of(head, "th"));
  for (const Row& row : rows) add(row_of(row, "td"));
  add("</table>\n");
}

void Page::figures(const std::vector<Figure>& figures) {
  add("<div class=\"figures\">\n");
  for (const Figure& figure : figures) {
    add("<figure>");
    figures_.push_back(figure);
    texts_.push_back(element("figcaption", figure.title) + "</figure>\n");
  }
  add("</div>\n");
}

void Page::add(const std::string& html) { texts_.back() += html; }

Page::Html Page::html() const {
  const Drawings drawings = draw_svg(figures_);
  std::string text = texts_.front();
  for (std::size_t i = 0; i < figures_.size(); ++i)
    text += (drawings.fault.empty() ? drawings.svg[i] : paragraph_of(drawings.fault + ".", "warning")) +
            texts_[i + 1];
  return {text + "</body></html>\n", drawings.fault};
}

std::string html_escaped(std::string text) {
  boost::algorithm::replace_all(text, "&", "&amp;");
  boost::algorithm::replace_all(text, "<", "&lt;");
  boost::algorithm::replace_all(text, ">", "&gt;");
  boost::algorithm::replace_all(text, "\"", "&quot;");
  return text;
}

}  // namespace swiftlet::plot
