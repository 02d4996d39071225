#include "swiftlet/simulation/vary_file.hpp"

#include <algorithm>
#include <filesystem>

#include "swiftlet/io/config.hpp"

namespace swiftlet::ground {
namespace {

using runtime::ConfigNode;

std::size_t parameter_index(const std::string& name, const ConfigNode& node) {
  const std::vector<Parameter>& known = parameters();
  const auto found = std::find_if(known.begin(), known.end(),
                                  [&](const Parameter& parameter) { return parameter.name == name; });
  if (found != known.end()) return static_cast<std::size_t>(found - known.begin());
  std::string names;
  for (const Parameter& parameter : known) names += (names.empty() ? "" : ", ") + parameter.name;
  node.fail("is unknown, must be one of " + names);
}

bool read_unit(const ConfigNode& node, const Parameter& parameter) {
  const ConfigNode unit = node.at("unit");
  if (parameter.unit.empty()) return unit.choice<bool>({{"nominal", true}});
  return unit.choice<bool>({{"nominal", true}, {parameter.unit.c_str(), false}});
}

void read_limits(const ConfigNode& node, Variate& variate) {
  const bool positive = variate.distribution == Distribution::kLogUniform || variate.what().rule.empty();
  variate.min = node.at("min").number(positive ? runtime::above(0.0) : runtime::any_number());
  variate.max = node.at("max").number(runtime::above(variate.min));
}

void read_normal(const ConfigNode& node, Variate& variate) {
  variate.mean = node.at("mean").number(runtime::between(variate.min, variate.max));
  variate.sigma = node.at("sigma").number({0.0, variate.max - variate.min, true, false});
}

void demand_nominal(const ConfigNode& node, const Variate& variate, World nominal) {
  const std::vector<double*> values = variate.what().in(nominal);
  const bool all_zero = std::all_of(values.begin(), values.end(), [](const double* v) { return *v == 0.0; });
  if (variate.of_nominal && all_zero)
    node.at("unit").fail("is nominal, must be " + variate.what().unit + ": the nominal value is 0");
}

// Rules that several parameters break together are a matter of each draw.
void demand_allowed(const ConfigNode& limit, const Variate& variate, World world) {
  vary(world, variate, limit.number());
  for (const plant::Violation& violation : validate(world)) {
    if (violation.key != variate.what().rule) continue;
    limit.fail((variate.of_nominal ? "times the nominal value " : "") + violation.message);
  }
}

Variate read_variate(const std::string& name, const ConfigNode& node, const World& nominal) {
  Variate variate;
  variate.parameter = parameter_index(name, node);
  variate.distribution = node.at("distribution")
                             .choice<Distribution>({{"uniform", Distribution::kUniform},
                                                    {"log_uniform", Distribution::kLogUniform},
                                                    {"normal", Distribution::kNormal}});
  variate.of_nominal = read_unit(node, variate.what());
  read_limits(node, variate);
  if (variate.distribution == Distribution::kNormal) read_normal(node, variate);
  node.at("source").text();
  demand_nominal(node, variate, nominal);
  demand_allowed(node.at("min"), variate, nominal);
  demand_allowed(node.at("max"), variate, nominal);
  return variate;
}

Variation read_variation(const ConfigNode& root, const World& nominal) {
  Variation variation;
  variation.file = root.file();
  const auto name = root.find("name");
  variation.name = name ? name->text() : std::filesystem::path(root.file()).stem().string();
  const ConfigNode list = root.at("parameters");
  for (const auto& [key, node] : list.entries())
    variation.variates.push_back(read_variate(key, node, nominal));
  if (variation.variates.empty()) list.fail("is empty, must name at least one parameter");
  root.reject_unknown_keys();
  std::sort(variation.variates.begin(), variation.variates.end(),
            [](const Variate& a, const Variate& b) { return a.parameter < b.parameter; });
  return variation;
}

}  // namespace

Variation load_vary_file(const std::string& path, const World& nominal) {
  return read_variation(runtime::load_config(path), nominal);
}

Variation parse_vary_file(const std::string& text, const std::string& file_name, const World& nominal) {
  return read_variation(runtime::parse_config(text, file_name), nominal);
}

}  // namespace swiftlet::ground
