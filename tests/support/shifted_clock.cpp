// Preloaded into a process, this shifts its CLOCK_REALTIME:
// - by the number of seconds in the file SWIFTLET_CLOCK_SHIFT: a mapped int64, so that a test can step the clock while
//   the process runs;
// - by SWIFTLET_CLOCK_DRIFT_PPM, from the start of the process on;
// - by SWIFTLET_CLOCK_STEP_S, from SWIFTLET_CLOCK_STEP_AFTER_S after the start of the process on.
#include <cstdint>
#include <cstdlib>
#include <ctime>
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <sys/time.h>
#include <unistd.h>

namespace {

constexpr std::int64_t kSecondNs = 1'000'000'000;

const volatile std::int64_t* map_shift() {
  static constexpr std::int64_t kNone = 0;
  const char* const file = std::getenv("SWIFTLET_CLOCK_SHIFT");
  const int opened = file == nullptr ? -1 : open(file, O_RDONLY | O_CLOEXEC);
  if (opened < 0) return &kNone;
  void* const mapped = mmap(nullptr, sizeof(std::int64_t), PROT_READ, MAP_SHARED, opened, 0);
  close(opened);
  return mapped == MAP_FAILED ? &kNone : static_cast<const std::int64_t*>(mapped);
}

double number_in(const char* variable) {
  const char* const text = std::getenv(variable);
  return text == nullptr ? 0.0 : std::atof(text);
}

double monotonic_s() {
  timespec now{};
  syscall(SYS_clock_gettime, CLOCK_MONOTONIC, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

std::int64_t shift_ns() {
  static const volatile std::int64_t* const shift_s = map_shift();
  static const double drift = 1e-6 * number_in("SWIFTLET_CLOCK_DRIFT_PPM");
  static const double step_s = number_in("SWIFTLET_CLOCK_STEP_S");
  static const double step_after_s = number_in("SWIFTLET_CLOCK_STEP_AFTER_S");
  static const double start_s = monotonic_s();
  const double running_s = monotonic_s() - start_s;
  const double moved_s = drift * running_s + (running_s < step_after_s ? 0.0 : step_s);
  return *shift_s * kSecondNs + static_cast<std::int64_t>(1e9 * moved_s);
}

void shift(timespec& time) {
  const std::int64_t shifted_ns = time.tv_sec * kSecondNs + time.tv_nsec + shift_ns();
  time.tv_sec = shifted_ns / kSecondNs;
  time.tv_nsec = shifted_ns % kSecondNs;
}

}  // namespace

extern "C" {

int clock_gettime(clockid_t clock, timespec* now) noexcept {
  const auto result = static_cast<int>(syscall(SYS_clock_gettime, clock, now));
  if (result == 0 && (clock == CLOCK_REALTIME || clock == CLOCK_REALTIME_COARSE)) shift(*now);
  return result;
}

int gettimeofday(timeval* now, void*) noexcept {
  timespec precise{};
  clock_gettime(CLOCK_REALTIME, &precise);
  now->tv_sec = precise.tv_sec;
  now->tv_usec = precise.tv_nsec / 1000;
  return 0;
}

time_t time(time_t* now) noexcept {
  timespec precise{};
  clock_gettime(CLOCK_REALTIME, &precise);
  if (now != nullptr) *now = precise.tv_sec;
  return precise.tv_sec;
}
}
