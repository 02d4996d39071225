#include "swiftlet/record/mcap/message_decoder.hpp"

#include <cstring>

#include <gtest/gtest.h>

#include "swiftlet/io/byte_writer.hpp"
#include "tests/unit/io/config_error_check.hpp"

namespace swiftlet::mcap::message_decoder_test {

using tests::refusal;

Schema schema(const std::string& definition) { return {1, "test_msgs/msg/Thing", "ros2msg", definition}; }

std::vector<std::string> names_of(const MessageDecoder& decoder) {
  std::vector<std::string> names;
  for (const Column& column : decoder.columns()) names.push_back(column.name);
  return names;
}

// Little-endian CDR.
class Cdr {
 public:
  template <class Number>
  Cdr& put(Number number) {
    while ((bytes_.size() - 4) % sizeof(number) != 0) bytes_.push_back(0);
    io::append(bytes_, number);
    return *this;
  }
  Cdr& text(const std::string& text) {
    put(static_cast<std::uint32_t>(text.size() + 1));
    bytes_.insert(bytes_.end(), text.begin(), text.end());
    bytes_.push_back(0);
    return *this;
  }
  const Bytes& bytes() const { return bytes_; }
  ByteView view() const { return {bytes_.data(), bytes_.size()}; }

 private:
  Bytes bytes_ = {0, 1, 0, 0};
};

const char* const kThing = R"(# A thing.
uint8 SMALL=1  # a constant
string NAME='none'
int64 stamp_ns # ns
bool ready
float64[2] position  # m
test_msgs/Part part
test_msgs/msg/Part[2] parts
Part[<=3] more
string<=16 text
uint16[] numbers
int8 last
================================================================================
MSG: test_msgs/Part
float32 x
uint8 flags
)";

TEST(MessageDecoder, GivesEachSignalAColumn) {
  const MessageDecoder decoder(schema(kThing));
  EXPECT_EQ(names_of(decoder),
            (std::vector<std::string>{"stamp_ns", "ready", "position[0]", "position[1]", "part.x",
                                      "part.flags", "parts[0].x", "parts[0].flags", "parts[1].x",
                                      "parts[1].flags", "more.length", "text", "numbers.length", "last"}));
  EXPECT_EQ(decoder.columns()[0].kind, Column::Kind::kSigned);
  EXPECT_EQ(decoder.columns()[1].kind, Column::Kind::kUnsigned);
  EXPECT_EQ(decoder.columns()[2].kind, Column::Kind::kFloat);
  EXPECT_EQ(decoder.columns()[11].kind, Column::Kind::kText);
}

Cdr thing() {
  Cdr cdr;
  cdr.put(std::int64_t{-5}).put(std::uint8_t{1}).put(1.5).put(-2.5);
  for (const float x : {0.5F, 0.25F, 0.125F}) cdr.put(x).put(std::uint8_t{7});
  cdr.put(std::uint32_t{2});
  for (const float x : {3.0F, 4.0F}) cdr.put(x).put(std::uint8_t{8});
  cdr.text("hover").put(std::uint32_t{3});
  for (const std::uint16_t number : {1, 2, 3}) cdr.put(number);
  cdr.put(std::int8_t{-1});
  return cdr;
}

TEST(MessageDecoder, DecodesEveryKindOfMember) {
  const MessageDecoder decoder(schema(kThing));
  std::vector<Value> values;
  ASSERT_TRUE(decoder.decode(thing().view(), values));
  const std::vector<Value> expected = {std::int64_t{-5},
                                       std::uint64_t{1},
                                       1.5,
                                       -2.5,
                                       0.5,
                                       std::uint64_t{7},
                                       0.25,
                                       std::uint64_t{7},
                                       0.125,
                                       std::uint64_t{7},
                                       std::uint64_t{2},
                                       std::string("hover"),
                                       std::uint64_t{3},
                                       std::int64_t{-1}};
  EXPECT_EQ(values, expected);
}

TEST(MessageDecoder, RefusesWhatIsShorterAtAnyByte) {
  const MessageDecoder decoder(schema(kThing));
  const Bytes whole = thing().bytes();
  std::vector<Value> values;
  for (std::size_t size = 0; size < whole.size(); ++size)
    EXPECT_FALSE(decoder.decode({whole.data(), size}, values)) << size;
}

TEST(MessageDecoder, RefusesDefinitionsThatItDoesNotUnderstand) {
  EXPECT_EQ(refusal([] { MessageDecoder(schema("float64 x\nwhatever y\n")); }),
            "test_msgs/msg/Thing:2: the type 'whatever' is not known");
  EXPECT_EQ(refusal([] { MessageDecoder(schema("float64\n")); }),
            "test_msgs/msg/Thing:1: 'float64' is not a member");
  EXPECT_EQ(refusal([] { MessageDecoder(schema("float64[many] x\n")); }),
            "test_msgs/msg/Thing:1: the length 'many' is not a number below 1000000");
  EXPECT_EQ(refusal([] { MessageDecoder(schema("float64[9999] x\n")); }),
            "test_msgs/msg/Thing: has more than 4096 signals");
  EXPECT_EQ(refusal([] { MessageDecoder(schema("Thing[] children\n")); }),
            "test_msgs/msg/Thing: nests messages more than 8 deep");
  EXPECT_EQ(refusal([] { MessageDecoder(schema("# nothing\n")); }),
            "test_msgs/msg/Thing: the message 'test_msgs/Thing' has no members");
  EXPECT_EQ(refusal([] {
              MessageDecoder({1, "test_msgs/msg/Thing", "jsonschema", "{}"});
            }),
            "test_msgs/msg/Thing: has the encoding 'jsonschema', must be ros2msg");
}

}  // namespace swiftlet::mcap::message_decoder_test
