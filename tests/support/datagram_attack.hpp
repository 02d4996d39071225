// Attacks participants of a flight with changed copies of their own datagrams.
#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "tests/support/rtps_message.hpp"

namespace swiftlet::tests {

struct CapturedDatagram {
  std::uint16_t port = 0;  // to which it was sent
  Bytes bytes;
};

// Records RTPS datagrams that pass the loopback interface of this thread's network namespace: the first ones, which are
// discovery, and later ones at random. As root.
class DatagramCapture {
 public:
  DatagramCapture();  // throws std::runtime_error
  ~DatagramCapture();
  DatagramCapture(const DatagramCapture&) = delete;
  DatagramCapture& operator=(const DatagramCapture&) = delete;

  std::vector<CapturedDatagram> datagrams() const;

 private:
  void run();
  void keep(const std::uint8_t* packet, std::size_t size);

  int socket_ = -1;
  mutable std::mutex mutex_;
  std::vector<CapturedDatagram> kept_;
  std::size_t seen_ = 0;
  std::mt19937_64 random_{1};
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

// Changes datagrams: flips bits, cuts, inserts, splices, states other lengths, sets extreme numbers, sends to other
// ports, from unknown participants; and adds what is known to have ended Fast DDS 2.9.
class DatagramMutator {
 public:
  // forges: also speaks for participants of the flight. No check of the structure can tell that; a network key can.
  DatagramMutator(std::vector<CapturedDatagram> datagrams, std::uint64_t seed, bool forges);
  CapturedDatagram next();

 private:
  std::size_t below(std::size_t end);  // a random number, 0 if end is 0
  void flip_bits(Bytes& bytes);
  void insert(Bytes& bytes);
  void splice(Bytes& bytes);
  void set_length(Bytes& bytes);
  void set_number(Bytes& bytes);
  void set_source(Bytes& bytes);
  Bytes known_killer(const Bytes& from);
  Bytes forgery(const Bytes& from);

  std::vector<CapturedDatagram> datagrams_;
  std::vector<std::uint16_t> ports_;
  std::mt19937_64 random_;
  const bool forges_;
};

// Sends changed datagrams over UDP at a rate until it is destroyed.
class DatagramAttack {
 public:
  // per_second: at most
  DatagramAttack(DatagramMutator mutator, int per_second);
  ~DatagramAttack();
  DatagramAttack(const DatagramAttack&) = delete;
  DatagramAttack& operator=(const DatagramAttack&) = delete;

  std::uint64_t sent() const { return sent_; }

 private:
  void run(int per_second);
  void send(const CapturedDatagram& datagram) const;

  DatagramMutator mutator_;
  const int socket_;
  std::atomic<std::uint64_t> sent_{0};
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace swiftlet::tests
