#include "swiftlet/analysis/pages/html.hpp"

#include <boost/algorithm/string/replace.hpp>

#include "swiftlet/analysis/pages/assets.hpp"

namespace swiftlet::pages {
namespace {

std::string row_of(const Row& cells, const std::string& name) {
  std::string out = "<tr>";
  for (const std::string& cell : cells) out += element(name, cell);
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
  std::string out = "<div class=\"wide\"><table>" + row_of(head, "th");
  for (const Row& row : rows) out += row_of(row, "td");
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
