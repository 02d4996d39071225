#include "swiftlet/services/rtps/datagram_seal.hpp"

#include <algorithm>
#include <chrono>
#include <functional>
#include <sodium.h>
#include <string_view>

#include "swiftlet/io/byte_writer.hpp"
#include "swiftlet/services/rtps/key_rules.hpp"
#include "swiftlet/services/rtps/submessage.hpp"

namespace swiftlet::rtps {
namespace {

using io::NetworkKey;

// The trailer, little endian: submessage header, key id, time of sending, count, tag over all bytes before it, zeros.
constexpr std::uint16_t kSealLength = kSealBytes - 4;  // as the header states it
constexpr std::size_t kTimeAt = 8;
constexpr std::size_t kCountAt = 16;
constexpr std::size_t kTagAt = 24;
constexpr std::size_t kTagBytes = 16;
constexpr std::size_t kPrefixAt = 8;                      // in the datagram
constexpr std::int64_t kCopiesArrive_ns = 1'000'000'000;  // within

template <class Number>
Number get(const std::uint8_t* from) {
  return io::ByteReader(from, sizeof(Number), true).number<Number>();
}

// Names a key without telling it.
std::uint32_t id_of(const NetworkKey& key) {
  std::array<std::uint8_t, crypto_generichash_BYTES_MIN> digest{};
  static constexpr char kContext[] = "swiftlet network key id";
  crypto_generichash(digest.data(), digest.size(), reinterpret_cast<const std::uint8_t*>(kContext),
                     sizeof kContext, key.data(), key.size());
  return get<std::uint32_t>(digest.data());
}

// Keyed BLAKE2b.
void tag_of(const NetworkKey& key, const std::uint8_t* data, std::size_t size, std::uint8_t* tag) {
  crypto_generichash(tag, kTagBytes, data, size, key.data(), key.size());
}

std::int64_t since_1970_ns() {
  return std::chrono::system_clock::now().time_since_epoch() / std::chrono::nanoseconds(1);
}

}  // namespace

// The count begins with the time, so that it also grows when a participant joins again with the same prefix.
DatagramSealer::DatagramSealer(const io::NetworkKeys& keys)
    : key_(keys.front()), key_id_(id_of(key_)), count_(static_cast<std::uint64_t>(since_1970_ns())) {}

void DatagramSealer::seal(std::vector<std::uint8_t>& datagram, std::int64_t now_ns) {
  const std::size_t at = datagram.size();
  datagram.resize(at + kSealBytes);
  std::uint8_t* const trailer = datagram.data() + at;
  std::fill_n(trailer, kSealBytes, std::uint8_t{0});
  trailer[0] = kSeal;
  trailer[1] = 1;  // little endian
  io::store(kSealLength, trailer + 2);
  io::store(key_id_, trailer + 4);
  io::store(now_ns, trailer + kTimeAt);
  io::store(++count_, trailer + kCountAt);
  tag_of(key_, datagram.data(), at + kTagAt, trailer + kTagAt);
}

DatagramOpener::DatagramOpener(const io::NetworkKeys& keys) : senders_(kSenders) {
  for (const NetworkKey& key : keys) keys_.push_back({key, id_of(key)});
}

const char* DatagramOpener::verify(const std::uint8_t* data, std::size_t size, std::int64_t now_ns) const {
  if (size < kPrefixAt + GuidPrefix().size() + kSealBytes) return kNotSealed;
  const std::uint8_t* const trailer = data + size - kSealBytes;
  if (trailer[0] != kSeal || get<std::uint16_t>(trailer + 2) != kSealLength) return kNotSealed;
  const auto id = get<std::uint32_t>(trailer + 4);
  const auto key = std::find_if(keys_.begin(), keys_.end(), [&](const Key& known) { return known.id == id; });
  if (key == keys_.end()) return kOtherKey;
  std::array<std::uint8_t, kTagBytes> tag{};
  tag_of(key->secret, data, size - kSealBytes + kTagAt, tag.data());
  if (sodium_memcmp(tag.data(), trailer + kTagAt, kTagBytes) != 0) return "changed after it was sealed";
  const auto sent_ns = get<std::int64_t>(trailer + kTimeAt);
  if (sent_ns < now_ns - kSealTolerance_ns || sent_ns > now_ns + kSealTolerance_ns) return kOtherTime;
  return nullptr;
}

const char* DatagramOpener::take(const std::uint8_t* data, std::size_t size, std::uint32_t port,
                                 std::int64_t steady_ns) {
  const std::uint8_t* const trailer = data + size - kSealBytes;
  Sender& from = sender(data + kPrefixAt, port);
  from.heard_ns = steady_ns;
  return from.take(get<std::uint64_t>(trailer + kCountAt), get<std::int64_t>(trailer + kTimeAt));
}

DatagramOpener::Sender& DatagramOpener::sender(const std::uint8_t* participant, std::uint32_t port) {
  GuidPrefix prefix{};
  std::copy_n(participant, prefix.size(), prefix.begin());
  const std::size_t first =
      std::hash<std::string_view>()({reinterpret_cast<const char*>(participant), prefix.size()}) + port;
  Sender* longest_silent = nullptr;
  for (std::size_t i = 0; i < kPlaces; ++i) {
    Sender& known = senders_[(first + i) & (kSenders - 1)];
    if (known.port == port && known.participant == prefix) return known;
    if (longest_silent == nullptr || known.heard_ns < longest_silent->heard_ns) longest_silent = &known;
  }
  *longest_silent = {};
  longest_silent->participant = prefix;
  longest_silent->port = port;
  return *longest_silent;
}

const char* DatagramOpener::Sender::take(std::uint64_t count, std::int64_t sealed_ns) {
  const auto bit = [](std::uint64_t of) { return std::uint64_t{1} << of % 64; };
  const auto word = [this](std::uint64_t of) -> std::uint64_t& {
    return received[of / 64 % received.size()];
  };
  if (count + kSealWindow <= newest) return "older than 2048 others of its sender";
  if (count > newest) {
    // Counts between the newest and this one were not received.
    const std::uint64_t skipped = std::min(count - newest, kSealWindow);
    for (std::uint64_t i = 0; i < skipped; ++i) word(count - i) &= ~bit(count - i);
    newest = count;
    sent_ns = sealed_ns;
  } else if ((word(count) & bit(count)) != 0) {
    return sealed_ns > sent_ns - kCopiesArrive_ns ? kSentTwice : "received before";
  }
  word(count) |= bit(count);
  return nullptr;
}

}  // namespace swiftlet::rtps
