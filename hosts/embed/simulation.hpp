// simulation.hpp: what stands behind a calx_sim, and how faults become codes. Private to hosts/embed.
#pragma once
#include <memory>
#include <new>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "calx/embed.h"
#include "sim/simulation.hpp"

struct calx_sim {
  std::unique_ptr<calx::Simulation> simulation;
  calx_sim_callback on_step = nullptr;
  void* step_user = nullptr;
  std::uint64_t every = 0;
  calx_sim_listener on_message = nullptr;
  void* message_user = nullptr;
  std::vector<std::vector<std::string>> columns;  // per sensor
  bool stepping = false;
};

namespace calx {

/// Keeps the message for calx_sim_error, returns the code.
std::int32_t failed(std::int32_t code, const std::string& message) noexcept;

/// Calls body; what it throws becomes a code. Nothing is thrown through C.
template <class Body>
std::int32_t guarded(const Body& body) noexcept {
  try {
    body();
    return CALX_SIM_OK;
  } catch (const Error& e) {
    return failed(e.exit_code(), e.what());
  } catch (const std::bad_alloc&) {
    return failed(CALX_SIM_NUMERICS, "out of memory");
  } catch (const std::exception& e) {
    return failed(CALX_SIM_INTERNAL, std::string("a fault of calx itself, please report it: ") + e.what());
  } catch (...) {
    return failed(CALX_SIM_INTERNAL, "a fault of calx itself, please report it");
  }
}

/// Throws Error(Fault::usage).
[[noreturn]] inline void misused(const std::string& message) { throw Error(Fault::usage, message); }

template <class T>
T& needed(T* pointer, const char* function, const char* what) {
  if (!pointer) misused(std::string(function) + ": " + what + " is null");
  return *pointer;
}

}  // namespace calx
