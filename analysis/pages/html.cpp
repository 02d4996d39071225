#include "swiftlet/analysis/pages/html.hpp"

#include <cctype>

#include <boost/algorithm/string/replace.hpp>

#include "swiftlet/analysis/pages/assets.hpp"

namespace swiftlet::pages {
namespace {

constexpr std::size_t kFewColumns = 2;

// With the sign of a minus in an exponent: a browser breaks the line after a hyphen.
std::string cell_text(std::string text) {
  const auto is_digit = [&text](std::size_t at) {
    return std::isdigit(static_cast<unsigned char>(text[at])) != 0;
  };
  for (std::size_t at = text.find("e-", 1); at != std::string::npos; at = text.find("e-", at + 1)) {
    if (at + 2 < text.size() && is_digit(at - 1) && is_digit(at + 2)) text.replace(at, 2, "e\u2212");
  }
  return escaped(text);
}

// Each cell names its column, for narrow screens.
std::string row_of(const Row& cells, const Row& head) {
  std::string out = "<tr>";
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const std::string label = i > 0 && i < head.size() ? " data-label=\"" + escaped(head[i]) + "\"" : "";
    out += "<td" + label + ">" + cell_text(cells[i]) + "</td>";
  }
  return out + "</tr>\n";
}

}  // namespace

std::string escaped(std::string text) {
  boost::algorithm::replace_all(text, "&", "&amp;");
  boost::algorithm::replace_all(text, "<", "&lt;");
  boost::algorithm::replace_all(text, ">", "&gt;");
  boost::algorithm::replace_all(text, "\"", "&quot;");
  return text;
}

std::string element(const std::string& name, const std::string& text) {
  return "<" + name + ">" + escaped(text) + "</" + name + ">";
}

std::string table(const Row& head, const std::vector<Row>& rows) {
  std::string out = head.size() > kFewColumns ? "<div class=\"wide stacks\"><table><tr>"
                                              : "<div class=\"wide\"><table><tr>";
  for (const std::string& cell : head) out += element("th", cell);
  out += "</tr>\n";
  for (const Row& row : rows) out += row_of(row, head);
  return out + "</table></div>\n";
}

std::string document(const std::string& title, const std::string& body,
                     const std::vector<std::string_view>& scripts) {
  std::string out =
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">"
      "<link rel=\"icon\" href=\"data:,\">" +
      element("title", title) + "\n<style>\n" + std::string(style()) + "</style></head><body>\n" + body;
  for (const std::string_view script : scripts) out += "<script>\n" + std::string(script) + "</script>\n";
  return out + "</body></html>\n";
}

std::string data_element(const std::string& id, const std::string& text) {
  return "<script type=\"text/plain\" id=\"" + id + "\">" + text + "</script>\n";
}

}  // namespace swiftlet::pages
