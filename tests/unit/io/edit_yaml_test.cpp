#include "swiftlet/io/edit_yaml.hpp"

#include <gtest/gtest.h>

#include "swiftlet/io/config_error.hpp"

namespace swiftlet::io::edit_yaml_test {

constexpr const char* kText =
    "# gains\n"
    "name: old  # of this file\n"
    "title: \"two words\"\n"
    "roll: {q: [40000, 0, 0], r: 1}\n"
    "x:\n"
    "  omega: 2.0\n";

TEST(EditYaml, ReplacesScalarsOnly) {
  EXPECT_EQ(
      with_scalars(
          kText, "f",
          {{"x.omega", "1.25"}, {"roll.q[0]", "12"}, {"roll.r", "3"}, {"name", "new"}, {"title", "one"}}),
      "# gains\n"
      "name: new  # of this file\n"
      "title: one\n"
      "roll: {q: [12, 0, 0], r: 3}\n"
      "x:\n"
      "  omega: 1.25\n");
}

TEST(EditYaml, RefusesWhatItDoesNotFind) {
  const auto refusal = [](const std::string& key) -> std::string {
    try {
      with_scalars(kText, "f.yaml", {{key, "1"}});
    } catch (const ConfigError& error) {
      return error.what();
    }
    return "accepted";
  };
  EXPECT_EQ(refusal("y.omega"), "f.yaml: y.omega is missing");
  EXPECT_EQ(refusal("roll.q[3]"), "f.yaml: roll.q[3] is missing");
  EXPECT_EQ(refusal("name.first"), "f.yaml: name.first is missing");
  EXPECT_EQ(refusal("roll.q"), "f.yaml: roll.q is no single value");
  EXPECT_THROW(with_scalars("a: [1", "f", {{"a", "1"}}), ConfigError);
  EXPECT_THROW(with_scalars("a: &v 1\nb: *v\n", "f", {{"a", "2"}, {"b", "2"}}), ConfigError);
}

}  // namespace swiftlet::io::edit_yaml_test
