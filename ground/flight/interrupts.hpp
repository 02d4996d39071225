// Counts interrupt signals, so that the program can land the vehicle before it ends.
#pragma once

namespace swiftlet::ground {

// While an instance exists, SIGINT, SIGTERM and SIGHUP are counted and have no other effect. At most one
// instance at a time.
class Interrupts {
 public:
  Interrupts();
  ~Interrupts();
  Interrupts(const Interrupts&) = delete;
  Interrupts& operator=(const Interrupts&) = delete;

  int count() const;
};

}  // namespace swiftlet::ground
