/* SPDX-License-Identifier: MIT
 * calx/host_log.h: a line in the run's log, host extension "calx.host.log/1". C99 and C++98. */
#ifndef CALX_HOST_LOG_H
#define CALX_HOST_LOG_H
#include "abi.h"

#ifdef __cplusplus
extern "C" {
#endif

#define CALX_HOST_LOG "calx.host.log/1"
#define CALX_LOG_INFO 0
#define CALX_LOG_WARNING 1

typedef struct calx_host_log {
  uint32_t struct_size, reserved;
  void(CALX_CALL* write)(const calx_host* host, int32_t level, const char* text); /* [any] */
} calx_host_log;

#ifdef __cplusplus
}
#endif
#endif
