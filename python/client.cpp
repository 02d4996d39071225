// Running vehicles: requests, setpoints, states and streams. Everything that waits releases the GIL.
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <utility>

#include "bindings.hpp"

#include "swiftlet/ground/client/context.hpp"
#include "swiftlet/ground/client/topic_stream.hpp"
#include "swiftlet/ground/client/vehicle.hpp"
#include "swiftlet/io/missions/mission_file.hpp"
#include "swiftlet/record/mcap/signal_arrays.hpp"

namespace swiftlet::python {
namespace {

using namespace py::literals;
using ground::ActionHandle;
using ground::ActionResult;
using ground::Context;
using ground::Result;
using ground::TopicStream;
using ground::Vehicle;

// How long it waits before it looks whether the user wants an end.
constexpr std::chrono::milliseconds kSignalPeriod{100};

dds::NodeSettings network_of(int domain, bool open_network, const std::string& network_key,
                             const std::string& security) {
  dds::NodeSettings network;
  network.name = "ground";
  network.domain = domain;
  network.open_network = open_network;
  network.network_key_file = network_key;
  network.security = security;
  return network;
}

const char* kind_of(Result::Kind kind) {
  switch (kind) {
    case Result::Kind::kAccepted:
      return "accepted";
    case Result::Kind::kRefused:
      return "refused";
    case Result::Kind::kNoControl:
      return "no_control";
    case Result::Kind::kSilence:
      return "silence";
    case Result::Kind::kCancelled:
      return "cancelled";
  }
  return "";
}

const char* kind_of(ActionResult::Kind kind) {
  switch (kind) {
    case ActionResult::Kind::kCompleted:
      return "completed";
    case ActionResult::Kind::kNotAccepted:
      return "not_accepted";
    case ActionResult::Kind::kCanceled:
      return "canceled";
    case ActionResult::Kind::kAborted:
      return "aborted";
    case ActionResult::Kind::kLost:
      return "lost";
    case ActionResult::Kind::kTimedOut:
      return "timed_out";
  }
  return "";
}

// Called with the GIL after a request that was made without.
void require_accepted(const Result& result) {
  check_signals();
  if (PyErr_Occurred() != nullptr) throw py::error_already_set();
  if (!result.accepted()) raise("RequestError", result.reason, kind_of(result.kind));
}

void wait(const ActionHandle& action, double timeout_s) {
  const auto end = std::chrono::steady_clock::now() + limit_of(timeout_s);
  ActionResult result;
  do {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(end - std::chrono::steady_clock::now());
    {
      const py::gil_scoped_release without_gil;
      result = action.wait(std::clamp(left, std::chrono::milliseconds(0), kSignalPeriod));
    }
    check_signals();
  } while (result.kind == ActionResult::Kind::kTimedOut && std::chrono::steady_clock::now() < end);
  if (!result.done()) raise("ActionError", result.reason, kind_of(result.kind));
}

// Makes a request, also to be ended by the user. Throws RequestError.
template <class Ask>
ActionHandle ask(Vehicle& vehicle, const Ask& request) {
  std::optional<ActionHandle> action;
  {
    const py::gil_scoped_release without_gil;
    action.emplace(request(vehicle));
  }
  require_accepted(action->answer());
  return *action;
}

// Defines a method that makes a request without arguments but the time-out.
template <ActionHandle (Vehicle::*kMethod)(std::chrono::milliseconds)>
void def_request(py::class_<Vehicle>& type, const char* name, const char* doc) {
  type.def(
      name,
      [](Vehicle& self, double timeout_s) {
        return ask(self, [&](Vehicle& vehicle) { return (vehicle.*kMethod)(limit_of(timeout_s)); });
      },
      "timeout_s"_a = 5.0, doc);
}

template <ActionHandle (Vehicle::*kMethod)(std::uint64_t, std::chrono::milliseconds)>
void def_mission_request(py::class_<Vehicle>& type, const char* name, const char* doc) {
  type.def(
      name,
      [](Vehicle& self, std::uint64_t id, double timeout_s) {
        return ask(self, [&](Vehicle& vehicle) { return (vehicle.*kMethod)(id, limit_of(timeout_s)); });
      },
      "id"_a = 0, "timeout_s"_a = 5.0, doc);
}

Eigen::Vector4d wxyz(const Eigen::Quaterniond& q) { return {q.w(), q.x(), q.y(), q.z()}; }

void add_state(py::module_& module) {
  using ground::VehicleState;
  py::class_<VehicleState>(module, "VehicleState",
                           "The newest state that was received. NaN: not received yet.")
      .def_property_readonly(
          "mode", [](const VehicleState& self) { return control::to_string(self.mode); },
          "'disarmed', 'holding' ...")
      .def_readonly("mode_reason", &VehicleState::mode_reason, "Why the mode was entered.")
      .def_readonly("airborne", &VehicleState::airborne)
      .def_readonly("has_pose", &VehicleState::has_pose, "Poses of motion capture arrive.")
      .def_readonly("age_s", &VehicleState::age_s, "Since the last control_status, s.")
      .def_readonly("stamp_ns", &VehicleState::stamp_ns, "Of the estimate, on the vehicle's clock.")
      .def_readonly("position_ned_m", &VehicleState::position_ned_m, "Estimate, shape (3,).")
      .def_readonly("velocity_ned_m_s", &VehicleState::velocity_ned_m_s, "Estimate, shape (3,).")
      .def_property_readonly(
          "q_ned_from_frd", [](const VehicleState& self) { return wxyz(self.q_ned_from_frd); },
          "Estimate, shape (4,): w, x, y, z.")
      .def_readonly("body_rates_frd_rad_s", &VehicleState::body_rates_frd_rad_s, "Estimate, shape (3,).")
      .def_readonly("reference_position_ned_m", &VehicleState::reference_position_ned_m, "Shape (3,).")
      .def_readonly("battery_voltage_v", &VehicleState::battery_voltage_v)
      .def_readonly("battery_charge", &VehicleState::battery_charge, "0 empty .. 1 full.")
      .def_property_readonly(
          "mission_state", [](const VehicleState& self) { return text_of(self.mission.state); },
          "'none', 'uploaded', 'running', 'paused', 'completed' or 'aborted'.")
      .def_property_readonly(
          "mission_item", [](const VehicleState& self) { return self.mission.item; },
          "The item being flown, from 1; 0 without a mission.")
      .def_property_readonly("mission_items", [](const VehicleState& self) { return self.mission.items; })
      .def_property_readonly("setpoints_accepted",
                             [](const VehicleState& self) { return self.setpoints.accepted; })
      .def_property_readonly("setpoints_refused",
                             [](const VehicleState& self) { return self.setpoints.refused; })
      .def_property_readonly(
          "setpoint_refusal", [](const VehicleState& self) { return self.setpoints.refusal; },
          "Why the last one was refused.");
}

py::object value_of(const mcap::Value& value) {
  return std::visit([](const auto& one) -> py::object { return py::cast(one); }, value);
}

py::dict dict_of(const std::vector<mcap::Column>& columns, const TopicStream::Sample& sample) {
  py::dict out("received_ns"_a = sample.received_ns);
  for (const mcap::SignalArray& array : mcap::signal_arrays(columns)) {
    if (array.count == 1) {
      out[array.name.c_str()] = value_of(sample.values[array.first]);
      continue;
    }
    py::list values;
    for (std::size_t i = 0; i < array.count; ++i) values.append(value_of(sample.values[array.first + i]));
    out[array.name.c_str()] = py::array(values);
  }
  return out;
}

py::dict await_next(TopicStream& stream, std::chrono::milliseconds timeout) {
  const auto end = std::chrono::steady_clock::now() + timeout;
  for (;;) {
    std::optional<TopicStream::Sample> sample;
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(end - std::chrono::steady_clock::now());
    {
      const py::gil_scoped_release without_gil;
      sample = stream.next(std::clamp(left, std::chrono::milliseconds(0), kSignalPeriod));
    }
    if (sample) return dict_of(stream.columns(), *sample);
    check_signals();
    if (std::chrono::steady_clock::now() >= end) {
      PyErr_SetString(PyExc_TimeoutError, "no message arrived");
      throw py::error_already_set();
    }
  }
}

void add_streams(py::module_& module) {
  py::class_<TopicStream>(module, "Stream",
                          "The messages of a topic as they arrive. An iterator that does not end.")
      .def(
          "next", [](TopicStream& self, double timeout_s) { return await_next(self, limit_of(timeout_s)); },
          "timeout_s"_a = 5.0,
          "The oldest message that waits, else the next: its fields by name ('position_ned'), arrays as "
          "NumPy arrays, and "
          "received_ns, ns since 1970. Throws TimeoutError if none arrives.")
      .def("__iter__", [](const py::object& self) { return self; })
      .def("__next__",
           [](TopicStream& self) {
             return await_next(self, limit_of(std::numeric_limits<double>::infinity()));
           })
      .def_property_readonly("dropped", &TopicStream::dropped,
                             "Messages that were dropped because nobody took them.");
}

void add_context(py::module_& module) {
  py::class_<Context>(module, "Context",
                      "A participant of a DDS domain, which the vehicles of a program share.")
      .def(py::init([](int domain, bool open_network, const std::string& network_key,
                       const std::string& security) {
             const dds::NodeSettings network = network_of(domain, open_network, network_key, security);
             const py::gil_scoped_release without_gil;
             return std::make_unique<Context>(network);
           }),
           "domain"_a = 0, py::kw_only(), "open_network"_a = false, "network_key"_a = "", "security"_a = "")
      .def("discovered_vehicles", &Context::discovered_vehicles, WithoutGil(),
           "The names of the vehicles found so far, sorted. Discovery takes up to a second.");
}

void add_actions(py::module_& module) {
  py::class_<ActionHandle>(module, "Action", "An accepted request.")
      .def("wait", &wait, "timeout_s"_a = 60.0, "Waits until it has come to its end. Throws ActionError.")
      .def_property_readonly("progress", &ActionHandle::progress, "0 .. 1, as last reported.");
}

void add_requests(py::class_<Vehicle>& vehicle) {
  def_request<&Vehicle::arm>(vehicle, "arm", "Done: the rotors turn.");
  def_request<&Vehicle::disarm>(vehicle, "disarm", "On the ground only.");
  def_request<&Vehicle::hold>(vehicle, "hold", "Brakes. Done: at rest.");
  def_request<&Vehicle::stop>(vehicle, "stop", "Switches the rotors off at once, in flight too.");
  vehicle
      .def(
          "take_off",
          [](Vehicle& self, double height_m, double speed_m_s, double timeout_s) {
            return ask(self,
                       [&](Vehicle& one) { return one.take_off(height_m, speed_m_s, limit_of(timeout_s)); });
          },
          "height_m"_a = 1.0, "speed_m_s"_a = 0.5, "timeout_s"_a = 5.0,
          "Climbs straight up to this height above the origin.")
      .def(
          "go_to",
          [](Vehicle& self, const Eigen::Vector3d& position_ned_m, std::optional<double> yaw_rad,
             double speed_m_s, double timeout_s) {
            return ask(self, [&](Vehicle& one) {
              return one.go_to({position_ned_m, yaw_rad, speed_m_s}, limit_of(timeout_s));
            });
          },
          "position_ned_m"_a, "yaw_rad"_a = py::none(), "speed_m_s"_a = 0.5, "timeout_s"_a = 5.0,
          "Flies straight there and holds. yaw_rad: from north towards east; kept if not given.")
      .def(
          "land",
          [](Vehicle& self, double speed_m_s, double timeout_s) {
            return ask(self, [&](Vehicle& one) { return one.land(speed_m_s, limit_of(timeout_s)); });
          },
          "speed_m_s"_a = 0.4, "timeout_s"_a = 5.0, "Done: the rotors are off.")
      .def(
          "upload",
          [](Vehicle& self, const io::MissionFile& mission, double timeout_s) {
            return ask(self, [&](Vehicle& one) { return one.upload(mission.mission, limit_of(timeout_s)); });
          },
          "mission"_a, "timeout_s"_a = 5.0, "Uploads a mission without starting it.")
      .def(
          "follow",
          [](Vehicle& self, const io::MissionFile& mission, double timeout_s) {
            return ask(self, [&](Vehicle& one) { return one.follow(mission.mission, limit_of(timeout_s)); });
          },
          "mission"_a, "timeout_s"_a = 5.0, "Uploads a mission and starts it. Done: it is completed.");
  def_mission_request<&Vehicle::start_mission>(
      vehicle, "start_mission", "Of the mission that the vehicle has. id: 0: any. Done: it is completed.");
  def_mission_request<&Vehicle::pause_mission>(vehicle, "pause_mission", "Done: at rest.");
  def_mission_request<&Vehicle::resume_mission>(vehicle, "resume_mission", "Done: the mission is completed.");
  def_mission_request<&Vehicle::skip_mission_item>(
      vehicle, "skip_mission_item", "Continues with the next item. Done: the mission is completed.");
  def_mission_request<&Vehicle::clear_mission>(vehicle, "clear_mission", "Deletes the mission.");
}

ground::HeadingSetpoint heading(std::optional<double> yaw_rad, double yaw_rate_rad_s) {
  return {yaw_rad, yaw_rate_rad_s};
}

void add_setpoints(py::class_<Vehicle>& vehicle) {
  const Eigen::Vector3d zero = Eigen::Vector3d::Zero();
  vehicle
      .def(
          "send_position",
          [](Vehicle& self, const Eigen::Vector3d& position, const Eigen::Vector3d& velocity,
             const Eigen::Vector3d& acceleration, std::optional<double> yaw_rad, double yaw_rate) {
            return self.send(
                ground::PositionSetpoint{position, velocity, acceleration, heading(yaw_rad, yaw_rate)});
          },
          "position_ned_m"_a, "velocity_ned_m_s"_a = zero, "acceleration_ned_m_s2"_a = zero,
          "yaw_rad"_a = py::none(), "yaw_rate_rad_s"_a = 0.0, WithoutGil(),
          "Sends a setpoint of a stream of at least 2 Hz, which the vehicle follows from hold on; it holds "
          "when the stream "
          "stops. Velocity and acceleration are fed forward. False: no controller receives it.")
      .def(
          "send_velocity",
          [](Vehicle& self, const Eigen::Vector3d& velocity, const Eigen::Vector3d& acceleration,
             std::optional<double> yaw_rad, double yaw_rate) {
            return self.send(ground::VelocitySetpoint{velocity, acceleration, heading(yaw_rad, yaw_rate)});
          },
          "velocity_ned_m_s"_a, "acceleration_ned_m_s2"_a = zero, "yaw_rad"_a = py::none(),
          "yaw_rate_rad_s"_a = 0.0, WithoutGil(), "As send_position().")
      .def(
          "send_attitude",
          [](Vehicle& self, const Eigen::Vector4d& q, double thrust, const Eigen::Vector3d& rates) {
            return self.send(
                ground::AttitudeSetpoint{Eigen::Quaterniond(q[0], q[1], q[2], q[3]), thrust, rates});
          },
          "q_ned_from_frd"_a, "specific_thrust_m_s2"_a, "body_rates_frd_rad_s"_a = zero, WithoutGil(),
          "As send_position(). q_ned_from_frd: w, x, y, z. Thrust over mass along -z of FRD: 9.81 carries "
          "the weight.")
      .def(
          "send_body_rates",
          [](Vehicle& self, const Eigen::Vector3d& rates, double thrust) {
            return self.send(ground::BodyRatesSetpoint{rates, thrust});
          },
          "body_rates_frd_rad_s"_a, "specific_thrust_m_s2"_a, WithoutGil(), "As send_position().")
      .def_property_readonly(
          "clock_s", &Vehicle::clock_s,
          "The vehicle's clock, s, by which streams are timed; NaN before its first estimate.");
}

void add_stream(py::module_& module) {
  module.def(
      "stream",
      [](const Context& context, const std::string& vehicle_name, const std::string& topic,
         std::size_t capacity) {
        const py::gil_scoped_release without_gil;
        return std::make_unique<TopicStream>(context.participant(), vehicle_name, topic, capacity);
      },
      "context"_a, "vehicle"_a, "topic"_a, "capacity"_a = 4096,
      "The messages of a topic ('estimate', 'mocap_pose', 'control_status' ...; idl/README.md lists all). Of "
      "more than "
      "`capacity` messages that wait, the oldest are dropped.");
}

void add_waiting(py::class_<Vehicle>& vehicle) {
  vehicle
      .def(
          "connect",
          [](Vehicle& self, double timeout_s) {
            Result result;
            {
              const py::gil_scoped_release without_gil;
              result = self.connect(limit_of(timeout_s));
            }
            require_accepted(result);
          },
          "timeout_s"_a = 5.0,
          "Waits for the controller. Throws RequestError, which says what was found instead.")
      .def(
          "wait_until",
          [](const Vehicle& self, const std::function<bool(const ground::VehicleState&)>& holds,
             double timeout_s) {
            const auto end = std::chrono::steady_clock::now() + limit_of(timeout_s);
            for (;;) {
              if (holds(self.state())) return true;
              if (std::chrono::steady_clock::now() >= end) return false;
              check_signals();
              const py::gil_scoped_release without_gil;
              self.wait_until([](const ground::VehicleState&) { return false; },
                              std::chrono::milliseconds(20));
            }
          },
          "holds"_a, "timeout_s"_a, "Waits until holds(state) is true; False after the time-out.");
}

}  // namespace

void add_client(py::module_& module) {
  add_state(module);
  add_streams(module);
  add_context(module);
  add_actions(module);
  py::class_<Vehicle> vehicle(
      module, "Vehicle",
      "A running vehicle. Requests wait for the answer, throw RequestError with the reason if they are "
      "not accepted, and return an Action. Positions are m north, east and down of the origin.");
  vehicle
      .def(py::init([](const Context& context, const std::string& name) {
             const py::gil_scoped_release without_gil;
             auto one = std::make_unique<Vehicle>(context, name);
             one->cancel_when([] {
               const py::gil_scoped_acquire gil;
               return PyErr_CheckSignals() != 0;
             });
             return one;
           }),
           "context"_a, "name"_a = "kl1")
      .def_property_readonly("name", &Vehicle::name)
      .def_property_readonly("connected", &Vehicle::connected,
                             "A control_status arrived within the last second.")
      .def("state", &Vehicle::state, WithoutGil())
      .def("enable_link_loss_failsafe", &Vehicle::enable_link_loss_failsafe, WithoutGil(),
           "From now on the controller acts if this program falls silent.")
      .def("disable_link_loss_failsafe", &Vehicle::disable_link_loss_failsafe, WithoutGil());
  add_waiting(vehicle);
  add_requests(vehicle);
  add_setpoints(vehicle);
  add_stream(module);
}

}  // namespace swiftlet::python
