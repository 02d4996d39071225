#include "swiftlet/ground/plot/path_figure.hpp"

namespace swiftlet::plot {
namespace {

constexpr double kLeastView_m = 1.0;  // a vehicle that hovers needs no magnification

}  // namespace

Figure path_figure(const std::string& title, const std::array<std::string, 4>& labels, double duration_s) {
  Figure figure{title, "", 1600, 1150, std::vector<Panel>(6)};
  for (std::size_t i = 0; i < labels.size(); ++i) {
    Panel& panel = figure.panels[i];
    const double bottom = 0.725 - 0.22 * static_cast<double>(i);
    panel.box = Box{0.065, 0.520, bottom, bottom + 0.19};
    panel.y.label = labels[i];
    panel.x.from = 0.0;
    panel.x.to = duration_s;
    panel.x.numbered = i + 1 == labels.size();
    if (panel.x.numbered) panel.x.label = "time (s)";
  }
  for (const std::size_t view : {kFromAbove, kInSpace}) {
    Panel& panel = figure.panels[view];
    panel.equal = true;
    panel.x.label = "east y (m)";
    panel.y.label = "north x (m)";
    panel.x.least_span = panel.y.least_span = kLeastView_m;
  }
  figure.panels[kFromAbove].title = "plan view";
  figure.panels[kFromAbove].box = Box{0.590, 0.975, 0.500, 0.915};
  Panel& space = figure.panels[kInSpace];
  space.box = Box{0.600, 0.960, 0.060, 0.430};
  space.in_space = true;
  space.z.label = "height -z (m)";
  space.z.from = 0.0;
  return figure;
}

void add_to_views(Figure& figure, const Series& series) {
  figure.panels[kFromAbove].series.push_back(series);
  figure.panels[kInSpace].series.push_back(series);
}

}  // namespace swiftlet::plot
