// host.hpp: what a plugin sees of Calx: the host table and the extensions behind it. For core/plugin and
// core/conformance. One host per loaded library and registry, so messages and log lines are known to come from that
// library.
#pragma once
#include <mutex>
#include <string>
#include <vector>

#include "calx/all.h"

namespace calx {

/// Ids of the extensions this host offers, for checks before anything is loaded.
const std::vector<std::string>& host_extensions();

/// "CALX_E_CONFIG", or the number of an unknown status.
std::string status_name(calx_status status);

class Host {
 public:
  explicit Host(const std::string& speaker);  // speaker: stands before each log line of the plugin
  Host(const Host&) = delete;
  Host& operator=(const Host&) = delete;
  const calx_host* table() const { return &table_; }
  /// Log lines of the plugin are dropped from now on.
  void be_silent() { silent_ = true; }
  /// The message the plugin left for that status since the last call, or "no message"; forgets it.
  std::string take_message(calx_status status);

 private:
  static const void* CALX_CALL get_extension(const calx_host* host, const char* id) noexcept;
  static calx_status CALX_CALL fail(const calx_host* host, calx_status code, const char* message) noexcept;
  static void CALX_CALL log(const calx_host* host, std::int32_t level, const char* text) noexcept;

  calx_host table_;
  std::string speaker_;
  bool silent_ = false;
  std::mutex mutex_;
  calx_status status_ = CALX_OK;
  std::string message_;
};

}  // namespace calx
