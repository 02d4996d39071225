#include "swiftlet/io/config.hpp"

#include <filesystem>
#include <fstream>
#include <random>
#include <unistd.h>

#include <gtest/gtest.h>

#include "swiftlet/io/text_file.hpp"
#include "tests/unit/io/config_error_check.hpp"

namespace swiftlet::io::config_test {

using tests::refusal;

std::string parse_refusal(const std::string& text) {
  return refusal([&] { parse_config(text, "f.yaml"); });
}

TEST(Config, ReadsEachKindOfValue) {
  const ConfigNode root = parse_config(
      "number: -1.5e-3\n"
      "plus: +2\n"
      "count: 7\n"
      "flag: true\n"
      "text: two words\n"
      "quoted: \"1\"\n"
      "choice: b\n"
      "list: [1, 2, 3]\n"
      "block:\n  - {x: 1}\n  - {x: 2}\n"
      "mass: {value: 0.04, unit: kg, source: estimate}\n"
      "free: {p: 1, q: 2}\n",
      "f.yaml");
  EXPECT_EQ(root.at("number").number(), -1.5e-3);
  EXPECT_EQ(root.at("plus").number(), 2.0);
  EXPECT_EQ(root.at("count").integer(), 7);
  EXPECT_TRUE(root.at("flag").boolean());
  EXPECT_EQ(root.at("text").text(), "two words");
  EXPECT_EQ(root.at("quoted").text(), "1");
  EXPECT_EQ(root.at("choice").choice<int>({{"a", 10}, {"b", 20}}), 20);
  EXPECT_EQ(root.at("list").numbers(3, 3), (std::vector<double>{1, 2, 3}));
  EXPECT_EQ(root.at("list").vector3(), Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(root.at("block").items()[1].at("x").number(), 2.0);
  EXPECT_EQ(root.at("mass").quantity("kg").number(), 0.04);
  EXPECT_FALSE(root.find("absent"));
  const auto entries = root.at("free").entries();
  ASSERT_EQ(entries.size(), 2U);
  EXPECT_EQ(entries[1].first, "q");
  EXPECT_EQ(entries[1].second.number(), 2.0);
  EXPECT_EQ(refusal([&] { root.reject_unknown_keys(); }),
            "f.yaml:10: block[0].x: is unknown, must be left out");  // only the second was read
  EXPECT_EQ(root.at("block").items()[0].at("x").number(), 1.0);
  root.reject_unknown_keys();
}

TEST(Config, NodesKnowTheirKeyAndLine) {
  const ConfigNode root = parse_config("# a comment\na:\n  b:\n    - 1\n    - {c: 2}\n", "f.yaml");
  const ConfigNode c = root.at("a").at("b").items()[1].at("c");
  EXPECT_EQ(c.key(), "a.b[1].c");
  EXPECT_EQ(c.line(), 5);
  EXPECT_EQ(root.nearest("a.b[1].c").line(), 5);
  EXPECT_EQ(root.nearest("a.b[1].d").key(), "a.b[1]");
  EXPECT_EQ(root.nearest("a.b[7]").key(), "a.b");
  EXPECT_EQ(root.nearest("ab").key(), "");
}

TEST(Config, ErrorHoldsFileLineKeyAndMessage) {
  try {
    parse_config("x: 1\ny: 5\n", "f.yaml").at("y").number(at_most(3.0));
    FAIL();
  } catch (const ConfigError& error) {
    EXPECT_EQ(error.file(), "f.yaml");
    EXPECT_EQ(error.line(), 2);
    EXPECT_EQ(error.key(), "y");
    EXPECT_STREQ(error.what(), "f.yaml:2: y: is 5, must be at most 3");
  }
}

TEST(Config, RefusesTextThatIsNotOneMap) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"", "f.yaml: is empty, must be a YAML map"},
      {"\n", "f.yaml: is empty, must be a YAML map"},
      {"# nothing\n", "f.yaml: is empty, must be a YAML map"},
      {"---\n", "f.yaml: is empty, must be a YAML map"},
      {"word\n", "f.yaml:1: is word, must be a YAML map"},
      {"- 1\n", "f.yaml:1: is a list, must be a YAML map"},
      {"a: 1", "f.yaml:1: is truncated: the last line must end with a newline"},
      {"a: 1\nb: 2\na: 3\n", "f.yaml:3: a: is given twice, first in line 1"},
      {"a:\n  b: {c: 1, c: 2}\n", "f.yaml:2: a.b.c: is given twice, first in line 2"},
      {"a: &x 1\n", "f.yaml:1: has an anchor, must be without"},
      {"a: !!float 1\n", "f.yaml:1: has the tag tag:yaml.org,2002:float, must be without"},
      {"a: 1\n---\nb: 2\n", "f.yaml:2: starts a second document, must be one"},
      {"a: [1, 2\n", "f.yaml:1: is not valid YAML: the [ here is not closed"},
      {"a:\n  - {b: 1, c: 2\n  - {b: 3}\n", "f.yaml:2: is not valid YAML: the { here is not closed"},
      {"a:\n  - {b: '}', c: 2  # }\n  - {b: 3}\n  - {b: 3}\n",
       "f.yaml:2: is not valid YAML: the { here is not closed"},
      {"a:\n  - {b: 1, c: [2, 3}\n  - {b: 3}\n", "f.yaml:2: is not valid YAML: the [ here is not closed"},
      {"a: {b: 1,\n  c: 2\nd: {e: 3}\n", "f.yaml:1: is not valid YAML: the { here is not closed"},
      {"a:\xc2\xa0"
       "1\n",
       "f.yaml:1: is a:\xc2\xa0"
       "1, must be a YAML map: it has U+00A0, a no-break space"},
      {"a:\n\xc2\xa0\xc2\xa0- {b: 1}\n  - {b: 2}\n",
       "f.yaml:3: is not valid YAML: illegal map value: it has U+00A0, a no-break space"},
      {"\xff\xfe"
       "a: 1\n",
       "f.yaml: is UTF-16, must be UTF-8"},
      {"a: b: c\n", "f.yaml:1: is not valid YAML: illegal map value"},
      {"a: 'x\n", "f.yaml:2: is not valid YAML: illegal document indicator in scalar"},
      {"a: \"x\n", "f.yaml:2: is not valid YAML: illegal document indicator in scalar"},
      {"? [1]\n: 2\n", "f.yaml:1: has a key that is not a text, must be a plain name"},
      {"'': 2\n", "f.yaml:1: has the key \"\", must be one line of 1 to 60 bytes"},
      {"a: 1\n\x01\n", "f.yaml:2: is not a text file, must be UTF-8 without control characters"},
      {"a: \xff\n", "f.yaml:1: is not a text file, must be UTF-8 without control characters"},
      {"a: \xc0\x80\n", "f.yaml:1: is not a text file, must be UTF-8 without control characters"},
      {"a: \xed\xa0\x80\n", "f.yaml:1: is not a text file, must be UTF-8 without control characters"},
      {std::string("a: 1\0\n", 6), "f.yaml:1: is not a text file, must be UTF-8 without control characters"},
  };
  for (const auto& [text, message] : cases) EXPECT_EQ(parse_refusal(text), message);
}

TEST(Config, AcceptsEveryStyleOfAMap) {
  for (const char* text : {"a: 1\n", "---\na: 1\n", "a: 1\n...\n", "{a: 1}\n", "{\"a\": 1}\n", "a: 1\r\n",
                           "# c\na: 1  # d\n", "\uFEFFa: 1\n"}) {
    EXPECT_EQ(parse_config(text, "f.yaml").at("a").number(), 1.0) << text;
  }
  EXPECT_EQ(parse_config("a: gr\xc3\xbc\xc3\x9f\n", "f.yaml").at("a").text(), "gr\xc3\xbc\xc3\x9f");
}

TEST(Config, RefusesNestingBeyondTheLimit) {
  std::string list = "a: ";
  for (int i = 0; i < 100000; ++i) list += '[';
  EXPECT_NE(parse_refusal(list + "\n").find("f.yaml:1: "), std::string::npos);
  std::string block;
  for (int i = 0; i < 2000; ++i) block += "- ";
  EXPECT_NE(parse_refusal(block + "\n").find("is nested too deeply, must be at most 24 levels"),
            std::string::npos);
  for (const char* opener : {"{", "? ", "a: {", "[{", "!", "*", "%", "\"", "|", "&"}) {
    std::string text;
    for (int i = 0; i < 20000; ++i) text += opener;
    EXPECT_NE(parse_refusal(text + "\n"), "") << opener;
  }
}

TEST(Config, RefusesTooManyKeysAndBytes) {
  std::string keys;
  for (int i = 0; i < 1001; ++i) keys += "k" + std::to_string(i) + ": 1\n";
  EXPECT_EQ(parse_refusal(keys), "f.yaml:1001: has too many keys, must have at most 1000");
  const std::string comment(5 << 20, '#');
  EXPECT_EQ(parse_refusal(comment + "\n"), "f.yaml: is too large, must hold at most 4194304 bytes");
}

TEST(Config, RefusesValuesWithKeyLineValueAndLimit) {
  const ConfigNode root = parse_config(
      "a: .nan\nb: 1e999\nc: \"1\"\nd: 0x10\ne: 1_0\nf: -1\ng: [1, 2]\nh: 1.5\ni: 99999999999999999999\nj: "
      "inf\n"
      "k:\nl: {value: 1, unit: g, source: x}\nm: {value: 1, unit: kg}\nn: {value: 1, unit: kg, source: ''}\n"
      "o: [1, two, 3]\np: \"a\\nb\"\nq: 5\nr: -.inf\ns: 1.0.0\nt: +-1\n",
      "f.yaml");
  const auto number = [&](const char* key, const Bounds& bounds = any_number()) {
    return refusal([&] { root.at(key).number(bounds); });
  };
  EXPECT_EQ(number("a"), "f.yaml:1: a: is .nan, must be a finite number");
  EXPECT_EQ(number("b"), "f.yaml:2: b: is 1e999, must be a finite number");
  EXPECT_EQ(number("c"), "f.yaml:3: c: is \"1\", must be a number");
  EXPECT_EQ(number("d"), "f.yaml:4: d: is 0x10, must be a number");
  EXPECT_EQ(number("e"), "f.yaml:5: e: is 1_0, must be a number");
  EXPECT_EQ(number("f", above(0.0)), "f.yaml:6: f: is -1, must be above 0");
  EXPECT_EQ(number("f", at_least(0.0)), "f.yaml:6: f: is -1, must be at least 0");
  EXPECT_EQ(number("q", between(0.0, 0.5)), "f.yaml:17: q: is 5, must be at least 0 and at most 0.5");
  EXPECT_EQ(number("q", {5.0, 9.0, true, true}), "f.yaml:17: q: is 5, must be above 5 and below 9");
  EXPECT_EQ(number("g"), "f.yaml:7: g: is a list, must be a number");
  EXPECT_EQ(number("j"), "f.yaml:10: j: is inf, must be a finite number");
  EXPECT_EQ(number("k"), "f.yaml:11: k: is empty, must be a number");
  EXPECT_EQ(number("r"), "f.yaml:18: r: is -.inf, must be a finite number");
  EXPECT_EQ(number("s"), "f.yaml:19: s: is 1.0.0, must be a number");
  EXPECT_EQ(number("t"), "f.yaml:20: t: is +-1, must be a number");
  EXPECT_EQ(number("z"), "f.yaml:1: z: is missing, must be given");
  EXPECT_EQ(refusal([&] { root.at("g").vector3(); }), "f.yaml:7: g: is a list of 2, must be a list of 3");
  EXPECT_EQ(refusal([&] { root.at("g").items(3, 9); }),
            "f.yaml:7: g: is a list of 2, must be a list of 3 to 9");
  EXPECT_EQ(refusal([&] { root.at("h").items(); }), "f.yaml:8: h: is 1.5, must be a list");
  EXPECT_EQ(refusal([&] { root.at("o").vector3(); }), "f.yaml:15: o[1]: is two, must be a number");
  EXPECT_EQ(refusal([&] { root.at("h").integer(); }), "f.yaml:8: h: is 1.5, must be a whole number");
  EXPECT_EQ(refusal([&] { root.at("i").integer(0, 5); }),
            "f.yaml:9: i: is 99999999999999999999, must be a whole number from 0 to 5");
  EXPECT_EQ(refusal([&] { root.at("f").integer(0, 5); }),
            "f.yaml:6: f: is -1, must be a whole number from 0 to 5");
  EXPECT_EQ(refusal([&] { root.at("f").boolean(); }), "f.yaml:6: f: is -1, must be true or false");
  EXPECT_EQ(refusal([&] { root.at("g").text(); }), "f.yaml:7: g: is a list, must be a text");
  EXPECT_EQ(refusal([&] { root.at("p").text(); }), "f.yaml:16: p: is \"a?b\", must be a text of one line");
  EXPECT_EQ(refusal([&] {
              root.at("d").choice<int>({{"x", 1}, {"y", 2}, {"z", 3}});
            }),
            "f.yaml:4: d: is 0x10, must be x, y or z");
  EXPECT_EQ(refusal([&] { root.at("q").at("x"); }), "f.yaml:17: q: is 5, must be a map");
  EXPECT_EQ(refusal([&] { root.at("q").quantity("kg"); }),
            "f.yaml:17: q: is 5, must be a map {value, unit, source}");
  EXPECT_EQ(refusal([&] { root.at("l").quantity("kg"); }), "f.yaml:12: l.unit: is g, must be kg");
  EXPECT_EQ(refusal([&] { root.at("m").quantity("kg"); }), "f.yaml:13: m.source: is missing, must be given");
  EXPECT_EQ(refusal([&] { root.at("n").quantity("kg"); }), "f.yaml:14: n.source: is \"\", must be a text");
}

TEST(Config, NamesCharactersOfTypographyInNumbers) {
  const ConfigNode root = parse_config(
      "a: \xe2\x88\x92"
      "1\nb: \xc2\xa0"
      "2\n",
      "f.yaml");
  EXPECT_EQ(refusal([&] { root.at("a").number(); }),
            "f.yaml:1: a: is \xe2\x88\x92"
            "1, must be a number: it has U+2212, a minus sign of typography");
  EXPECT_EQ(refusal([&] { root.at("b").number(); }),
            "f.yaml:2: b: is \xc2\xa0"
            "2, must be a number: it has U+00A0, a no-break space");
}

// Reads a, b.c and b.kind as a loader does.
std::string loading(const std::string& text) {
  try {
    const ConfigNode root = parse_config(text, "f.yaml");
    root.read_known([&] {
      root.at("mass").quantity("kg").number();
      const ConfigNode rotor = root.at("rotor");
      rotor.at("spin").choice<int>({{"left", 1}, {"right", 2}});
      rotor.at("place").vector3(above(0.0));
    });
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "read";
}

TEST(Config, AMisspeltKeyIsNamedBeforeTheMissingOne) {
  const std::string mass = "mass: {value: 1, unit: kg, source: s}\n";
  const std::string rotor = "rotor: {spin: left, place: [1, 2, 3]}\n";
  EXPECT_EQ(loading(mass + rotor), "read");
  EXPECT_EQ(loading("masss: 0.04\n" + rotor),
            "f.yaml:1: masss: is unknown, must be one of mass or rotor; nearest is mass");
  EXPECT_EQ(loading("weight: 0.04\n" + rotor), "f.yaml:1: weight: is unknown, must be one of mass or rotor");
  EXPECT_EQ(loading(mass + "rotor: {spinn: left, place: [1, 2, 3]}\n"),
            "f.yaml:2: rotor.spinn: is unknown, must be one of spin or place; nearest is spin");
  EXPECT_EQ(loading("mass: {valu: 1, unit: kg, source: s}\n" + rotor),
            "f.yaml:1: mass.valu: is unknown, must be one of value, unit or source; nearest is value");
  EXPECT_EQ(loading(rotor), "f.yaml:1: mass: is missing, must be given");
  EXPECT_EQ(loading(mass), "f.yaml:1: rotor: is missing, must be given");
  EXPECT_EQ(loading(mass + "rotor: {spin: left}\n"), "f.yaml:2: rotor.place: is missing, must be given");
}

TEST(Config, AMisspeltChoiceGetsTheNearestName) {
  const ConfigNode root = parse_config("kind: waypont\n", "f.yaml");
  EXPECT_EQ(refusal([&] {
              root.at("kind").choice<int>({{"takeoff", 1}, {"waypoint", 2}, {"land", 3}});
            }),
            "f.yaml:1: kind: is waypont, must be takeoff, waypoint or land; nearest is waypoint");
}

TEST(Config, RefusesKeysThatWereNotRead) {
  const ConfigNode root = parse_config("mass: 1\nspeed:\n  limit: 1\n  limti: 2\n", "f.yaml");
  root.at("mass");
  root.at("speed").at("limit");
  root.at("speed").find("ramp");
  EXPECT_EQ(refusal([&] { root.reject_unknown_keys(); }),
            "f.yaml:4: speed.limti: is unknown, must be one of limit or ramp; nearest is limit");
}

TEST(Config, NodesOutliveTheRoot) {
  const auto make = [] { return parse_config("a: {b: 3}\n", "f.yaml").at("a"); };
  EXPECT_EQ(make().at("b").number(), 3.0);
}

TEST(Config, ReadsOrRefusesRandomText) {
  // Random texts over YAML's own characters give a map or a ConfigError.
  const std::string alphabet = "ab1 :-?[]{},#&*!|>'\"%@`\n\n\t.~<=\\";
  std::mt19937 generator(7);
  int read = 0;
  for (int i = 0; i < 30000; ++i) {
    std::string text;
    const std::size_t length = generator() % 40;
    for (std::size_t k = 0; k < length; ++k) text += alphabet[generator() % alphabet.size()];
    if (generator() % 2 == 0) text += '\n';
    try {
      const ConfigNode root = parse_config(text, "f.yaml");
      EXPECT_TRUE(root.is_map());
      ++read;
    } catch (const ConfigError&) {
    }
  }
  EXPECT_GT(read, 100);  // some of the texts are maps
}

TEST(TextFile, ErrorNamesFileAndReason) {
  EXPECT_EQ(refusal([] { read_text_file("/nonexistent/f.yaml"); }),
            "/nonexistent/f.yaml: cannot be read: No such file or directory");
  EXPECT_EQ(refusal([] { load_config("/"); }), "/: cannot be read: Is a directory");
  EXPECT_EQ(refusal([] { read_text_file("/dev/zero", 1000); }),
            "/dev/zero: is too large, must hold at most 1000 bytes");
}

TEST(TextFile, ReadsTheWholeFile) {
  const auto path = std::filesystem::temp_directory_path() / ("swiftlet-text-" + std::to_string(::getpid()));
  std::string text(200000, 'x');
  text.append("\0end\n", 5);
  std::ofstream(path, std::ios::binary) << text;
  EXPECT_EQ(read_text_file(path.string()), text);
  std::filesystem::remove(path);
}

}  // namespace swiftlet::io::config_test
