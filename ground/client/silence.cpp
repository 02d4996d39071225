#include "swiftlet/ground/client/silence.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <ctime>

#include "swiftlet/ground/client/connection.hpp"

namespace swiftlet::ground {
namespace {

// Longer than any gap of a healthy stream: IMU and poses come at 100 Hz or more, control_status and battery at
// 10 Hz, vehicle_info at 1 Hz.
constexpr const char* kControl = "control service";
constexpr double kControlSilence_s = std::chrono::duration<double>(kConnectionSilence).count();
constexpr double kSensorSilence_s = 0.5;
constexpr double kBatterySilence_s = 2.0;
constexpr double kVehicleTopicsSilence_s = 2.5;

template <class T>
double age_s(const Latest<T>& latest, Clock::time_point now) {
  return latest.seen() ? latest.age_s(now) : INFINITY;
}

// age_s: below 0 or infinite if no sample has come.
void judge(const char* who, double age_s, double limit_s, const char* missing,
           std::vector<Silence>& silences) {
  if (age_s < 0.0 || std::isinf(age_s)) {
    silences.push_back({who, std::nullopt, missing});
  } else if (age_s > limit_s) {
    silences.push_back({who, age_s, missing});
  }
}

// By the topics that come from the vehicle itself.
void judge_without_control(const View& view, Clock::time_point now, std::vector<Silence>& silences) {
  const double newest_s =
      std::min({age_s(view.vehicle, now), age_s(view.battery, now), age_s(view.truth, now)});
  judge("vehicle", newest_s, kVehicleTopicsSilence_s, "no vehicle_info, battery or ground_truth", silences);
  if (view.battery.seen())
    judge("battery", age_s(view.battery, now), kBatterySilence_s, "no voltage", silences);
}

}  // namespace

std::vector<Silence> silences_of(const View& view, Clock::time_point now) {
  std::vector<Silence> silences;
  const msg::ControlStatus& control = view.control.message;
  const double control_age_s = age_s(view.control, now);
  judge(kControl, control_age_s, kControlSilence_s, "no control_status", silences);
  if (!silences.empty()) {
    judge_without_control(view, now, silences);
    return silences;
  }
  judge("vehicle", control.imu_age_s(), kSensorSilence_s, "no IMU sample", silences);
  judge("motion capture", control.mocap_age_s(), kSensorSilence_s, "no pose", silences);
  judge("battery", control.battery_age_s(), kBatterySilence_s, "no voltage", silences);
  for (Silence& silence : silences) {
    if (silence.for_s) *silence.for_s += control_age_s;
  }
  return silences;
}

bool control_is_silent(const std::vector<Silence>& silences) {
  return std::any_of(silences.begin(), silences.end(),
                     [](const Silence& silence) { return silence.who == kControl; });
}

double pose_age_s(const View& view, Clock::time_point now) {
  const double reported_s = view.control.message.pose_age_s();
  const double control_age_s = view.control.age_s(now);
  return control_age_s > kControlSilence_s ? reported_s + control_age_s : reported_s;
}

std::string to_string(const Silence& silence, std::chrono::system_clock::time_point system_now) {
  std::string text = silence.who;
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::toupper(c); });
  text += " SILENT";
  if (!silence.for_s) return text + ": nothing has come from it yet";
  const auto age = std::chrono::duration_cast<std::chrono::system_clock::duration>(
      std::chrono::duration<double>(*silence.for_s));
  const std::time_t since = std::chrono::system_clock::to_time_t(system_now - age);
  std::tm local{};
  localtime_r(&since, &local);
  char clock[16];
  std::strftime(clock, sizeof clock, "%H:%M:%S", &local);
  char duration[48];
  std::snprintf(duration, sizeof duration, " for %.1f s, since %s", *silence.for_s, clock);
  return text + duration + (silence.missing.empty() ? "" : " (" + silence.missing + ")");
}

}  // namespace swiftlet::ground
