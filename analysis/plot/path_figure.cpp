#include "swiftlet/analysis/plot/path_figure.hpp"

namespace swiftlet::plot {
namespace {

constexpr double kLeastView_m = 1.0;  // a vehicle that hovers needs no magnification

}  // namespace

Figure path_figure(const std::string& title, const std::array<std::string, 4>& labels, double duration_s) {
  Figure figure{title, 1600, 1150, {}};
  for (std::size_t i = 0; i < labels.size(); ++i) {
    const double bottom = 0.725 - 0.22 * static_cast<double>(i);
    figure.panels.push_back(
        {"", Box{0.065, 0.520, bottom, bottom + 0.19}, {"", 0.0, duration_s}, {labels[i]}});
    figure.panels.back().x.numbered = i + 1 == labels.size();
  }
  figure.panels.back().x.label = "time (s)";
  const Axis east{"east y (m)", {}, {}, kLeastView_m};
  const Axis north{"north x (m)", {}, {}, kLeastView_m};
  figure.panels.push_back({"plan view", Box{0.590, 0.975, 0.530, 0.915}, east, north, {}, false, true});
  figure.panels.push_back(
      {"", Box{0.600, 0.960, 0.067, 0.437}, east, north, {"height -z (m)", 0.0}, true, true});
  return figure;
}

void add_to_views(Figure& figure, const Series& series) {
  figure.panels[kFromAbove].series.push_back(series);
  figure.panels[kInSpace].series.push_back(series);
}

}  // namespace swiftlet::plot
