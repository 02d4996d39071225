#include "swiftlet/services/rtps/datagram_guard.hpp"

#include <algorithm>
#include <chrono>
#include <mutex>
#include <string_view>
#include <utility>

#include "swiftlet/services/rtps/announcement.hpp"

namespace swiftlet::rtps {
namespace {

constexpr std::int64_t kExpected_ns = 20'000'000'000;

}  // namespace

Now Now::read() {
  return {std::chrono::steady_clock::now().time_since_epoch() / std::chrono::nanoseconds(1),
          std::chrono::system_clock::now().time_since_epoch() / std::chrono::nanoseconds(1)};
}

DatagramGuard::DatagramGuard(const io::NetworkKeys& keys, const DatagramLimits& limits)
    : limits_(limits), replies_(limits.discovery_servers ? kLongestBuiltinGap : kGapsAhead) {
  if (keys.empty()) return;
  sealer_.emplace(keys);
  opener_.emplace(keys);
}

DatagramGuard::DatagramGuard(const std::string& key_file, bool discovery_servers, bool security)
    : DatagramGuard(key_file.empty() ? io::NetworkKeys() : io::read_network_keys(key_file),
                    DatagramLimits{security, discovery_servers}) {}

CheckedDatagram DatagramGuard::admit(const std::uint8_t* data, std::size_t size, Ipv4 sender,
                                     std::uint32_t port, const Now& now) {
  CheckedDatagram checked;
  if (opener_) {
    checked.fault = opener_->verify(data, size, now.since_1970_ns);
    if (checked.fault == nullptr) {
      const std::lock_guard<std::mutex> lock(mutex_);
      checked.fault = opener_->take(data, size, port, now.steady_ns);
    }
    if (checked.fault == kSentTwice) return checked;
  }
  if (checked.fault == nullptr) checked = check_datagram(data, opener_ ? size - kSealBytes : size, limits_);
  if (checked.fault == nullptr && !opener_) {
    const std::lock_guard<std::mutex> lock(mutex_);
    checked.fault = replies_.fault_of(checked);
  }
  if (checked.fault != nullptr) {
    refuse(sender, checked.fault);
    return checked;
  }
  if (checked.announces_itself) checked.is_ignored = ignores(checked, sender, now);
  return checked;
}

bool DatagramGuard::takes_turns(const CheckedDatagram& checked) const {
  const bool meets_peer = checked.announces_itself || checked.handshake;
  return is_discovery_server(checked.source) || (limits_.security && meets_peer);
}

bool DatagramGuard::ignores(const CheckedDatagram& checked, Ipv4 sender, const Now& now) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const Announced& said = checked.announced;
  moved_hosts_.heard(said, sender, now.steady_ns);
  return !participants_.announced(checked.source, said, concerns_us(said), now.steady_ns);
}

bool DatagramGuard::concerns_us(const Announced& said) const {
  if (own_user_data_.empty() || said.user_data == nullptr) return true;
  return !are_apart(own_user_data_, {reinterpret_cast<const char*>(said.user_data), said.user_data_size});
}

void DatagramGuard::ignore_apart_from(const std::vector<std::uint8_t>& own_user_data) {
  const std::lock_guard<std::mutex> lock(mutex_);
  own_user_data_.assign(own_user_data.begin(), own_user_data.end());
}

std::string DatagramGuard::name_of(const GuidPrefix& participant) {
  const std::lock_guard<std::mutex> lock(mutex_);
  return participants_.name_of(participant);
}

void DatagramGuard::set_participant(const GuidPrefix& own) {
  const std::lock_guard<std::mutex> lock(mutex_);
  replies_.set_participant(own);
}

std::size_t DatagramGuard::participants_heard(const Now& now) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const std::size_t heard = participants_.heard_lately(now.steady_ns);
  return now.steady_ns < expected_until_ns_ ? std::max(heard, expected_) : heard;
}

void DatagramGuard::expect_participants(std::size_t count, const Now& now) {
  const std::lock_guard<std::mutex> lock(mutex_);
  expected_ = count;
  expected_until_ns_ = now.steady_ns + kExpected_ns;
}

std::vector<Joined> DatagramGuard::participants_joined(const Now& now) {
  const std::lock_guard<std::mutex> lock(mutex_);
  return participants_.joined(now.steady_ns);
}

Ipv4 DatagramGuard::now_at(Ipv4 announced) {
  const std::lock_guard<std::mutex> lock(mutex_);
  return moved_hosts_.now_at(announced);
}

MovedHosts::News DatagramGuard::take_moves() {
  const std::lock_guard<std::mutex> lock(mutex_);
  return moved_hosts_.take_news();
}

void DatagramGuard::set_own_interfaces(const std::vector<io::Interface>& own) {
  std::vector<Ipv4> addresses;
  for (const io::Interface& it : own) addresses.push_back(it.ipv4);
  const std::lock_guard<std::mutex> lock(mutex_);
  moved_hosts_.set_own(std::move(addresses));
}

void DatagramGuard::note_sent(const std::uint8_t* data, std::size_t size) {
  if (!ReplyCheck::concerns_replies(data, size)) return;
  const std::lock_guard<std::mutex> lock(mutex_);
  replies_.note_sent(data, size);
}

void DatagramGuard::seal(std::vector<std::uint8_t>& datagram, const Now& now) {
  remove_statistics(datagram);
  sealer_->seal(datagram, now.since_1970_ns);
}

}  // namespace swiftlet::rtps
