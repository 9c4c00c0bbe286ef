/* Writes into the run's log when created. */
#define BAD_ID "test.speaks"
#include <calx/host_log.h>
#define BAD_CREATE                                                                                     \
  {                                                                                                    \
    const calx_host_log* log = (const calx_host_log*)host->get_extension(host, CALX_HOST_LOG);         \
    log->write(host, CALX_LOG_WARNING, host->get_extension(host, "calx.host.log/12") ? "?" : "hello"); \
    *out = &the_instance;                                                                              \
    return CALX_OK;                                                                                    \
  }
#include "bad_plugin.h"
