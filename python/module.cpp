#include <algorithm>
#include <dlfcn.h>
#include <filesystem>
#include <stdexcept>

#include "bindings.hpp"

#include "swiftlet/ground/client/client.hpp"
#include "swiftlet/io/command_line/command.hpp"
#include "swiftlet/io/config_error.hpp"
#include "swiftlet/io/program_directory.hpp"

namespace swiftlet::python {
namespace {

namespace fs = std::filesystem;

const int kAddressInThisModule = 0;

// The programs of the build tree are in build/bin, this module in build/python/swiftlet; installed, in PREFIX/bin and
// PREFIX/lib/python3/dist-packages/swiftlet.
void find_programs() {
  Dl_info module{};
  if (dladdr(&kAddressInThisModule, &module) == 0 || module.dli_fname == nullptr) return;
  fs::path folder = fs::absolute(module.dli_fname).parent_path();
  for (int up = 0; up < 4; ++up) {
    folder = folder.parent_path();
    if (fs::exists(folder / "bin" / "swiftlet")) {
      io::set_program_directory(folder / "bin");
      return;
    }
  }
}

}  // namespace

void refuse(const std::string& sentence) { throw io::InputError(sentence); }

void raise(const char* exception, const std::string& reason, const char* kind) {
  const py::object type = py::module_::import("swiftlet._core").attr(exception);
  py::object error = type(reason);
  error.attr("kind") = kind;
  PyErr_SetObject(type.ptr(), error.ptr());
  throw py::error_already_set();
}

void check_signals() {
  if (PyErr_CheckSignals() != 0) throw py::error_already_set();
}

const char* text_of(control::MissionState state) {
  return ground::mission_state_name(static_cast<std::uint8_t>(state));
}

std::chrono::milliseconds limit_of(double timeout_s) {
  constexpr double kYear_s = 365.0 * 86400.0;
  if (!(timeout_s >= 0.0)) refuse("timeout_s is " + std::to_string(timeout_s) + ", must be at least 0");
  return std::chrono::milliseconds(static_cast<std::int64_t>(std::min(timeout_s, kYear_s) * 1e3));
}

InUse::InUse(std::mutex& mutex) : lock_(mutex, std::try_to_lock) {
  if (!lock_.owns_lock()) throw std::runtime_error("another thread uses this object: give each its own");
}

void add_errors(py::module_& module) {
  static py::exception<io::ConfigError> input_error(module, "InputError", PyExc_ValueError);
  input_error.attr("__doc__") =
      "Bad input: a file, a name or a value. The text is one sentence, with file, line, key, value and "
      "limit.";
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const io::ConfigError& error) {
      PyErr_SetString(input_error.ptr(), error.what());
    } catch (const io::InputError& error) {
      PyErr_SetString(input_error.ptr(), error.what());
    } catch (const std::invalid_argument& error) {
      PyErr_SetString(input_error.ptr(), error.what());
    }
  });
  const auto add = [&](const char* name, const char* doc) {
    const py::object type = py::reinterpret_steal<py::object>(PyErr_NewExceptionWithDoc(
        (std::string("swiftlet._core.") + name).c_str(), doc, PyExc_RuntimeError, nullptr));
    type.attr("kind") = "";
    module.attr(name) = type;
  };
  add("RequestError",
      "A request was not accepted. The text is the reason. kind: 'refused' by the controller, 'no_control' "
      "was "
      "found, 'silence': it did not answer.");
  add("ActionError",
      "An accepted request did not come to its end. The text is the reason. kind: 'canceled' by another "
      "request or "
      "setpoints, 'aborted' by a failsafe, 'lost': the controller was restarted, 'timed_out': it still goes "
      "on.");
}

}  // namespace swiftlet::python

PYBIND11_MODULE(_core, module) {
  using namespace swiftlet::python;
  module.doc() = "The C++ libraries of Swiftlet. Import swiftlet instead.";
  find_programs();
  add_errors(module);
  add_models(module);
  add_gains(module);
  add_simulation(module);
  add_stepped_simulation(module);
  add_environments(module);
  add_logs(module);
  add_client(module);
}
