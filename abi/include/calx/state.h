/* SPDX-License-Identifier: MIT
 * calx/state.h: hidden state of an instance for checkpoints, "calx.state/1"; optional on any instance. C99, C++98.
 * What a table declares is saved by the host; only hidden state (a controller, a random stream) needs this. */
#ifndef CALX_STATE_H
#define CALX_STATE_H
#include "abi.h"

#ifdef __cplusplus
extern "C" {
#endif

#define CALX_STATE "calx.state/1"

typedef struct calx_stream calx_stream;
struct calx_stream {
  uint32_t struct_size, reserved;
  void* self;
  int64_t(CALX_CALL* write)(const calx_stream* stream, const void* bytes, uint64_t size); /* bytes written or < 0 */
  int64_t(CALX_CALL* read)(const calx_stream* stream, void* bytes, uint64_t size); /* may be short; 0 at the end */
};

typedef struct calx_state {
  uint32_t struct_size, draft;
  uint32_t schema, reserved; /* version of the bytes that save writes; little-endian */
  calx_status(CALX_CALL* save)(const calx_instance* self, const calx_stream* stream);                  /* [main] */
  calx_status(CALX_CALL* load)(calx_instance* self, const calx_stream* stream, uint32_t schema);       /* [main] */
} calx_state;

#ifdef __cplusplus
}
#endif
#endif
