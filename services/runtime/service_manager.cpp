#include "swiftlet/services/runtime/service_manager.hpp"

#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <sys/socket.h>
#include <sys/un.h>

#include "swiftlet/io/descriptor.hpp"

namespace swiftlet::runtime {

void notify_service_manager(std::string_view line) noexcept {
  const char* const path = std::getenv("NOTIFY_SOCKET");
  if (path == nullptr || (path[0] != '/' && path[0] != '@')) return;
  const std::size_t length = std::strlen(path);
  sockaddr_un address{};
  if (length >= sizeof address.sun_path) return;
  address.sun_family = AF_UNIX;
  std::memcpy(address.sun_path, path, length);
  if (path[0] == '@') address.sun_path[0] = 0;  // a name that is no file
  const io::Descriptor socket(::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  ::sendto(socket.get(), line.data(), line.size(), MSG_NOSIGNAL, reinterpret_cast<const sockaddr*>(&address),
           static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + length));
}

void Watchdog::feed() noexcept {
  const std::int64_t now_ns = monotonic_ns();
  if (now_ns < due_ns_) return;
  due_ns_ = now_ns + kPeriodNs;
  notify_service_manager("WATCHDOG=1");
}

}  // namespace swiftlet::runtime
