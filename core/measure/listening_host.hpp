// listening_host.hpp: a host for sensor plugins that keeps what they complain about. Private to this module.
#pragma once
#include <string>

#include "calx/abi.h"

namespace calx {

/// A host that keeps the message of fail() and passes everything else on to the real one. The base comes first, so that
/// the pointer the plugin hands back leads here.
struct ListeningHost {
  calx_host base;
  const calx_host* real;
  mutable std::string message;

  explicit ListeningHost(const calx_host* host) : base(*host), real(host) {
    base.struct_size = sizeof(calx_host);
    base.get_extension = &ListeningHost::get_extension;
    base.fail = &ListeningHost::fail;
  }
  static const void* CALX_CALL get_extension(const calx_host* host, const char* id) noexcept {
    const calx_host* real = reinterpret_cast<const ListeningHost*>(host)->real;
    return real->get_extension(real, id);
  }
  static calx_status CALX_CALL fail(const calx_host* host, calx_status code, const char* text) noexcept {
    try {
      reinterpret_cast<const ListeningHost*>(host)->message = text ? text : "";
    } catch (...) {  // no memory for the message: the status alone must do
    }
    return code;
  }
};

}  // namespace calx
