// error.hpp: the one exception of the engine, raised during set-up and between steps, never inside a kernel.
// A message says what failed; where (file and JSON pointer, plugin id, particle, time); the value; what would be right.
#pragma once
#include <stdexcept>
#include <string>

namespace calx {

/// The exit code of the command line for each kind of failure.
enum class Fault { usage = 2, settings = 3, plugin = 4, numerics = 5, files = 6, interrupted = 130 };

class Error : public std::runtime_error {
 public:
  Error(Fault fault, const std::string& message) : std::runtime_error(message), fault_(fault) {}
  Fault fault() const { return fault_; }
  int exit_code() const { return static_cast<int>(fault_); }

 private:
  Fault fault_;
};

}  // namespace calx
