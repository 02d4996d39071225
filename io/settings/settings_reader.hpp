// Reads the members of a struct of settings from a map, by the keys of its visit (plant/model/setting.hpp).
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "swiftlet/io/config.hpp"
#include "swiftlet/plant/model/setting.hpp"

namespace swiftlet::io {

enum class NumbersAre { kPlain, kQuantities };  // or maps of value, unit and source

class SettingsReader {
 public:
  SettingsReader(const ConfigNode& node, NumbersAre numbers) : node_(node), numbers_(numbers) {}

  const ConfigNode& node() const { return node_; }

  template <class T, class... Arguments>
  void operator()(const plant::Setting& setting, T& value, Arguments... arguments) const {
    const std::optional<ConfigNode> node = find(setting);
    if (!node) return;
    if constexpr (plant::kIsSection<T>) {
      read_section(SettingsReader(*node, numbers_), value, arguments...);
    } else {
      read(*node, value, arguments...);
    }
  }
  template <class Enum>
  void operator()(const plant::Setting& setting, Enum& value, plant::ValueNames names) const {
    if (const auto node = find(setting))
      value = static_cast<Enum>(node->choice_index({names.begin(), names.end()}));
  }

 private:
  // A key may be one in a section: "open_circuit.voltage".
  std::optional<ConfigNode> find(const plant::Setting& setting) const {
    if (setting.in_file == plant::InFile::kAbsent) return std::nullopt;
    const std::string path = setting.name.key;
    const std::size_t dot = path.find('.');
    const ConfigNode map = dot == std::string::npos ? node_ : node_.at(path.substr(0, dot));
    const std::string key = dot == std::string::npos ? path : path.substr(dot + 1);
    if (setting.in_file == plant::InFile::kOptional) return map.find(key);
    const bool is_quantity = numbers_ == NumbersAre::kQuantities && *setting.unit != '\0';
    return is_quantity ? map.at(key).quantity(setting.unit) : map.at(key);
  }

  static void read(const ConfigNode& node, double& value) { value = node.number(); }
  static void read(const ConfigNode& node, int& count) {
    count = static_cast<int>(node.integer(1, 1'000'000));
  }
  static void read(const ConfigNode& node, bool& value) { value = node.boolean(); }
  static void read(const ConfigNode& node, Eigen::Matrix3d& value) {
    const std::vector<ConfigNode> rows = node.items(3, 3);
    for (int i = 0; i < 3; ++i) value.row(i) = rows[static_cast<std::size_t>(i)].vector3();
  }
  // A list of fixed size, of which the file has the first `count` values; 0: all.
  template <class Numbers>
  static void read(const ConfigNode& node, Numbers& values, std::size_t count = 0) {
    if (count == 0) count = static_cast<std::size_t>(values.size());
    const std::vector<double> read = node.numbers(count, count);
    std::copy(read.begin(), read.end(), values.data());
  }
  static void read(const ConfigNode& node, std::vector<double>& values, std::size_t min, std::size_t max) {
    values = node.numbers(min, max);
  }
  template <class Section>
  void read(const ConfigNode& node, std::vector<Section>& sections, std::size_t min, std::size_t max) const {
    for (const ConfigNode& item : node.items(min, max))
      read_section(SettingsReader(item, numbers_), sections.emplace_back());
  }

  ConfigNode node_;
  NumbersAre numbers_;
};

// Reads all members of the map. An overload for a struct can read it in another way.
template <class Section, class... Arguments>
void read_section(const SettingsReader& reader, Section& section, Arguments... arguments) {
  visit(section, reader, arguments...);
}

}  // namespace swiftlet::io
