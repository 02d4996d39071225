// The numbers of a struct of settings, one by one, by its visit (setting.hpp), and the check of their limits.
#pragma once

#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "swiftlet/plant/model/setting.hpp"
#include "swiftlet/plant/model/violation.hpp"

namespace swiftlet::plant {

struct SettingValue {
  std::string key;   // of violations: "imu.rate_hz", "air.wind_ned_m_s[0]"
  std::string name;  // of parameters that vary: "imu.rate_hz", "air.wind_ned_m_s.north", "inertia.xx"
  Setting setting;
  double value;
  double* place;  // null of a whole number
  bool varies;    // in dispersions: a real number that every file has, no rate, which must fit the steps
};

class SettingValues {
 public:
  explicit SettingValues(std::vector<SettingValue>& out, std::string prefix = "", bool varies = true)
      : out_(out), prefix_(std::move(prefix)), varies_(varies) {}

  template <class T, class... Arguments>
  void operator()(const Setting& setting, T& value, Arguments... arguments) {
    if constexpr (kIsSection<T>) {
      SettingValues inside(out_, prefix_ + setting.name.key + ".", varies(setting));
      visit(value, inside, arguments...);
    } else if constexpr (std::is_same_v<T, double>) {
      add(setting, value);
    } else if constexpr (std::is_same_v<T, int>) {
      const std::string key = prefix_ + setting.name.key;
      out_.push_back({key, key, setting, static_cast<double>(value), nullptr, false});
    } else if constexpr (std::is_same_v<T, Eigen::Vector3d>) {
      constexpr const char* kAxes[] = {".north", ".east", ".down"};
      for (int i = 0; i < 3; ++i) add(setting, value[i], "[" + std::to_string(i) + "]", kAxes[i]);
    } else if constexpr (std::is_same_v<T, Eigen::Matrix3d>) {
      constexpr const char* kMoments[] = {".xx", ".yy", ".zz"};
      for (int i = 0; i < 3; ++i) add(setting, value(i, i), kMoments[i], kMoments[i]);
    }
  }
  template <class Enum>
  void operator()(const Setting&, Enum&, ValueNames) {}

 private:
  bool varies(const Setting& setting) const {
    return varies_ && setting.varies && setting.in_file == InFile::kRequired &&
           setting.unit != std::string("Hz");
  }
  void add(const Setting& setting, double& value, const std::string& index = "",
           const std::string& component = "") {
    const std::string key = prefix_ + setting.name.key;
    out_.push_back({key + index, key + component, setting, value, &value, varies(setting)});
  }

  std::vector<SettingValue>& out_;
  std::string prefix_;
  bool varies_;
};

template <class Settings>
std::vector<SettingValue> setting_values(Settings& settings) {
  std::vector<SettingValue> out;
  SettingValues visitor(out);
  visit(settings, visitor);
  return out;
}

// Adds a violation for each number outside its range; returns true if there is none.
template <class Settings>
bool check_settings(Settings settings, RuleChecker& check) {
  bool holds = true;
  for (const SettingValue& one : setting_values(settings))
    holds = check.in_range(one.key, one.value, one.setting.range) && holds;
  return holds;
}

}  // namespace swiftlet::plant
