#include "swiftlet/analysis/pages/page.hpp"

#include <array>
#include <optional>

#include <nlohmann/json.hpp>

#include "swiftlet/analysis/pages/assets.hpp"
#include "swiftlet/analysis/pages/packed_column.hpp"
#include "swiftlet/io/json_text.hpp"

namespace swiftlet::pages {
namespace {

using Json = nlohmann::ordered_json;

// Properties of page.css, in the order of Colour.
constexpr std::array<const char*, 10> kColours = {"series-0", "series-1", "series-2", "series-3", "series-4",
                                                  "series-5", "series-6", "limit",    "ink",      "muted"};
// In the order of Style.
constexpr std::array<const char*, 7> kStyles = {"line",    "dashes", "steps", "dots",
                                                "crosses", "band",   "boxes"};

Json json_of(const std::optional<double>& number) { return number ? Json(*number) : Json(nullptr); }

Json json_of(const plot::Axis& axis) {
  return {{"label", axis.label},           {"from", json_of(axis.from)},      {"to", json_of(axis.to)},
          {"least_span", axis.least_span}, {"logarithmic", axis.logarithmic}, {"names", axis.names}};
}

std::vector<double> coordinates(const std::vector<plot::Point>& points, double plot::Point::*coordinate) {
  std::vector<double> out;
  out.reserve(points.size());
  for (const plot::Point& point : points) out.push_back(point.*coordinate);
  return out;
}

std::string caption_of(const plot::Figure& figure, const plot::Panel& panel) {
  if (figure.panels.size() == 1) return figure.title;
  return panel.title.empty() ? panel.y.label + (panel.x.label.empty() ? "" : " over " + panel.x.label)
                             : panel.title;
}

}  // namespace

Page::Page(std::string title) : title_(std::move(title)), body_(element("h1", title_) + "\n") {}

void Page::heading(const std::string& text) { body_ += element("h2", text) + "\n"; }

void Page::paragraph(const std::string& text, const std::string& kind) {
  body_ += "<p class=\"" + kind + "\">" + escaped(text) + "</p>\n";
}

void Page::table(const Row& head, const std::vector<Row>& rows) { body_ += pages::table(head, rows); }

void Page::figures(const std::vector<plot::Figure>& figures) {
  body_ += "<div class=\"grid\">\n";
  for (const plot::Figure& figure : figures) {
    for (const plot::Panel& panel : figure.panels) {
      Json series = Json::array();
      for (const plot::Series& one : panel.series) {
        const auto add = [&](double plot::Point::*coordinate) {
          const std::string id = "d" + std::to_string(elements_++);
          body_ += data_element(id, packed(coordinates(one.points, coordinate)));
          return id;
        };
        series.push_back({{"style", kStyles.at(static_cast<std::size_t>(one.style))},
                          {"colour", kColours.at(static_cast<std::size_t>(one.colour))},
                          {"label", one.label},
                          {"x", add(&plot::Point::x)},
                          {"y", add(&plot::Point::y)},
                          {"weight", one.weight}});
      }
      const std::string caption = caption_of(figure, panel);
      body_ += "<figure data-panel=\"" +
               escaped(io::json_text(Json({{"caption", caption},
                                           {"height", figure.panels.size() == 1 ? figure.height : 360},
                                           {"x", json_of(panel.x)},
                                           {"y", json_of(panel.y)},
                                           {"zero_line", panel.zero_line},
                                           {"series", std::move(series)}}))) +
               "\">" + element("figcaption", caption) + "</figure>\n";
    }
  }
  body_ += "</div>\n";
}

void Page::add(const std::string& html) { body_ += html; }

std::string Page::html() const { return document(title_, body_, {chart_scripts(), figure_scripts()}); }

}  // namespace swiftlet::pages
