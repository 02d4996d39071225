// Fuzzes the check of received datagrams. The first byte switches on security, discovery servers, and a network key.
#include <algorithm>
#include <vector>

#include "swiftlet/services/rtps/check.hpp"
#include "swiftlet/services/rtps/datagram_guard.hpp"
#include "tests/fuzz/refusal.hpp"

using namespace swiftlet;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  rtps::DatagramLimits limits;
  limits.security = (*data & 1U) != 0;
  limits.discovery_servers = (*data & 2U) != 0;
  const std::vector<std::uint8_t> datagram(data + 1, data + size);
  const rtps::CheckedDatagram checked = rtps::check_datagram(datagram.data(), datagram.size(), limits);
  static rtps::DatagramGuard open;
  static rtps::DatagramGuard served({}, [] {
    rtps::DatagramLimits of_client;
    of_client.discovery_servers = true;
    return of_client;
  }());
  static rtps::DatagramGuard with_key({io::NetworkKey{1}});
  rtps::DatagramGuard& guard = (*data & 4U) != 0 ? with_key : limits.discovery_servers ? served : open;
  guard.admit(datagram.data(), datagram.size(), {}, 7411, {1, 1});
  if (checked.fault != nullptr) return 0;
  tests::demand(checked.length <= datagram.size(), "the middleware gets no more than was received");
  std::vector<std::uint8_t> copy(datagram.begin(),
                                 datagram.begin() + static_cast<std::ptrdiff_t>(checked.length));
  for (const std::size_t at : checked.places.hidden)
    tests::demand(at + 4 <= copy.size(), "a hidden parameter is in the datagram");
  rtps::hide_parameters(checked, copy.data());
  if (copy.size() <= 20) return 0;  // it held nothing but what the middleware must not see
  const rtps::CheckedDatagram again = rtps::check_datagram(copy.data(), copy.size(), limits);
  tests::demand(again.fault == nullptr && again.places.hidden.empty(), "what the middleware gets is valid");
  return 0;
}
