#include "swiftlet/io/settings/fixed_settings.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>

#include "swiftlet/io/flat_yaml.hpp"
#include "swiftlet/io/text_file.hpp"

namespace swiftlet::io {
namespace {

constexpr std::array<std::string_view, 6> kTunable = {"name",          "attitude.roll.", "attitude.pitch.",
                                                      "attitude.yaw.", "position.",      "disturbance."};

bool is_tunable(std::string_view key) {
  return std::any_of(kTunable.begin(), kTunable.end(),
                     [&](std::string_view prefix) { return key.substr(0, prefix.size()) == prefix; });
}

// The scalars of a value: one, or those of a list.
std::vector<std::string> scalars_of(std::string_view value) {
  std::vector<std::string> out(1);
  for (const char c : value) {
    if (c == ',') {
      out.emplace_back();
    } else if (c != '[' && c != ']' && c != ' ') {
      out.back() += c;
    }
  }
  return out;
}

bool same_scalar(const std::string& a, const std::string& b) {
  char* end_a = nullptr;
  char* end_b = nullptr;
  const double number_a = std::strtod(a.c_str(), &end_a);
  const double number_b = std::strtod(b.c_str(), &end_b);
  const bool numbers = !a.empty() && !b.empty() && *end_a == '\0' && *end_b == '\0';
  return a == b || (numbers && number_a == number_b);
}

}  // namespace

std::vector<control::FixedSetting> parse_fixed_settings(std::string_view text, const std::string& file_name) {
  std::vector<control::FixedSetting> out;
  for (auto& [key, value] : flatten_yaml(text, file_name)) {
    if (!is_tunable(key)) out.push_back({key, value});
  }
  return out;
}

std::vector<control::FixedSetting> load_fixed_settings(const std::string& path) {
  return parse_fixed_settings(read_text_file(path), path);
}

bool same_setting(std::string_view a, std::string_view b) {
  const std::vector<std::string> scalars_a = scalars_of(a);
  const std::vector<std::string> scalars_b = scalars_of(b);
  return std::equal(scalars_a.begin(), scalars_a.end(), scalars_b.begin(), scalars_b.end(), same_scalar);
}

}  // namespace swiftlet::io
