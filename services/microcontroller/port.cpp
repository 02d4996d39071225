#include "swiftlet/services/microcontroller/port.hpp"

#include <algorithm>
#include <arpa/inet.h>
#include <cerrno>
#include <cstdlib>
#include <fcntl.h>
#include <netinet/in.h>
#include <poll.h>
#include <stdexcept>
#include <sys/socket.h>
#include <system_error>
#include <termios.h>
#include <unistd.h>
#include <utility>

#include "swiftlet/io/network/host_address.hpp"
#include "swiftlet/io/network/sockets.hpp"
#include "swiftlet/services/runtime/periodic_timer.hpp"

namespace swiftlet::services {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const std::string& what) {
  throw std::runtime_error(what + ": " + std::generic_category().message(errno));
}

int open_or_fail(int number, const std::string& what) {
  if (number < 0) fail(what);
  return number;
}

class PseudoTerminal final : public Port {
 public:
  explicit PseudoTerminal(fs::path link)
      : link_(std::move(link)),
        host_(open_or_fail(::posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC), "pseudo-terminal")),
        device_(open_or_fail(open_device(), "pseudo-terminal")) {
    termios raw{};
    if (::tcgetattr(device_.get(), &raw) != 0) fail("pseudo-terminal");
    ::cfmakeraw(&raw);
    if (::tcsetattr(device_.get(), TCSANOW, &raw) != 0) fail("pseudo-terminal");
    const fs::path beside = link_.string() + ".new";  // renamed, so that the link is there at every moment
    std::error_code error;
    fs::remove(beside, error);
    fs::create_symlink(name_, beside, error);
    if (!error) fs::rename(beside, link_, error);
    if (error) throw std::runtime_error("--pty " + link_.string() + ": " + error.message());
  }
  ~PseudoTerminal() override {
    std::error_code error;
    if (fs::read_symlink(link_, error) == name_) fs::remove(link_, error);
  }

  std::size_t read(std::uint8_t* bytes, std::size_t room) override {
    const ssize_t count = ::read(host_.get(), bytes, room);
    return count > 0 ? static_cast<std::size_t>(count) : 0;
  }
  void write(const std::uint8_t* bytes, std::size_t size) override {
    [[maybe_unused]] const ssize_t written = ::write(host_.get(), bytes, size);
  }

 private:
  int descriptor() const override { return host_.get(); }

  // It stays open, so that bytes of a host that comes later are neither lost nor an error.
  int open_device() {
    const char* const name =
        ::grantpt(host_.get()) == 0 && ::unlockpt(host_.get()) == 0 ? ::ptsname(host_.get()) : nullptr;
    if (name == nullptr) return -1;
    name_ = name;
    return ::open(name, O_RDWR | O_NOCTTY | O_CLOEXEC);
  }

  fs::path link_;
  std::string name_;
  io::Descriptor host_;
  io::Descriptor device_;
};

class UdpPort final : public Port {
 public:
  UdpPort(const std::string& address, const sockaddr_in& own)
      : socket_(open_or_fail(::socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0),
                             "--udp " + address)) {
    if (::bind(socket_.get(), reinterpret_cast<const sockaddr*>(&own), sizeof own) != 0)
      fail("--udp " + address);
  }

  std::size_t read(std::uint8_t* bytes, std::size_t room) override {
    sockaddr_in sender{};
    socklen_t length = sizeof sender;
    const ssize_t count =
        ::recvfrom(socket_.get(), bytes, room, 0, reinterpret_cast<sockaddr*>(&sender), &length);
    if (count <= 0) return 0;
    host_before_ = std::exchange(host_, sender);
    return static_cast<std::size_t>(count);
  }
  void write(const std::uint8_t* bytes, std::size_t size) override {
    ::sendto(socket_.get(), bytes, size, 0, reinterpret_cast<const sockaddr*>(&host_), sizeof host_);
  }
  void refuse_sender() override { host_ = host_before_; }

 private:
  int descriptor() const override { return socket_.get(); }

  io::Descriptor socket_;
  sockaddr_in host_{};
  sockaddr_in host_before_{};  // the last datagram
};

}  // namespace

bool Port::wait_until(std::int64_t until_ns) const {
  const std::int64_t wait_ns = std::max<std::int64_t>(until_ns - runtime::monotonic_ns(), 0);
  const timespec time{wait_ns / 1'000'000'000, wait_ns % 1'000'000'000};
  pollfd ready{descriptor(), POLLIN, 0};
  return ::ppoll(&ready, 1, &time, nullptr) > 0 && (ready.revents & POLLIN) != 0;
}

std::unique_ptr<Port> open_pseudo_terminal(const fs::path& link) {
  const fs::file_status status = fs::symlink_status(link);
  if (fs::exists(status) && !fs::is_symlink(status))
    throw std::invalid_argument("--pty: " + link.string() + " exists, must be a new name");
  return std::make_unique<PseudoTerminal>(link);
}

std::unique_ptr<Port> open_udp_port(const std::string& address) {
  const std::string fault = io::fault_of_host_address(address);
  if (!fault.empty()) throw std::invalid_argument("--udp: " + fault);
  const io::HostAddress parsed = io::parse_host_address(address);
  if (parsed.port == 0) throw std::invalid_argument("--udp: " + address + " has no port, must be HOST:PORT");
  const sockaddr_in own = io::socket_address(io::ipv4_addresses_of(parsed.host).front(), parsed.port);
  return std::make_unique<UdpPort>(address, own);
}

}  // namespace swiftlet::services
