// Ctrl-C and its kin, counted instead of fatal.
#pragma once

namespace swiftlet::ground {

// While one lives, SIGINT, SIGTERM and SIGHUP only count. One at a time.
class Interrupts {
 public:
  Interrupts();
  ~Interrupts();
  Interrupts(const Interrupts&) = delete;
  Interrupts& operator=(const Interrupts&) = delete;

  int count() const;
};

}  // namespace swiftlet::ground
