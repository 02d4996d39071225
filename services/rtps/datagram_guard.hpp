// Decides which received datagrams the middleware of a participant may parse.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "swiftlet/io/network/interfaces.hpp"
#include "swiftlet/services/rtps/check.hpp"
#include "swiftlet/services/rtps/datagram_seal.hpp"
#include "swiftlet/services/rtps/heard_participants.hpp"
#include "swiftlet/services/rtps/moved_hosts.hpp"
#include "swiftlet/services/rtps/refusal_log.hpp"
#include "swiftlet/services/rtps/reply_check.hpp"

namespace swiftlet::rtps {

struct Now {
  std::int64_t steady_ns = 0;      // of a monotonic clock
  std::int64_t since_1970_ns = 0;  // of the clock that hosts share

  static Now read();
};

// Thread-safe: shared by the transport of a participant and its receiving threads. Allocates only when constructed, and
// for fragments that are sent.
class DatagramGuard {
 public:
  // keys: of the network; empty: datagrams are not sealed.
  explicit DatagramGuard(const io::NetworkKeys& keys = {}, const DatagramLimits& limits = {});
  // key_file: with the keys; empty: none. Throws io::ConfigError for a bad one.
  DatagramGuard(const std::string& key_file, bool discovery_servers, bool security);

  // Counts a refusal; the result then has a fault. port: the local one.
  CheckedDatagram admit(const std::uint8_t* data, std::size_t size, Ipv4 sender, std::uint32_t port,
                        const Now& now);
  // Until then, the transport drops what it receives, and a participant does not announce itself. By default it listens.
  void listen(bool listens) { listens_ = listens; }
  bool listens() const { return listens_; }
  // The first port at which its participant receives discovery; 0: none yet.
  void set_discovery_port(std::uint32_t port) { discovery_port_ = port; }
  std::uint32_t discovery_port() const { return discovery_port_; }
  void refuse(Ipv4 sender, const char* rule) { refusals_.note(sender, rule); }

  // own: of the participant that receives; all zeros: not known yet (reply_check.hpp).
  void set_participant(const GuidPrefix& own);

  // Has announcements ignored that are_apart() from this one, its user data, unless their participant has joined before.
  void ignore_apart_from(const std::vector<std::uint8_t>& own_user_data);

  // There are so many participants at least: until all of them have been heard, participants_heard() returns no less.
  void expect_participants(std::size_t count, const Now& now);

  // Participants that have announced themselves to this one within the last seconds, and those of them that are not ignored.
  std::size_t participants_heard(const Now& now);
  std::vector<Joined> participants_joined(const Now& now);

  // The name that a participant says itself.
  std::string name_of(const GuidPrefix& participant);

  bool seals() const { return sealer_.has_value(); }
  // Turns a datagram of the middleware into a sealed one. Requires seals().
  void seal(std::vector<std::uint8_t>& datagram, const Now& now);

  // Notes what the replies to a datagram have to agree with. Not needed with keys: who has one is trusted. data: as the middleware sends it, or its beginning.
  void note_sent(const std::uint8_t* data, std::size_t size);

  RefusalLog& refusals() { return refusals_; }

  // The addresses at which other hosts are reached now.
  bool has_moved_hosts() const { return moved_hosts_.any(); }
  Ipv4 now_at(Ipv4 announced);
  MovedHosts::News take_moves();
  // own: the interfaces of this host that have an address.
  void set_own_interfaces(const std::vector<io::Interface>& own);

  // Whether the middleware must take in a datagram while it does no other of these things: the thread then holds turn_mutex(), as
  // the one does that announces a change.
  // From a discovery server: Fast DDS takes two locks in one order then (PDPClient::assignRemoteEndpoints), and in the other one
  // to announce a change (RTPSParticipantImpl::update_attributes), and both threads would wait for each other.
  // Who announces himself, or authenticates, with security: SecurityManager of Fast DDS 2.9 describes the peer in a member that
  // all threads share (match_builtin_endpoints, mended by #3362). Of two peers discovered together, one is never answered.
  bool takes_turns(const CheckedDatagram& checked) const;
  std::mutex& turn_mutex() { return turn_mutex_; }

 private:
  // Notes an announcement. Returns whether this process ignores the participant.
  bool ignores(const CheckedDatagram& checked, Ipv4 sender, const Now& now);
  bool concerns_us(const Announced& said) const;

  const DatagramLimits limits_;
  std::optional<DatagramSealer> sealer_;
  RefusalLog refusals_;
  std::atomic<bool> listens_{true};
  std::atomic<std::uint32_t> discovery_port_{0};
  std::mutex turn_mutex_;
  std::mutex mutex_;  // guards what follows; all threads that receive take it, for each datagram
  std::optional<DatagramOpener> opener_;
  ReplyCheck replies_;
  MovedHosts moved_hosts_;
  HeardParticipants participants_;
  std::string own_user_data_;  // empty: nobody is ignored
  std::size_t expected_ = 0;
  std::int64_t expected_until_ns_ = 0;
};

}  // namespace swiftlet::rtps
