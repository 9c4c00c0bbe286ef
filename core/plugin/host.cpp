#include "plugin/host.hpp"

#include <cstring>

#include "base/log.hpp"

#ifndef CALX_VERSION
#define CALX_VERSION "0.1.0"
#endif

namespace calx {

const std::vector<std::string>& host_extensions() {
  static const std::vector<std::string> ids = {CALX_HOST_LOG};
  return ids;
}

std::string status_name(calx_status status) {
  switch (status) {
    case CALX_OK:
      return "CALX_OK";
    case CALX_E_UNSUPPORTED:
      return "CALX_E_UNSUPPORTED";
    case CALX_E_ARGUMENT:
      return "CALX_E_ARGUMENT";
    case CALX_E_CONFIG:
      return "CALX_E_CONFIG";
    case CALX_E_MEMORY:
      return "CALX_E_MEMORY";
    case CALX_E_IO:
      return "CALX_E_IO";
    case CALX_E_STATE:
      return "CALX_E_STATE";
    case CALX_E_VERSION:
      return "CALX_E_VERSION";
    case CALX_E_INTERNAL:
      return "CALX_E_INTERNAL";
    default:
      return "status " + std::to_string(status);
  }
}

Host::Host(const std::string& speaker)
    : table_{sizeof(calx_host), CALX_ABI_MAJOR, CALX_ABI_MINOR, this, "calx", CALX_VERSION, &get_extension, &fail},
      speaker_(speaker) {}

std::string Host::take_message(calx_status status) {
  const std::lock_guard<std::mutex> lock(mutex_);
  std::string out = status_ == status && !message_.empty() ? message_ : "no message";
  status_ = CALX_OK;
  message_.clear();
  return out;
}

const void* Host::get_extension(const calx_host*, const char* id) noexcept {
  static const calx_host_log log_table = {sizeof(calx_host_log), 0, &log};
  return id && std::strcmp(id, CALX_HOST_LOG) == 0 ? &log_table : nullptr;
}

calx_status Host::fail(const calx_host* host, calx_status code, const char* message) noexcept {
  if (!host) return code;
  Host& self = *static_cast<Host*>(host->self);
  try {
    const std::lock_guard<std::mutex> lock(self.mutex_);
    self.status_ = code;
    self.message_ = message ? message : "";
  } catch (...) {  // no memory for the message: the status alone must do
  }
  return code;
}

void Host::log(const calx_host* host, std::int32_t level, const char* text) noexcept {
  if (!host || !text || static_cast<Host*>(host->self)->silent_) return;
  try {
    const std::string line = static_cast<Host*>(host->self)->speaker_ + ": " + text;
    log_line(level >= CALX_LOG_WARNING ? LogLevel::warning : LogLevel::info, line);
  } catch (...) {  // as above
  }
}

}  // namespace calx
