// The table of checks: of each the quantity with its unit, the limits, and the sentences that name a defect by the value. A
// sentence that depends on more than the value stands where it is measured.
#pragma once

#include <limits>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "swiftlet/ground/vehicle_check/check_result.hpp"
#include "swiftlet/math/angles.hpp"
#include "swiftlet/plant/model/vehicle.hpp"

namespace swiftlet::ground {

constexpr double kUnlimited = std::numeric_limits<double>::infinity();

// Names the defect that values of from .. to show.
struct Sentence {
  constexpr Sentence(const char* sentence = "", double first = -kUnlimited, double last = kUnlimited)
      : text(sentence), from(first), to(last) {}

  const char* text;
  double from;
  double to;
};

// All texts are formats of fmt. Their words are value, size (its magnitude), least and most, and what a check adds.
struct Check {
  template <class... Texts>
  constexpr Check(const char* subject, const char* unit_of_value, double from, double to,
                  const char* measured, const char* allowed, Texts... texts)
      : name(subject),
        unit(unit_of_value),
        least(from),
        most(to),
        figure(measured),
        limit(allowed),
        sentences{Sentence(texts)...} {}

  const char* name;
  const char* unit;  // of value and limits
  double least;      // passes from here
  double most;       // to here
  const char* figure;
  const char* limit;
  Sentence sentences[10];  // of a value outside of the limits: the first whose range holds it
};

// A word that the texts of a check use.
struct Word {
  template <class Number, class = std::enable_if_t<std::is_arithmetic_v<Number>>>
  Word(const char* word, Number value) : name(word), number(static_cast<double>(value)) {}
  Word(const char* word, std::string value) : name(word), is_text(true), text(std::move(value)) {}

  const char* name;
  double number = 0.0;
  bool is_text = false;
  std::string text{};
};
using Words = std::vector<Word>;

constexpr Check with_limits(Check check, double least, double most, const char* limit = nullptr) {
  check.least = least;
  check.most = most;
  if (limit != nullptr) check.limit = limit;
  return check;
}

// By the limits; NaN fails.
CheckResult judge(const Check& check, double value, const Words& words = {});
// Fails with the sentence, or passes if it is empty.
CheckResult judge_by(const Check& check, double value, const std::string& sentence, const Words& words = {});

// Streams. The limits of {topic}.rate, .gap and .age depend on the topic.
constexpr Sentence kLate("late stamps: a sample is {size:.0f} ms old by its stamp when it arrives", 0.0);
constexpr Sentence kEarly("the stamps lie {size:.0f} ms in the future of the vehicle's clock");
constexpr const char* kOtherClock = "the stamps are not those of the vehicle's clock in ns, as in imu";

constexpr Check kReceived("{topic}.received", "messages", 0.0, kUnlimited, "{value:.0f} messages",
                          "valid, of one process");
constexpr Check kSequence("{topic}.sequence", "%", 0.0, 5.0, "{value:.1f} % lost, {repeated:.0f} repeated",
                          "lost at most {most:.0f} %, none repeated",
                          "gaps: {lost:.0f} of {sent:.0f} samples did not arrive, by their sequence numbers");
constexpr Check kStamps("{topic}.stamps", "", 0.0, 0.0, "{value:.0f} not rising", "all rise",
                        "{still:.0f} stamps repeat and {back:.0f} lie before that of the sample before: "
                        "control does not use these samples");
constexpr Check kClock("{topic}.clock", "s/s", 0.95, 1.05, "{value:.5g} s/s", "1 +- 5 %",
                       Sentence("frozen stamps: they do not follow the clock", 0.0, 0.0),
                       Sentence("stamps in us: stamp_ns must count nanoseconds", 0.5e-3, 1.5e-3),
                       Sentence("stamps in ms: stamp_ns must count nanoseconds", 0.5e-6, 1.5e-6),
                       Sentence("stamps in s: stamp_ns must count nanoseconds", 0.5e-9, 1.5e-9),
                       "the stamps do not run with the clock: they are not those of a clock in ns");
constexpr Check kSimulatedClock = with_limits(kClock, 0.01, 100.0, "{least:g} to {most:g}, simulated");
constexpr Check kRate("{topic}.rate", "Hz", 0.0, kUnlimited, "{value:.1f} Hz", "at least {least:g} Hz",
                      "too slow: {value:.1f} Hz");
// The limits are parts of the expected rate.
constexpr Check kImuRate("imu.rate", "Hz", 0.95, 1.05, "{value:.1f} Hz", "{expected:g} Hz +- 5 %",
                         "the rate is {value:.0f} Hz instead of the {of} {expected:.0f} Hz");
constexpr Check kGap("{topic}.gap", "ms", 0.0, 100.0, "{value:.1f} ms", "at most {most:.0f} ms",
                     "gaps: no sample for {value:.0f} ms");
constexpr Check kJitter("imu.jitter", "%", 0.0, 25.0, "{value:.1f} % of the period, p99",
                        "at most {most:.0f} %",
                        "the stamps are irregular: they are not taken when the sensor measures, or the "
                        "sampling is not steady");
constexpr Check kDelivery("imu.delivery", "ms", 0.0, 20.0, "{value:.1f} ms later than the fastest, p99",
                          "at most {most:.0f} ms",
                          "samples are delivered in bursts or late: the link or the vehicle's loop does not "
                          "keep time");
// The loop becomes unstable at such delays. A stamp may lie a little in the future.
constexpr Check kImuAge("imu.age", "ms", -5.0, 50.0, "{value:.1f} ms by the vehicle's clock",
                        "{least:.0f} to 50 ms", kLate, kEarly);
constexpr Check kAge("{topic}.age", "ms", -5.0, kUnlimited, "{value:.1f} ms behind imu",
                     "{least:.0f} to {most:.0f} ms", Sentence(kOtherClock, 1e4),
                     Sentence(kOtherClock, -kUnlimited, -1e4), kLate, kEarly);

// At rest. A gyro in degrees per second shows 57 times the noise and bias.
constexpr Check kImuValues("imu.values", "%", 0.0, 10.0, "{value:.1f} % repeated bit for bit",
                           "at most {most:.0f} %",
                           Sentence("stuck values: no sample differs from the one before", 99.0),
                           "{value:.0f} % of the samples repeat the values of the one before: the sensor is "
                           "read slower than imu is published");
constexpr Check kImuStill(
    "imu.still", "m/s^2", 0.0, 0.5, "{value:.3f} m/s^2 standard deviation", "at most {most:g} m/s^2",
    "the vehicle does not stand still with rotors off, or the accelerometer is too noisy");
constexpr double kG = plant::kGravity;
constexpr Check kImuGravity(
    "imu.gravity", "m/s^2", kG - 0.5, kG + 0.5, "{value:.3f} m/s^2", "{gravity:.2f} +- 0.5 m/s^2",
    Sentence("the accelerometer does not measure gravity: {against}; is it subtracted?", 0.0, 0.3),
    Sentence("accelerometer in g: {against}", 0.92, 1.08),
    Sentence("accelerometer in thousandths of g: {against}", 920.0, 1080.0),
    Sentence("accelerometer in mm/s^2: {against}", 920.0 * kG, 1080.0 * kG),
    Sentence("accelerometer in counts of a 16-bit sensor: {against}", 0.92 * 2048.0, 1.08 * 2048.0),
    Sentence("accelerometer in counts of a 16-bit sensor: {against}", 0.92 * 4096.0, 1.08 * 4096.0),
    Sentence("accelerometer in counts of a 16-bit sensor: {against}", 0.92 * 8192.0, 1.08 * 8192.0),
    Sentence("accelerometer in counts of a 16-bit sensor: {against}", 0.92 * 16384.0, 1.08 * 16384.0),
    "accelerometer has a wrong scale or bias: {against}");
constexpr Check kImuLevel(
    "imu.level", "degrees", 0.0, 10.0, "{value:.1f} degrees from -z: direction {direction}",
    "at most {most:.0f} degrees",
    Sentence("specific force points to +z: sign of the accelerometer reversed, or axes "
             "FLU (z up) instead of FRD; it is (0, 0, -g) at rest. --hand tells which",
             170.0),
    "the IMU is tilted by {value:.0f} degrees against the floor: is the vehicle level?");
constexpr double kGyroNoise_rad_s = 0.05;  // standard deviation
constexpr Check kImuGyro("imu.gyro", "rad/s", 0.0, 0.1, "{value:.4f} rad/s bias, {noise:.4f} rad/s noise",
                         "bias {most:g}, noise {most_noise:g} rad/s");
constexpr Check kMocapTracked("mocap_pose.tracked", "%", 0.0, 5.0, "{value:.1f} % of the frames untracked",
                              "at most {most:.0f} %",
                              "motion capture does not see the vehicle in all frames");
constexpr Check kMocapValues("mocap_pose.values", "%", 0.0, 10.0, "{value:.1f} % repeated bit for bit",
                             "at most {most:.0f} %",
                             "poses repeat bit for bit: frames are sent again, or tracking is stuck");
constexpr Check kMocapStill("mocap_pose.still", "mm", 0.0, 5.0, "{value:.2f} mm standard deviation",
                            "at most {most:g} mm",
                            "the position moves although the vehicle stands: another body, wrong unit, or "
                            "reflections");
constexpr Check kMocapGravity(
    "mocap_pose.gravity", "degrees", 0.0, 5.0, "{value:.2f} degrees from the accelerometer's vertical",
    "at most {most:g} degrees",
    Sentence("motion capture attitude is upside down against gravity: ENU or FLU in q_ned_from_frd", 150.0),
    Sentence("motion capture attitude is turned by about 90 degrees against gravity: axes swapped, y up?",
             75.0),
    "motion capture attitude is misaligned by {value:.1f} degrees with the vehicle: align the marker body");

// The vehicle's own estimate at rest.
constexpr Check kOdometryValid("vehicle_odometry.valid", "%", 100.0, 100.0,
                               "{value:.1f} % with position and velocity", "100 %",
                               "the vehicle does not know its position or its velocity");
constexpr Check kOdometryLevel("vehicle_odometry.level", "degrees", 0.0, 10.0,
                               "{value:.1f} degrees from level", "at most {most:.0f} degrees",
                               Sentence("the attitude is upside down: ENU or FLU in q_ned_from_frd", 170.0),
                               "the attitude is tilted by {value:.0f} degrees: is the vehicle level? "
                               "Components in another order than w, x, y, z?");
constexpr Check kOdometrySpeed("vehicle_odometry.speed", "m/s", 0.0, 0.1, "{value:.3f} m/s at most",
                               "at most {most:g} m/s",
                               "the estimate moves although the vehicle stands, or the velocity has another "
                               "unit");
constexpr Check kOdometryRates("vehicle_odometry.rates", "rad/s", 0.0, 0.1, "{value:.3f} rad/s at most",
                               "at most {most:g} rad/s",
                               "the body rates are in degrees/s, or not without the bias of the gyro");
constexpr Check kOdometryResets("vehicle_odometry.resets", "jumps", 0.0, 0.0, "{value:.0f} jumps", "none",
                                "the vehicle's estimate jumps while it stands");
constexpr Check kOdometryMocap("vehicle_odometry.mocap", "degrees", 0.0, 5.0,
                               "{value:.2f} degrees between the verticals; {distance:.2f} m and {turn:.1f} "
                               "degrees in all",
                               "at most {most:g} degrees between the verticals",
                               "the attitudes of the vehicle and of motion capture differ in tilt: align the "
                               "marker body, or look at axes and signs");

// Supply. If the vehicle file tells the voltage of a full battery, the limits are parts of it: a cell is discharged to about
// 0.7. Otherwise they are those of a discharged cell and of twelve full ones.
constexpr double kEmptiest = 0.7;
constexpr double kFullest = 1.05;
constexpr Check kVoltage("battery.voltage", "V", 2.5, 52.0, "{value:.2f} V, {charge:.0f} % charged",
                         "{least:.2f} to {most:.2f} V",
                         Sentence("battery in mV or another unit: voltage_v is {value:.4g}", 52.0),
                         "the battery is empty, or its voltage is not measured: voltage_v is {value:.4g}");

// Types, QoS and names of the topics, as discovery tells them.
constexpr Check kEndpoint("topics.match", "", 0.0, 0.0, "another", "those of this program");

// vehicle_info against the vehicle file.
constexpr Check kWireVersion("vehicle_info.wire_version", "", 0.0, 0.0, "another", "that of this program");
constexpr Check kRotorCount("vehicle_info.rotors", "rotors", 0.0, 0.0, "{value:.0f} rotors", "{most:.0f}",
                            "another vehicle: {name} has {value:.0f} rotors, the vehicle file {file} has "
                            "{most:.0f}");
constexpr Check kRotorsRunning("vehicle_info.rotors_running", "", 0.0, 0.0, "{running}", "false",
                               "rotors_running is true while the rotors are off: control waits for it with a "
                               "take-off, and would not wait for the rotors");
// The limits are parts of the expected mass.
constexpr Check kMass("vehicle_info.mass", "kg", 0.9, 1.1, "{value:.4f} kg", "{expected:g} kg +- 10 %",
                      "another mass than that of the vehicle file {file}: wrong file, or mass in grams");
constexpr Check kName("vehicle_info.name", "", 0.0, 0.0, "another", "that of the vehicle file");
constexpr Check kFullBattery("vehicle_info.full_battery", "V", 0.9, 1.1, "{value:.2f} V",
                             "{full:.2f} V +- 10 %",
                             "another battery than that of the vehicle file {file}: control does not arm it");
constexpr Check kEmptyBattery(
    "vehicle_info.empty_battery", "V", 0.9, 1.1, "{value:.2f} V", "{empty:.2f} V +- 10 %",
    "another battery than that of the vehicle file {file}: control does not arm it");

// Commands.
constexpr Check kCommandOff("commands.off", "", 0.0, 0.0, "{turning}", "rotors stand",
                            "rotors turn while off: ROTORS_OFF is a state of its own, not throttle 0");
constexpr Check kCommandObeyed("commands.obeyed", "ms", 0.0, 50.0,
                               "{value:.1f} ms from sample to obeyed command, p95", "at most {most:.0f} ms",
                               "the command that is reported answers a sample {value:.0f} ms before: "
                               "commands arrive late, or command_stamp_ns is not the stamp of the command");
constexpr Check kCommandIdle("commands.idle", "", 1.0, 1.0, "{turning}", "rotors turn",
                             "the rotors do not start: ROTORS_RUNNING at throttle 0 turns them slowly");
constexpr Check kCommandLowerTerm("commands.lower_term", "", 0.0, 0.0,
                                  "{value:.0f} of {samples:.0f} samples report it as obeyed", "none");
constexpr Check kCommandTimeout("commands.timeout", "s", 0.05, 1.0,
                                "{value:.2f} s until the rotors slow down", "{least:g} to {most:g} s",
                                Sentence("the rotors stop too late when commands cease", 1.0),
                                "the rotors stop at once when a command is missing: a lost datagram ends a "
                                "flight");
constexpr Check kCommandIgnoredTimeout("commands.timeout", "s", kCommandTimeout.least, kCommandTimeout.most,
                                       "{value:.2f} s without a command, rotors still turn",
                                       kCommandTimeout.limit);
constexpr Check kCommandStop("commands.stop", "", 0.0, 0.0, "{turning}", "rotors stand",
                             "rotors turn while off: they do not stop on ROTORS_OFF");
constexpr Check kCommandRunningReport("commands.rotors_running", "", 0.0, 0.0,
                                      "{started} after start, {stopped} after stop", "true, then false");

// Rotors: by their speeds, by what a person has seen, and by the turn of the vehicle.
constexpr Check kOrderBySpeeds("rotor_{rotor:.0f}.order", "rad/s", 0.0, 0.0,
                               "{value:.0f} rad/s faster than idle", "only {asked} faster");
constexpr Check kOrderSeen("rotor_{rotor:.0f}.order", "", 0.0, 0.0, "rotor {value:.0f} seen",
                           "only {asked} faster");
constexpr Check kOrderByTurn("rotor_{rotor:.0f}.order", "rad/s", 0.0, 0.0, "turn of {turn} rad/s",
                             "as thrust of {asked}");
constexpr Check kSpinSeen("rotor_{rotor:.0f}.spin", "", 0.0, 0.0, "{seen}", "{expected}");
constexpr Check kSpinByTurn("rotor_{rotor:.0f}.spin", "rad/s", 0.0, 0.0, "{value:.3f} rad/s about z",
                            "as {expected}");

// In the hand.
constexpr Check kHandAxes("hand.{subject}", "", 0.0, 0.0, "x, y, z to their axes: {along}",
                          "right axes, positive");
constexpr Check kGyroScale("hand.gyro_scale", "", 0.9, 1.1, "{value:.3f} of motion capture", "1 +- 0.1",
                           Sentence("gyro in degrees/s: it shows 57 times the turn of motion capture",
                                    0.85 * math::kDegPerRad, 1.15 * math::kDegPerRad),
                           Sentence("gyro converted to radians twice: it shows 1/57 of the turn of motion "
                                    "capture",
                                    0.85 / math::kDegPerRad, 1.15 / math::kDegPerRad),
                           "gyro has a wrong scale: it shows {value:.3g} times the turn of motion capture");
constexpr Check kHandForward("hand.mocap_forward", "m", 0.0, 0.0, "{moved} m", "along +x, body axes");
constexpr Check kHandUp("hand.mocap_up", "m", 0.0, 0.0, "{moved} m", "along -z, NED");
constexpr Check kHandDelay(
    "hand.delay", "ms", -15.0, 15.0,
    "{value:.0f} ms of motion capture behind the gyro, correlation {correlation:.2f}", "+- {most:.0f} ms",
    Sentence("motion capture delayed: its stamps are {size:.0f} ms later than the "
             "motion; they must be those of the exposure",
             0.0),
    "late IMU stamps: they are {size:.0f} ms later than the motion, by motion capture");
constexpr Check kHandAlignment("hand.alignment", "degrees", 0.0, 5.0,
                               "{value:.1f} degrees between motion capture and gyro",
                               "at most {most:g} degrees",
                               "motion capture attitude is misaligned by {value:.0f} degrees with the IMU: "
                               "align the marker body, or look at the IMU's mounting");
constexpr Check kWrapAround("imu.wrap_around", "", 0.0, 0.0, "{value:.0f} jumps from end to end", "none",
                            "16-bit wrap-around: {axis} jumps between +{end:.2f} and -{end:.2f} {unit}");
constexpr Check kSaturation(
    "imu.saturation", "", 0.0, 0.0, "{value:.0f} axes saturated", "none",
    "{axis} saturates at {end:.2f} {unit} in motion of a hand: its range is too small");

}  // namespace swiftlet::ground
