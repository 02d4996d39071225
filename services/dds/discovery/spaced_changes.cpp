#include "swiftlet/services/dds/discovery/spaced_changes.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "swiftlet/io/byte_reader.hpp"
#include "swiftlet/services/dds/datagram/heard_participants.hpp"
#include "swiftlet/services/dds/datagram/submessage.hpp"

namespace swiftlet::comms {

using runtime::ByteReader;

namespace {

constexpr std::size_t kBytesBeforePrefix = 8;  // of a message

// The sequence number of a submessage that announces a participant or says goodbye; nullopt for others.
std::optional<std::int64_t> changed(std::uint8_t kind, ByteReader body) {
  if (kind != kData) return std::nullopt;
  body.skip(kBytesBeforeIds);
  const EntityId reader = entity_id(body);
  const EntityId writer = entity_id(body);
  const auto high = static_cast<std::uint64_t>(body.u32());
  const std::uint64_t low = body.u32();
  if (!body.ok() || topic_of(reader, writer) != BuiltinTopic::kParticipant) return std::nullopt;
  return static_cast<std::int64_t>(high << 32U | low);
}

// What it says holds for the submessages that follow it.
bool is_info(std::uint8_t kind) {
  return kind == kInfoTimestamp || kind == kInfoSource || kind == kInfoDestination;
}

}  // namespace

std::optional<ParticipantChange> participant_change(const std::uint8_t* message, std::size_t size) {
  std::optional<ParticipantChange> change;
  const bool whole = for_each_submessage(message, size, [&](std::uint8_t kind, ByteReader body) {
    const auto number = changed(kind, body);
    if (!number) return;
    change.emplace();
    std::copy_n(message + kBytesBeforePrefix, change->participant.size(), change->participant.begin());
    change->sequence_number = *number;
  });
  return whole ? change : std::nullopt;
}

std::vector<std::vector<std::uint8_t>> divide_changes(const std::uint8_t* message, std::size_t size) {
  std::vector<std::uint8_t> begin(message, message + std::min(size, kHeaderBytes));
  std::vector<std::vector<std::uint8_t>> messages{begin};
  bool has_change = false;
  for_each_submessage(message, size, [&](std::uint8_t kind, ByteReader body) {
    const std::uint8_t* const submessage = body.data() - kSubmessageHeaderBytes;
    const std::uint8_t* const end = body.data() + body.rest();
    const bool is_change = changed(kind, body).has_value();
    if (is_change && has_change) messages.push_back(begin);
    has_change = has_change || is_change;
    messages.back().insert(messages.back().end(), submessage, end);
    if (is_info(kind)) begin.insert(begin.end(), submessage, end);
  });
  return messages;
}

bool ChangeSpacing::admit(const ParticipantChange& change, Time now) {
  for (auto it = last_.begin(); it != last_.end();)
    it = it->second.time + kChangeSpacing <= now ? last_.erase(it) : std::next(it);
  const auto known = last_.find(change.participant);
  if (known != last_.end()) return known->second.sequence_number == change.sequence_number;
  if (last_.size() >= kMostParticipants) return false;
  last_[change.participant] = {change.sequence_number, now};
  return true;
}

void EarlyChanges::keep(Datagram datagram) {
  const ParticipantChange& change = datagram.change;
  const auto of_participant = std::count_if(kept_.begin(), kept_.end(), [&](const auto& kept) {
    return kept.second.change.participant == change.participant;
  });
  if (kept_.size() >= kMost || static_cast<std::size_t>(of_participant) >= kMostOfParticipant) return;
  const std::pair key(change.participant, change.sequence_number);
  kept_.try_emplace(key, std::move(datagram));
}

std::optional<EarlyChanges::Datagram> EarlyChanges::take(const void* receiver, ChangeSpacing& spacing,
                                                         ChangeSpacing::Time now) {
  const auto due = std::find_if(kept_.begin(), kept_.end(), [&](const auto& kept) {
    return kept.second.receiver == receiver && spacing.admit(kept.second.change, now);
  });
  if (due == kept_.end()) return std::nullopt;
  Datagram datagram = std::move(due->second);
  kept_.erase(due);
  return datagram;
}

namespace {

namespace transport = eprosima::fastdds::rtps;

class SpacingTransport final : public ChainedTransport {
 public:
  SpacingTransport(const transport::ChainingTransportDescriptor& descriptor,
                   std::shared_ptr<const std::atomic<bool>> open)
      : ChainedTransport(descriptor), open_(std::move(open)) {}

  // The transport below recognizes the channels that it opened before only if they are not wrapped.
  bool OpenOutputChannel(transport::SendResourceList& channels, const rtps::Locator_t& locator) override {
    return low_level_transport_->OpenOutputChannel(channels, locator);
  }

  void receive(transport::TransportReceiverInterface* next, const rtps::octet* data, std::uint32_t size,
               const rtps::Locator_t& local, const rtps::Locator_t& remote) override {
    if (!*open_) return;
    while (const auto early = take_early(next)) {
      const std::vector<rtps::octet>& bytes = early->bytes;
      next->OnDataReceived(bytes.data(), static_cast<std::uint32_t>(bytes.size()), local, early->sender);
    }
    if (!participant_change(data, size)) return next->OnDataReceived(data, size, local, remote);
    for (auto& message : divide_changes(data, size)) {
      const auto change = participant_change(message.data(), message.size());
      if (change && !admit_or_keep(*change, next, message, remote)) continue;
      next->OnDataReceived(message.data(), static_cast<std::uint32_t>(message.size()), local, remote);
    }
  }

 private:
  std::optional<EarlyChanges::Datagram> take_early(const void* receiver) {
    const std::lock_guard<std::mutex> lock(mutex_);
    return early_.take(receiver, spacing_, std::chrono::steady_clock::now());
  }
  bool admit_or_keep(const ParticipantChange& change, const void* receiver,
                     std::vector<std::uint8_t>& message, const rtps::Locator_t& sender) {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (spacing_.admit(change, std::chrono::steady_clock::now())) return true;
    early_.keep({change, std::move(message), receiver, sender});
    return false;
  }

  const std::shared_ptr<const std::atomic<bool>> open_;
  std::mutex mutex_;  // guards the rest
  ChangeSpacing spacing_;
  EarlyChanges early_;
};

struct SpacingDescriptor final : transport::ChainingTransportDescriptor {
  SpacingDescriptor(std::shared_ptr<transport::TransportDescriptorInterface> below,
                    std::shared_ptr<const std::atomic<bool>> opened)
      : ChainingTransportDescriptor(std::move(below)), open(std::move(opened)) {}
  transport::TransportInterface* create_transport() const override {
    return new SpacingTransport(*this, open);
  }

  std::shared_ptr<const std::atomic<bool>> open;
};

}  // namespace

std::shared_ptr<transport::TransportDescriptorInterface> space_changes(
    std::shared_ptr<transport::TransportDescriptorInterface> below,
    std::shared_ptr<const std::atomic<bool>> open) {
  return std::make_shared<SpacingDescriptor>(std::move(below), std::move(open));
}

}  // namespace swiftlet::comms
