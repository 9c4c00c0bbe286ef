// cuda_api.hpp: the part of the CUDA driver interface and of NVRTC that is used here, declared anew, so that neither a
// header nor a library of CUDA is needed to build. Names, values and signatures are those of NVIDIA's documentation,
// CUDA 11.4 and newer.
#pragma once
#include <cstddef>
#include <cstdint>

#include "compute/device_library.hpp"

namespace calx {

using CUresult = int;
using CUdevice = int;
using CUdeviceptr = unsigned long long;
using CUcontext = struct CuContextPart*;
using CUmodule = struct CuModulePart*;
using CUfunction = struct CuFunctionPart*;
using CUstream = struct CuStreamPart*;
using CUevent = struct CuEventPart*;
using CUgraph = struct CuGraphPart*;
using CUgraphExec = struct CuGraphExecPart*;
using nvrtcProgram = struct NvrtcProgramPart*;

constexpr CUresult CUDA_ERROR_OUT_OF_MEMORY = 2, CUDA_ERROR_NOT_FOUND = 500, CUDA_ERROR_NOT_READY = 600;
constexpr int CU_DEVICE_ATTRIBUTE_COMPUTE_CAPABILITY_MAJOR = 75, CU_DEVICE_ATTRIBUTE_COMPUTE_CAPABILITY_MINOR = 76;
constexpr int CU_FUNC_ATTRIBUTE_MAX_THREADS_PER_BLOCK = 0;
constexpr unsigned CU_STREAM_NON_BLOCKING = 1, CU_EVENT_DISABLE_TIMING = 2;
constexpr int CU_STREAM_CAPTURE_MODE_RELAXED = 2;

#define CALX_CUDA_FUNCTIONS(X)                                                                                  \
  X(cuInit, unsigned)                                                                                           \
  X(cuDriverGetVersion, int*)                                                                                   \
  X(cuDeviceGetCount, int*)                                                                                     \
  X(cuDeviceGet, CUdevice*, int)                                                                                \
  X(cuDeviceGetName, char*, int, CUdevice)                                                                      \
  X(cuDeviceGetAttribute, int*, int, CUdevice)                                                                  \
  X(cuDeviceTotalMem_v2, std::size_t*, CUdevice)                                                                \
  X(cuDevicePrimaryCtxRetain, CUcontext*, CUdevice)                                                             \
  X(cuDevicePrimaryCtxRelease_v2, CUdevice)                                                                     \
  X(cuCtxSetCurrent, CUcontext)                                                                                 \
  X(cuMemGetInfo_v2, std::size_t*, std::size_t*)                                                                \
  X(cuMemAlloc_v2, CUdeviceptr*, std::size_t)                                                                   \
  X(cuMemFree_v2, CUdeviceptr)                                                                                  \
  X(cuMemAllocHost_v2, void**, std::size_t)                                                                     \
  X(cuMemFreeHost, void*)                                                                                       \
  X(cuMemcpyHtoDAsync_v2, CUdeviceptr, const void*, std::size_t, CUstream)                                      \
  X(cuMemcpyDtoHAsync_v2, void*, CUdeviceptr, std::size_t, CUstream)                                            \
  X(cuMemcpyDtoDAsync_v2, CUdeviceptr, CUdeviceptr, std::size_t, CUstream)                                      \
  X(cuMemsetD8Async, CUdeviceptr, unsigned char, std::size_t, CUstream)                                         \
  X(cuModuleLoadData, CUmodule*, const void*)                                                                   \
  X(cuModuleUnload, CUmodule)                                                                                   \
  X(cuModuleGetFunction, CUfunction*, CUmodule, const char*)                                                    \
  X(cuFuncGetAttribute, int*, int, CUfunction)                                                                  \
  X(cuLaunchKernel, CUfunction, unsigned, unsigned, unsigned, unsigned, unsigned, unsigned, unsigned, CUstream, \
    void**, void**)                                                                                             \
  X(cuStreamCreate, CUstream*, unsigned)                                                                        \
  X(cuStreamDestroy_v2, CUstream)                                                                               \
  X(cuStreamSynchronize, CUstream)                                                                              \
  X(cuStreamBeginCapture_v2, CUstream, int)                                                                     \
  X(cuStreamEndCapture, CUstream, CUgraph*)                                                                     \
  X(cuGraphInstantiateWithFlags, CUgraphExec*, CUgraph, unsigned long long)                                     \
  X(cuGraphLaunch, CUgraphExec, CUstream)                                                                       \
  X(cuGraphExecDestroy, CUgraphExec)                                                                            \
  X(cuGraphDestroy, CUgraph)                                                                                    \
  X(cuEventCreate, CUevent*, unsigned)                                                                          \
  X(cuEventRecord, CUevent, CUstream)                                                                           \
  X(cuEventQuery, CUevent)                                                                                      \
  X(cuEventSynchronize, CUevent)                                                                                \
  X(cuEventDestroy_v2, CUevent)                                                                                 \
  X(cuGetErrorName, CUresult, const char**)                                                                     \
  X(cuGetErrorString, CUresult, const char**)

#define CALX_NVRTC_FUNCTIONS(X)                                                                               \
  X(nvrtcVersion, int*, int*)                                                                                 \
  X(nvrtcCreateProgram, nvrtcProgram*, const char*, const char*, int, const char* const*, const char* const*) \
  X(nvrtcCompileProgram, nvrtcProgram, int, const char* const*)                                               \
  X(nvrtcDestroyProgram, nvrtcProgram*)                                                                       \
  X(nvrtcGetProgramLogSize, nvrtcProgram, std::size_t*)                                                       \
  X(nvrtcGetProgramLog, nvrtcProgram, char*)                                                                  \
  X(nvrtcGetCUBINSize, nvrtcProgram, std::size_t*)                                                            \
  X(nvrtcGetCUBIN, nvrtcProgram, char*)

#define CALX_DECLARE(name, ...) int (*name)(__VA_ARGS__) = nullptr;
struct CudaDriver {
  DeviceLibrary library;
  int version = 0;  // 12040 is 12.4
  CALX_CUDA_FUNCTIONS(CALX_DECLARE)
  /// Since 12.4; null in older drivers.
  CUresult (*cuFuncGetParamInfo)(CUfunction, std::size_t, std::size_t*, std::size_t*) = nullptr;
  /// "CUDA_ERROR_OUT_OF_MEMORY: out of memory".
  std::string error(CUresult code) const;
};
struct Nvrtc {
  DeviceLibrary library;
  int major = 0, minor = 0;
  CALX_NVRTC_FUNCTIONS(CALX_DECLARE)
};
#undef CALX_DECLARE

/// Opened and initialised at the first call: $CALX_LIBCUDA, else libcuda.so.1. Throws Error(Fault::usage). A stand-in
/// must have another name than libcuda.so.1, which NVRTC opens by itself. [any]
const CudaDriver& cuda_driver();
/// $CALX_LIBNVRTC, else by name, then below $CUDA_HOME and /usr/local/cuda. Throws Error(Fault::usage). [any]
const Nvrtc& nvrtc();

}  // namespace calx
