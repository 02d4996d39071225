#include "swiftlet/services/plant/byte_stream.hpp"

#include <cerrno>
#include <sys/socket.h>
#include <unistd.h>

namespace swiftlet::services {
namespace {

bool is_temporary(int error) { return error == EAGAIN || error == EWOULDBLOCK || error == EINTR; }

}  // namespace

bool ByteStream::send(const std::uint8_t* bytes, std::size_t size) {
  if (!rest_.empty()) {
    const std::size_t written = write(rest_.data(), rest_.size());
    rest_.erase(rest_.begin(), rest_.begin() + static_cast<std::ptrdiff_t>(written));
    if (!rest_.empty()) return false;
  }
  const std::size_t written = write(bytes, size);
  if (written == 0) return false;
  rest_.assign(bytes + written, bytes + size);
  return true;
}

std::size_t ByteStream::write(const std::uint8_t* bytes, std::size_t size) {
  if (closed_) return 0;
  ssize_t written = ::send(descriptor(), bytes, size, MSG_NOSIGNAL);
  if (written < 0 && errno == ENOTSOCK) written = ::write(descriptor(), bytes, size);
  if (written >= 0) return static_cast<std::size_t>(written);
  closed_ = !is_temporary(errno);
  return 0;
}

std::size_t ByteStream::receive(std::uint8_t* bytes, std::size_t size) {
  if (closed_) return 0;
  const ssize_t received = ::read(descriptor(), bytes, size);
  if (received > 0) return static_cast<std::size_t>(received);
  closed_ = received == 0 || !is_temporary(errno);
  return 0;
}

}  // namespace swiftlet::services
