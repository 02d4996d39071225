// Measured values beside their limits, as a table or as JSON.
#pragma once

#include <cstdio>
#include <string>

#include <nlohmann/json.hpp>

namespace swiftlet::bench {

struct Row {
  std::string what;
  double value = 0.0;
  std::string unit;
  std::string limit;         // name of the limit; empty: none
  double limit_value = 0.0;  // in the same unit
  std::string target;
};

class Table {
 public:
  explicit Table(bool as_json) : json_(as_json) {
    if (!json_) std::printf("%-52s %12s %-6s %12s %8s  %s\n", "", "measured", "", "limit", "ratio", "of");
  }

  void section(const std::string& title) {
    section_ = title;
    if (!json_) std::printf("\n%s\n", title.c_str());
  }

  void add(const Row& row) {
    nlohmann::ordered_json entry{
        {"section", section_}, {"what", row.what}, {"value", row.value}, {"unit", row.unit}};
    if (!row.limit.empty()) entry["limit"] = {{"what", row.limit}, {"value", row.limit_value}};
    if (!row.target.empty()) entry["target"] = row.target;
    rows_.push_back(entry);
    if (json_) return;
    std::printf("  %-50s %12.2f %-6s", row.what.c_str(), row.value, row.unit.c_str());
    if (!row.limit.empty()) {
      std::printf(" %12.2f", row.limit_value);
      std::printf(row.limit_value > 0.0 ? " %8.2f" : "         ", row.value / row.limit_value);
      std::printf("  %s", row.limit.c_str());
    }
    if (!row.target.empty()) std::printf("%s (%s)", row.limit.empty() ? "  " : "", row.target.c_str());
    std::printf("\n");
    std::fflush(stdout);
  }

  void end() const {
    if (json_) std::printf("%s\n", rows_.dump(2).c_str());
  }

 private:
  bool json_;
  std::string section_;
  nlohmann::ordered_json rows_ = nlohmann::ordered_json::array();
};

}  // namespace swiftlet::bench
