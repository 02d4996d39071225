#include "swiftlet/ground/teleop/input_device.hpp"

#include <cstring>
#include <fcntl.h>
#include <linux/input.h>
#include <stdexcept>
#include <sys/stat.h>
#include <unistd.h>

#include <gtest/gtest.h>

#include "tests/support/temporary_folder.hpp"

namespace swiftlet::ground::input_device_test {

class EventFifo : public testing::Test {
 protected:
  void SetUp() override { ASSERT_EQ(mkfifo(path().c_str(), 0600), 0); }
  void TearDown() override {
    if (writer_ >= 0) close(writer_);
  }

  std::string path() const { return folder_.path() / "event"; }
  void open_writer() {
    writer_ = open(path().c_str(), O_WRONLY | O_NONBLOCK | O_CLOEXEC);
    ASSERT_GE(writer_, 0);
  }
  void close_writer() {
    close(writer_);
    writer_ = -1;
  }
  static std::string bytes_of(int type, int code, int value) {
    input_event event{};
    event.type = static_cast<std::uint16_t>(type);
    event.code = static_cast<std::uint16_t>(code);
    event.value = value;
    std::string bytes(sizeof event, '\0');
    std::memcpy(bytes.data(), &event, sizeof event);
    return bytes;
  }
  void put(const std::string& bytes) const {
    ASSERT_EQ(write(writer_, bytes.data(), bytes.size()), static_cast<ssize_t>(bytes.size()));
  }

  tests::TemporaryFolder folder_;
  int writer_ = -1;
};

TEST_F(EventFifo, TakesEventsAsTheyCome) {
  InputDevice device(path());
  EXPECT_EQ(device.name(), path());
  EXPECT_TRUE(device.update()) << "no writer has come yet";
  open_writer();
  EXPECT_TRUE(device.update());
  put(bytes_of(EV_KEY, BTN_TL, 1) + bytes_of(EV_ABS, ABS_RY, -32768) + bytes_of(EV_SYN, SYN_REPORT, 0));
  EXPECT_TRUE(device.update());
  EXPECT_EQ(device.gamepad().sticks().forward, 1.0);
}

TEST_F(EventFifo, JoinsEventsThatComeInParts) {
  InputDevice device(path());
  open_writer();
  const std::string bytes = bytes_of(EV_KEY, BTN_TL, 1) + bytes_of(EV_ABS, ABS_RX, 32767);
  for (const char byte : bytes) {
    EXPECT_EQ(device.gamepad().sticks().right, 0.0);
    put(std::string(1, byte));
    EXPECT_TRUE(device.update());
  }
  EXPECT_EQ(device.gamepad().sticks().right, 1.0);
}

TEST_F(EventFifo, TakesMoreEventsThanOneReadHolds) {
  InputDevice device(path());
  open_writer();
  put(bytes_of(EV_KEY, BTN_TL, 1));
  std::string bytes;
  for (int i = 0; i < 1000; ++i) bytes += bytes_of(EV_ABS, ABS_X, i);
  put(bytes + bytes_of(EV_ABS, ABS_X, 32767));
  EXPECT_TRUE(device.update());
  EXPECT_EQ(device.gamepad().sticks().turn, 1.0);
}

TEST_F(EventFifo, EndsWithItsWriter) {
  InputDevice device(path());
  open_writer();
  put(bytes_of(EV_KEY, BTN_TL, 1) + bytes_of(EV_ABS, ABS_RX, 32767));
  EXPECT_TRUE(device.update());
  EXPECT_FALSE(device.gamepad().sticks().centred());
  close_writer();
  EXPECT_FALSE(device.update());
  EXPECT_TRUE(device.gamepad().sticks().centred());
}

std::string fault_of(const std::string& path) {
  try {
    const InputDevice device(path);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

TEST_F(EventFifo, OtherFilesAreRefused) {
  EXPECT_EQ(fault_of("/dev/null"), "/dev/null is not an event device; they are /dev/input/event*");
  EXPECT_EQ(fault_of(path() + "9"), "cannot open " + path() + "9: No such file or directory");
  EXPECT_EQ(fault_of(folder_.write("file", "text")),
            (folder_.path() / "file").string() + " is not an event device; they are /dev/input/event*");
}

}  // namespace swiftlet::ground::input_device_test
