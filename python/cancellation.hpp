// Lets Ctrl-C end what runs without the GIL.
#pragma once

#include <atomic>
#include <optional>

#include "bindings.hpp"

namespace swiftlet::python {

// True once a handler of a signal has raised an exception, such as KeyboardInterrupt. Called often and from any thread; only
// the main thread of Python learns of signals.
class Cancellation {
 public:
  bool operator()() {
    if (calls_.fetch_add(1) % kCallsPerCheck == 0) check();
    return cancelled_;
  }
  void check() {
    const py::gil_scoped_acquire gil;
    if (PyErr_CheckSignals() == 0) return;
    raised_.emplace();  // takes the exception
    cancelled_ = true;
  }
  bool is_cancelled() const { return cancelled_; }
  // Needs the GIL.
  void raise_if_cancelled() const {
    if (raised_) throw py::error_already_set(*raised_);
  }

 private:
  static constexpr unsigned kCallsPerCheck = 500;
  std::atomic<unsigned> calls_{0};
  std::atomic<bool> cancelled_{false};
  std::optional<py::error_already_set> raised_;  // guarded by the GIL
};

}  // namespace swiftlet::python
