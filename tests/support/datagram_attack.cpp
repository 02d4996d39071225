#include "tests/support/datagram_attack.hpp"

#include <algorithm>
#include <arpa/inet.h>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <linux/if_ether.h>
#include <net/if.h>
#include <netinet/in.h>
#include <netpacket/packet.h>
#include <set>
#include <stdexcept>
#include <sys/socket.h>
#include <unistd.h>
#include <utility>

#include "swiftlet/io/network/sockets.hpp"

namespace swiftlet::tests {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kFirstKept = 400;
constexpr std::size_t kMostKept = 4000;
constexpr std::size_t kUdpHeaderBytes = 8;
constexpr std::size_t kRtpsHeaderBytes = 20;
constexpr std::size_t kLongest = 65'000;

std::runtime_error system_error(const char* what) {
  return std::runtime_error(std::string(what) + ": " + std::strerror(errno));
}

}  // namespace

DatagramCapture::DatagramCapture()
    : socket_(::socket(AF_PACKET, SOCK_DGRAM | SOCK_CLOEXEC, htons(ETH_P_IP))) {
  if (socket_ < 0) throw system_error("cannot capture datagrams");
  sockaddr_ll loopback{};
  loopback.sll_family = AF_PACKET;
  loopback.sll_protocol = htons(ETH_P_IP);
  loopback.sll_ifindex = static_cast<int>(::if_nametoindex("lo"));
  const timeval period{0, 50'000};
  if (::bind(socket_, reinterpret_cast<const sockaddr*>(&loopback), sizeof loopback) != 0 ||
      ::setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &period, sizeof period) != 0) {
    ::close(socket_);
    throw system_error("cannot capture datagrams of the loopback interface");
  }
  thread_ = std::thread([this] { run(); });
}

DatagramCapture::~DatagramCapture() {
  stop_ = true;
  thread_.join();
  ::close(socket_);
}

std::vector<CapturedDatagram> DatagramCapture::datagrams() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return kept_;
}

void DatagramCapture::run() {
  std::vector<std::uint8_t> packet(1 << 16);
  while (!stop_) {
    const ssize_t size = ::recv(socket_, packet.data(), packet.size(), 0);
    if (size > 0) keep(packet.data(), static_cast<std::size_t>(size));
  }
}

void DatagramCapture::keep(const std::uint8_t* packet, std::size_t size) {
  const std::size_t ip_header = std::size_t{4} * (packet[0] & 0x0fU);
  const std::size_t before = ip_header + kUdpHeaderBytes;
  if (size < before + kRtpsHeaderBytes || packet[9] != IPPROTO_UDP ||
      std::memcmp(packet + before, "RTPS", 4) != 0)
    return;
  CapturedDatagram datagram;
  datagram.port = static_cast<std::uint16_t>(packet[ip_header + 2] << 8U | packet[ip_header + 3]);
  datagram.bytes.assign(packet + before, packet + size);
  const std::lock_guard<std::mutex> lock(mutex_);
  ++seen_;
  if (kept_.size() < kMostKept) {
    kept_.push_back(std::move(datagram));
  } else if (random_() % seen_ < kMostKept - kFirstKept) {
    kept_[kFirstKept + random_() % (kMostKept - kFirstKept)] = std::move(datagram);
  }
}

DatagramMutator::DatagramMutator(std::vector<CapturedDatagram> datagrams, std::uint64_t seed, bool forges)
    : datagrams_(std::move(datagrams)), random_(seed), forges_(forges) {
  if (datagrams_.empty()) throw std::runtime_error("no datagram was captured");
  std::set<std::uint16_t> ports;
  for (const CapturedDatagram& datagram : datagrams_) ports.insert(datagram.port);
  ports_.assign(ports.begin(), ports.end());
}

std::size_t DatagramMutator::below(std::size_t end) { return end == 0 ? 0 : random_() % end; }

CapturedDatagram DatagramMutator::next() {
  CapturedDatagram datagram = datagrams_[below(datagrams_.size())];
  Bytes& bytes = datagram.bytes;
  if (forges_ && below(4) == 0) {
    bytes = forgery(bytes);
    return datagram;
  }
  for (std::size_t changes = 1 + below(2); changes > 0; --changes) {
    switch (below(9)) {
      case 0:
        flip_bits(bytes);
        break;
      case 1:
        bytes.resize(below(bytes.size() + 1));
        break;
      case 2:
        insert(bytes);
        break;
      case 3:
        splice(bytes);
        break;
      case 4:
        set_length(bytes);
        break;
      case 5:
        set_number(bytes);
        break;
      case 6:
        datagram.port = ports_[below(ports_.size())];
        break;
      case 7:
        set_source(bytes);
        break;
      default:
        bytes = known_killer(bytes);
        break;
    }
  }
  if (bytes.size() > kLongest) bytes.resize(kLongest);
  return datagram;
}

void DatagramMutator::flip_bits(Bytes& bytes) {
  for (std::size_t flips = 1 + below(8); flips > 0 && !bytes.empty(); --flips)
    bytes[below(bytes.size())] ^= static_cast<std::uint8_t>(1U << below(8));
}

void DatagramMutator::insert(Bytes& bytes) {
  Bytes more(4 * (1 + below(8)));
  for (std::uint8_t& byte : more) byte = static_cast<std::uint8_t>(random_());
  bytes.insert(bytes.begin() + static_cast<std::ptrdiff_t>(below(bytes.size() + 1)), more.begin(),
               more.end());
}

void DatagramMutator::splice(Bytes& bytes) {
  const Bytes& other = datagrams_[below(datagrams_.size())].bytes;
  bytes.resize(below(bytes.size() + 1));
  bytes.insert(bytes.end(), other.begin() + static_cast<std::ptrdiff_t>(below(other.size())), other.end());
}

// Sets the length of the first, second ... submessage.
void DatagramMutator::set_length(Bytes& bytes) {
  std::size_t at = kRtpsHeaderBytes;
  for (std::size_t skip = below(4); skip > 0 && at + 4 <= bytes.size(); --skip)
    at += 4U + bytes[at + 2] + 256U * bytes[at + 3];
  if (at + 4 > bytes.size()) return;
  bytes[at + 2] = static_cast<std::uint8_t>(random_());
  bytes[at + 3] = static_cast<std::uint8_t>(below(2) == 0 ? 0 : random_());
}

void DatagramMutator::set_number(Bytes& bytes) {
  constexpr std::array<std::uint32_t, 8> kExtremes{0,          1,          0x7fffffff, 0x80000000,
                                                   0xffffffff, 0x00010000, 0x10000000, 0xfffffffe};
  if (bytes.size() < kRtpsHeaderBytes + 4) return;
  const std::size_t at = kRtpsHeaderBytes + 4 * below((bytes.size() - kRtpsHeaderBytes) / 4);
  const std::uint32_t number = kExtremes[below(kExtremes.size())];
  for (std::size_t i = 0; i < 4; ++i) bytes[at + i] = static_cast<std::uint8_t>(number >> (8 * i));
}

// Everywhere in the datagram, so that it is consistent.
void DatagramMutator::set_source(Bytes& bytes) {
  if (bytes.size() < kRtpsHeaderBytes) return;
  const Bytes old(bytes.begin() + 8, bytes.begin() + 20);
  Bytes forged(old);
  for (std::size_t i = 4; i < forged.size(); ++i) forged[i] = static_cast<std::uint8_t>(random_());
  for (auto at = bytes.begin(); (at = std::search(at, bytes.end(), old.begin(), old.end())) != bytes.end();)
    at = std::copy(forged.begin(), forged.end(), at);
}

Bytes DatagramMutator::known_killer(const Bytes& from) {
  rtps::GuidPrefix source = kAlice;
  if (from.size() >= kRtpsHeaderBytes) std::copy_n(from.begin() + 8, source.size(), source.begin());
  const ByteWriter sedp = ByteWriter().bytes(kSedpReader).bytes(kSedpWriter);
  RtpsMessage message(source);
  switch (below(8)) {
    case 0:
      message.add(0x80, 0, ByteWriter().zeros(56)).add(0x01, 0, ByteWriter().zeros(4));
      break;
    case 1:
      message.add(0x07, 0, ByteWriter(sedp).number(0, 1).number(0x7fffffff, 0xffffffff).u32(1U << 30U));
      break;
    case 2:
      message.add(0x08, 0, ByteWriter(sedp).number(0, 3).number(0, 5'000'003).u32(0));
      break;
    case 3:
      message.add(0x08, 0, ByteWriter(sedp).number(0, 1).number(1, 0).u32(0));
      break;
    case 4:
      message.add(0x16, 2, fragment_fields(1, 1, 1024, 300'000'000).sentinel().zeros(1024));
      break;
    case 5:
      message.add(0x16, 0, fragment_fields(1, 1, 2, 3000).zeros(64));
      break;
    case 6:
      message.add(0x15, 4, data_fields(kUserReader, kUserWriter, 1, 4000).u32(0));
      break;
    default: {
      ByteWriter body = data_fields(kSpdpReader, kSpdpWriter, 1);
      body.u16(0x0300).u16(0).parameter(0x1001, ByteWriter().string("token").u32(5'000'000)).sentinel();
      message.add(0x15, 4, body);
    }
  }
  return message.bytes();
}

// A goodbye, or numbers that a writer or reader has not reached.
Bytes DatagramMutator::forgery(const Bytes& from) {
  rtps::GuidPrefix source = kAlice;
  if (from.size() >= kRtpsHeaderBytes) std::copy_n(from.begin() + 8, source.size(), source.begin());
  RtpsMessage message(source);
  const rtps::EntityId writer{0, 0, static_cast<std::uint8_t>(1 + below(30)), 0x03};
  const auto next =
      static_cast<std::uint32_t>(2 + below(4));  // plausible: the first announcement has number 1
  const auto ahead = static_cast<std::uint32_t>(next + below(2) * below(1'000'000));
  switch (below(3)) {
    case 0: {
      ByteWriter body = data_fields(kSpdpReader, kSpdpWriter, next);
      body.parameter(0x0070, guid(source, rtps::kParticipantEntity))
          .parameter(0x0071, ByteWriter().u32(0x03000000))
          .sentinel();
      message.add(0x15, 2, body);
      break;
    }
    case 1:
      message.add(0x07, 0,
                  ByteWriter()
                      .bytes(rtps::kUnknownEntity)
                      .bytes(writer)
                      .number(0, ahead)
                      .number(0, ahead)
                      .u32(ahead));
      break;
    default:
      message.add(0x06, 0, ByteWriter().bytes(kUserReader).bytes(writer).number(0, ahead).u32(0).u32(ahead));
  }
  return message.bytes();
}

DatagramAttack::DatagramAttack(DatagramMutator mutator, int per_second)
    : mutator_(std::move(mutator)),
      socket_(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)),
      thread_([this, per_second] { run(per_second); }) {}

DatagramAttack::~DatagramAttack() {
  stop_ = true;
  thread_.join();
  ::close(socket_);
}

void DatagramAttack::send(const CapturedDatagram& datagram) const {
  const sockaddr_in to = io::socket_address("127.0.0.1", datagram.port);
  ::sendto(socket_, datagram.bytes.data(), datagram.bytes.size(), MSG_DONTWAIT,
           reinterpret_cast<const sockaddr*>(&to), sizeof to);
}

void DatagramAttack::run(int per_second) {
  constexpr std::chrono::milliseconds kPeriod{2};
  auto next = Clock::now();
  const int batch = std::max(1, per_second * static_cast<int>(kPeriod.count()) / 1000);
  while (!stop_) {
    for (int i = 0; i < batch; ++i) send(mutator_.next());
    sent_ += static_cast<std::uint64_t>(batch);
    next = std::max(next + kPeriod, Clock::now());
    std::this_thread::sleep_until(next);
  }
}

}  // namespace swiftlet::tests
