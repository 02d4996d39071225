#include "swiftlet/io/csv_writer.hpp"

#include <array>
#include <limits>
#include <stdexcept>

#include <gtest/gtest.h>

#include "swiftlet/io/atomic_write.hpp"
#include "swiftlet/io/text_file.hpp"
#include "tests/support/temporary_folder.hpp"

namespace swiftlet::io::csv_writer_test {

class CsvWriterTest : public testing::Test {
 protected:
  std::string written() const { return read_text_file(file_.string()); }

  tests::TemporaryFolder folder_;
  std::filesystem::path file_ = folder_.path() / "table.csv";
};

TEST_F(CsvWriterTest, WritesCellsInTheirFormats) {
  CsvWriter csv(file_, {"t", "x", "y", "z", "name"});
  csv.fixed(0.1, 6).number(1.0 / 3.0).number(2.5, 3).exact(0.1).text("plain").end_row();
  csv.numbers(std::array{1.0, -2.0, 1e-12}).empty(2).end_row();
  csv.empty().number(std::numeric_limits<double>::quiet_NaN()).empty(3).end_row();
  csv.finish();
  EXPECT_EQ(written(),
            "t,x,y,z,name\n"
            "0.100000,0.333333333,2.5,0.1,plain\n"
            "1,-2,1e-12,,\n"
            ",nan,,,\n");
}

TEST_F(CsvWriterTest, QuotesTextThatWouldBreakTheRow) {
  CsvWriter csv(file_, {"a,b", "c"});
  csv.text("says \"no\"").text("two\nlines").end_row();
  csv.finish();
  EXPECT_EQ(written(), "\"a,b\",c\n\"says \"\"no\"\"\",\"two\nlines\"\n");
}

TEST_F(CsvWriterTest, QuotesAllTextOnRequest) {
  CsvWriter csv(file_, {"a", "b", "c"});
  csv.quoted("").quoted("plain").quoted("says \"no\", twice").end_row();
  csv.finish();
  EXPECT_EQ(written(), "a,b,c\n\"\",\"plain\",\"says \"\"no\"\", twice\"\n");
}

TEST_F(CsvWriterTest, NamesTheFileWhenItIsComplete) {
  CsvWriter csv(file_, {"t"});
  csv.number(1).end_row();
  EXPECT_FALSE(std::filesystem::exists(file_));
  csv.finish();
  EXPECT_EQ(written(), "t\n1\n");
  EXPECT_FALSE(std::filesystem::exists(unfinished_name(file_)));
}

TEST_F(CsvWriterTest, ReportsAFileThatCannotBeWritten) {
  EXPECT_THROW(CsvWriter(folder_.path() / "none" / "table.csv", {"a"}), std::runtime_error);
  CsvWriter full("/dev/full", {"a"});
  for (int i = 0; i < 10000; ++i) full.number(i).end_row();
  try {
    full.finish();
    FAIL() << "no error on a full disk";
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "/dev/full: cannot be written: No space left on device");
  }
}

}  // namespace swiftlet::io::csv_writer_test
