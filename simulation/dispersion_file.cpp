#include "swiftlet/simulation/dispersion_file.hpp"

#include <algorithm>
#include <filesystem>

#include "swiftlet/io/config.hpp"
#include "swiftlet/io/nearest_name.hpp"

namespace swiftlet::simulation {
namespace {

using io::ConfigNode;

std::size_t parameter_index(const std::string& name, const ConfigNode& node) {
  const std::vector<Parameter>& known = parameters();
  const auto found = std::find_if(known.begin(), known.end(),
                                  [&](const Parameter& parameter) { return parameter.name == name; });
  if (found != known.end()) return static_cast<std::size_t>(found - known.begin());
  std::vector<std::string> names;
  std::string list;
  for (const Parameter& parameter : known) {
    names.push_back(parameter.name);
    list += (list.empty() ? "" : ", ") + parameter.name;
  }
  node.fail("is unknown, must be one of " + list + io::or_nearest(names, name));
}

bool read_unit(const ConfigNode& node, const Parameter& parameter) {
  const ConfigNode unit = node.at("unit");
  if (parameter.unit.empty()) return unit.choice<bool>({{"nominal", true}});
  return unit.choice<bool>({{"nominal", true}, {parameter.unit.c_str(), false}});
}

void read_limits(const ConfigNode& node, ParameterDistribution& distribution) {
  const bool positive =
      distribution.distribution == Distribution::kLogUniform || distribution.what().rule.empty();
  distribution.min = node.at("min").number(positive ? io::above(0.0) : io::any_number());
  distribution.max = node.at("max").number(io::above(distribution.min));
}

void read_normal(const ConfigNode& node, ParameterDistribution& distribution) {
  distribution.mean = node.at("mean").number(io::between(distribution.min, distribution.max));
  distribution.sigma = node.at("sigma").number({0.0, distribution.max - distribution.min, true, false});
}

void require_nominal(const ConfigNode& node, const ParameterDistribution& distribution, World nominal) {
  const std::vector<double*> values = distribution.what().in(nominal);
  const bool all_zero = std::all_of(values.begin(), values.end(), [](const double* v) { return *v == 0.0; });
  if (distribution.of_nominal && all_zero)
    node.at("unit").fail("is nominal, must be " + distribution.what().unit + ": the nominal value is 0");
}

// Checks the rules that concern this parameter alone. draw() checks those that concern several.
void require_allowed(const ConfigNode& limit, const ParameterDistribution& distribution, World world) {
  apply(world, distribution, limit.number());
  for (const plant::Violation& violation : validate(world)) {
    if (violation.key != distribution.what().rule) continue;
    limit.fail((distribution.of_nominal ? "times the nominal value " : "") + violation.message);
  }
}

ParameterDistribution read_distribution(const std::string& name, const ConfigNode& node,
                                        const World& nominal) {
  ParameterDistribution distribution;
  distribution.parameter = parameter_index(name, node);
  distribution.distribution = node.at("distribution")
                                  .choice<Distribution>({{"uniform", Distribution::kUniform},
                                                         {"log_uniform", Distribution::kLogUniform},
                                                         {"normal", Distribution::kNormal}});
  distribution.of_nominal = read_unit(node, distribution.what());
  read_limits(node, distribution);
  if (distribution.distribution == Distribution::kNormal) read_normal(node, distribution);
  node.at("source").text();
  require_nominal(node, distribution, nominal);
  require_allowed(node.at("min"), distribution, nominal);
  require_allowed(node.at("max"), distribution, nominal);
  return distribution;
}

Dispersion read_dispersion(const ConfigNode& root, const World& nominal) {
  Dispersion dispersion;
  dispersion.file = root.file();
  const auto name = root.find("name");
  dispersion.name = name ? name->text() : std::filesystem::path(root.file()).stem().string();
  root.read_known([&] {
    const ConfigNode list = root.at("parameters");
    for (const auto& [key, node] : list.entries())
      dispersion.distributions.push_back(read_distribution(key, node, nominal));
    if (dispersion.distributions.empty()) list.fail("is empty, must name at least one parameter");
  });
  std::sort(dispersion.distributions.begin(), dispersion.distributions.end(),
            [](const ParameterDistribution& a, const ParameterDistribution& b) {
              return a.parameter < b.parameter;
            });
  return dispersion;
}

}  // namespace

Dispersion load_dispersion_file(const std::string& path, const World& nominal) {
  return read_dispersion(io::load_config(path), nominal);
}

Dispersion parse_dispersion_file(const std::string& text, const std::string& file_name,
                                 const World& nominal) {
  return read_dispersion(io::parse_config(text, file_name), nominal);
}

}  // namespace swiftlet::simulation
