#include "swiftlet/io/csv.hpp"

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "tests/unit/io/config_error_check.hpp"

namespace swiftlet::io::csv_test {

using tests::refusal;

Table read(std::string_view text, std::size_t min_rows = 1) {
  return parse_csv(text, "f.csv", {"t", "a"}, min_rows);
}

std::string refused(std::string_view text, std::size_t min_rows = 1) {
  return refusal([&] { read(text, min_rows); });
}

TEST(Csv, ReadsRowsOfNumbers) {
  for (const std::string_view text :
       {"t,a\n0,1.5\n+1e-3,-2\n", "t,a\r\n0,1.5\r\n+1e-3,-2\r\n", "t,a\n0,1.5\n+1e-3,-2",
        " t ,\ta\n 0 , 1.5\t\n+1e-3,-2\n\n \n", "\xef\xbb\xbft,a\n0,1.5\n+1e-3,-2\n"}) {
    const Table table = read(text);
    ASSERT_EQ(table.row_count(), 2U) << text;
    EXPECT_EQ(table.column_count(), 2U);
    EXPECT_EQ(table.number(0, 0), 0.0);
    EXPECT_EQ(table.number(0, 1), 1.5);
    EXPECT_EQ(table.number(1, 0), 1.0e-3);
    EXPECT_EQ(table.number(1, 1), -2.0);
    EXPECT_EQ(table.line(1), 3);
  }
}

TEST(Csv, RefusesBadHeaders) {
  EXPECT_EQ(refused(""), "f.csv: is empty, must begin with the header t,a");
  EXPECT_EQ(refused(" \n\n"), "f.csv: is empty, must begin with the header t,a");
  EXPECT_EQ(refused("0,1\n1,2\n"), "f.csv:1: has no header, the first line must be t,a");
  EXPECT_EQ(refused("a,t\n1,2\n"), "f.csv:1: header: is a,t, must be t,a");
  EXPECT_EQ(refused("t,a,b\n1,2,3\n"), "f.csv:1: header: is t,a,b, must be t,a");
  EXPECT_EQ(refused("t\n1\n"), "f.csv:1: header: is t, must be t,a");
}

// As Excel, R, pandas and others write them.
TEST(Csv, ReadsTheSameTableOfEveryProgram) {
  for (const std::string_view text :
       {"t,a\n0,-0.5\n1,2\n", "\xef\xbb\xbft,a\n0,-0.5\n1,2\n", "t,a\r0,-0.5\r1,2\r", "t;a\n0;-0.5\n1;2\n",
        "t;a\n0;-0,5\n1;2\n", "sep=;\r\nt;a\r\n0;-0,5\r\n1;2\r\n", "t\ta\n0\t-0,5\n1\t2\n",
        "\"t\",\"a\"\n\"0\",\"-0.5\"\n1,2\n", "\"t\";\"a\"\n0;-0,5\n1;2\n",
        "\xc2\xa0t,a\n0,\xc2\xa0-0.5\xc2\xa0\n1,\xe2\x80\xaf"
        "2\n"}) {
    for (const Table& table : {read(text), parse_csv_as_headed(text, "f.csv")}) {
      ASSERT_EQ(table.row_count(), 2U) << text;
      EXPECT_EQ(table.columns(), (std::vector<std::string>{"t", "a"})) << text;
      EXPECT_EQ(table.number(0, 1), -0.5) << text;
      EXPECT_EQ(table.last_digit(0, 1), 0.1) << text;
    }
    std::vector<std::string> lines;
    for (const CsvLine& line : csv_lines(text, "f.csv")) lines.emplace_back(line.text);
    EXPECT_EQ(lines.size(), 3U) << text;
  }
}

TEST(Csv, NamesWhyATableCannotBeRead) {
  const std::string utf16("\xff\xfet\0,\0a\0", 8);
  for (const auto& parse : std::vector<std::function<void(const std::string&)>>{
           [](const std::string& text) { read(text); },
           [](const std::string& text) { parse_csv_as_headed(text, "f.csv"); },
           [](const std::string& text) { csv_lines(text, "f.csv"); }})
    EXPECT_EQ(refusal([&] { parse(utf16); }), "f.csv: is UTF-16, must be UTF-8");
  EXPECT_EQ(refused("t;a\n0;1,5\n1.5;2\n"),
            "f.csv:2: has commas beside semicolons: numbers must have points");
  EXPECT_EQ(refused("t,a\n0,\xe2\x88\x92"
                    "0.5\n"),
            "f.csv:2: a: is ???0.5, must be a finite number: it has U+2212, a minus sign of typography");
  EXPECT_EQ(refused("t,a\n0,1\nnan,nan\n"), "f.csv:3: t: is nan, must be a finite number");
}

TEST(Csv, RefusesBadRows) {
  EXPECT_EQ(refused("t,a\n0,1\n1\n"), "f.csv:3: has 1 fields, must have 2: t,a");
  EXPECT_EQ(refused("t,a\n0,1,2\n"), "f.csv:2: has 3 fields, must have 2: t,a");
  EXPECT_EQ(refused("t,a\n0,1\n\n2,3\n"), "f.csv:3: has 0 fields, must have 2: t,a");
  EXPECT_EQ(refused("t,a\n0,1\n1,\n"), "f.csv:3: a: is empty, must be a finite number");
  for (const std::string bad : {"x", "1.0.0", "1 2", "nan", "inf", "-inf", "1e999", "0x10", "++1", "1;2"})
    EXPECT_EQ(refused("t,a\n0," + bad + "\n"), "f.csv:2: a: is " + bad + ", must be a finite number");
}

TEST(Csv, QuotesBadFieldsInShortAscii) {
  EXPECT_EQ(refused("t,a\n0,\xff\xfez\n"), "f.csv:2: a: is ??z, must be a finite number");
  EXPECT_EQ(refused("t,a\n0,\x01z\n"), "f.csv:2: is not a text file: it has control characters");
  EXPECT_EQ(refused("t,a\n0," + std::string(100, 'x') + "\n"),
            "f.csv:2: a: is " + std::string(60, 'x') + "..., must be a finite number");
}

TEST(Csv, RequiresAMinimumOfRows) {
  EXPECT_EQ(refused("t,a\n"), "f.csv: has 0 rows behind the header, must have at least 1");
  EXPECT_EQ(refused("t,a\n0,1\n", 2), "f.csv: has 1 rows behind the header, must have at least 2");
  EXPECT_EQ(read("t,a\n", 0).row_count(), 0U);
}

TEST(Csv, ChecksBounds) {
  const Table table = read("t,a\n0,1\n1,2000.5\n");
  EXPECT_EQ(table.number(1, 1, between(1000, 2001), "us"), 2000.5);
  EXPECT_EQ(refusal([&] { table.number(1, 1, between(1000, 2000), "us"); }),
            "f.csv:3: a: is 2000.5, must be at least 1000 and at most 2000 us");
  EXPECT_EQ(refusal([&] { table.number(0, 0, above(0)); }), "f.csv:2: t: is 0, must be above 0");
  EXPECT_EQ(refusal([&] { table.fail(1, "t", "is 1, must be below 0.5"); }),
            "f.csv:3: t: is 1, must be below 0.5");
}

TEST(Csv, KnowsTheLastDigitOfANumber) {
  const Table decimals = read("t,a\n0,0.5\n1.25,12.345\n");
  EXPECT_NEAR(decimals.last_digit(0, 0), 0.01, 1e-15);
  EXPECT_NEAR(decimals.last_digit(0, 1), 0.001, 1e-15);
  EXPECT_NEAR(decimals.last_digit(1, 1), 0.001, 1e-15);
  const Table significant = read("t,a\n0.12345,1.2345e-3\n123.45,-1.2345e+02\n0,0\n");
  for (const std::size_t column : {0U, 1U}) EXPECT_NEAR(significant.last_digit(1, column), 0.01, 1e-12);
  EXPECT_NEAR(significant.last_digit(0, 0), 1e-5, 1e-15);
  EXPECT_NEAR(significant.last_digit(0, 1), 1e-7, 1e-15);
  EXPECT_NEAR(read("t,a\n1000,20\n3000,5\n").last_digit(0, 0), 1.0, 1e-12);
}

TEST(Csv, NamesAMissingFile) {
  EXPECT_NE(refusal([] { load_csv("/nowhere/f.csv", {"t"}); }).find("/nowhere/f.csv: "), std::string::npos);
}

TEST(Csv, WritesNumbersThatReadBack) {
  EXPECT_EQ(exact(0.1), "0.1");
  EXPECT_EQ(exact(1.0), "1");
  EXPECT_EQ(exact(-2.5e-7), "-2.5e-07");
  EXPECT_EQ(std::stod(exact(1.0 / 3.0)), 1.0 / 3.0);
}

}  // namespace swiftlet::io::csv_test
