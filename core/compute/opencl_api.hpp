// opencl_api.hpp: the part of OpenCL 1.2 that is used here, declared anew, so that neither its headers nor its loader
// are needed to build. Names, values and signatures are those of the Khronos specification, OpenCL 1.2, chapters 4
// and 5.
#pragma once
#include <cstddef>
#include <cstdint>

#include "compute/device_library.hpp"

namespace calx {

using cl_int = std::int32_t;
using cl_uint = std::uint32_t;
using cl_ulong = std::uint64_t;
using cl_platform_id = struct ClPlatform*;
using cl_device_id = struct ClDeviceId*;
using cl_context = struct ClContext*;
using cl_command_queue = struct ClQueue*;
using cl_mem = struct ClMem*;
using cl_program = struct ClProgram*;
using cl_kernel = struct ClKernelObject*;
using cl_event = struct ClEvent*;

constexpr cl_int CL_MEM_OBJECT_ALLOCATION_FAILURE = -4, CL_OUT_OF_RESOURCES = -5, CL_OUT_OF_HOST_MEMORY = -6,
                 CL_INVALID_BUFFER_SIZE = -61;
constexpr cl_ulong CL_DEVICE_TYPE_ALL = 0xFFFFFFFF, CL_MEM_READ_WRITE = 1;
constexpr cl_ulong CL_FP_DENORM = 1, CL_FP_ROUND_TO_NEAREST = 4, CL_FP_CORRECTLY_ROUNDED_DIVIDE_SQRT = 128;
constexpr cl_uint CL_PLATFORM_NAME = 0x0902, CL_DEVICE_SINGLE_FP_CONFIG = 0x101B, CL_DEVICE_MAX_MEM_ALLOC_SIZE = 0x1010,
                  CL_DEVICE_GLOBAL_MEM_SIZE = 0x101F, CL_DEVICE_NAME = 0x102B, CL_DEVICE_VERSION = 0x102F,
                  CL_DRIVER_VERSION = 0x102D, CL_DEVICE_DOUBLE_FP_CONFIG = 0x1032, CL_PROGRAM_BUILD_LOG = 0x1183,
                  CL_KERNEL_NUM_ARGS = 0x1191, CL_KERNEL_ARG_ADDRESS_QUALIFIER = 0x1196,
                  CL_KERNEL_ARG_ADDRESS_GLOBAL = 0x119B, CL_KERNEL_ARG_TYPE_NAME = 0x1198,
                  CL_KERNEL_WORK_GROUP_SIZE = 0x11B0, CL_EVENT_COMMAND_EXECUTION_STATUS = 0x11D3;

#define CALX_OPENCL_FUNCTIONS(X)                                                                                       \
  X(clGetPlatformIDs, cl_uint, cl_platform_id*, cl_uint*)                                                              \
  X(clGetPlatformInfo, cl_platform_id, cl_uint, std::size_t, void*, std::size_t*)                                      \
  X(clGetDeviceIDs, cl_platform_id, cl_ulong, cl_uint, cl_device_id*, cl_uint*)                                        \
  X(clGetDeviceInfo, cl_device_id, cl_uint, std::size_t, void*, std::size_t*)                                          \
  X(clReleaseContext, cl_context)                                                                                      \
  X(clReleaseCommandQueue, cl_command_queue)                                                                           \
  X(clReleaseMemObject, cl_mem)                                                                                        \
  X(clReleaseProgram, cl_program)                                                                                      \
  X(clReleaseKernel, cl_kernel)                                                                                        \
  X(clReleaseEvent, cl_event)                                                                                          \
  X(clEnqueueWriteBuffer, cl_command_queue, cl_mem, cl_uint, std::size_t, std::size_t, const void*, cl_uint,           \
    const cl_event*, cl_event*)                                                                                        \
  X(clEnqueueReadBuffer, cl_command_queue, cl_mem, cl_uint, std::size_t, std::size_t, void*, cl_uint, const cl_event*, \
    cl_event*)                                                                                                         \
  X(clEnqueueCopyBuffer, cl_command_queue, cl_mem, cl_mem, std::size_t, std::size_t, std::size_t, cl_uint,             \
    const cl_event*, cl_event*)                                                                                        \
  X(clEnqueueFillBuffer, cl_command_queue, cl_mem, const void*, std::size_t, std::size_t, std::size_t, cl_uint,        \
    const cl_event*, cl_event*)                                                                                        \
  X(clEnqueueNDRangeKernel, cl_command_queue, cl_kernel, cl_uint, const std::size_t*, const std::size_t*,              \
    const std::size_t*, cl_uint, const cl_event*, cl_event*)                                                           \
  X(clBuildProgram, cl_program, cl_uint, const cl_device_id*, const char*, void (*)(cl_program, void*), void*)         \
  X(clGetProgramBuildInfo, cl_program, cl_device_id, cl_uint, std::size_t, void*, std::size_t*)                        \
  X(clSetKernelArg, cl_kernel, cl_uint, std::size_t, const void*)                                                      \
  X(clGetKernelInfo, cl_kernel, cl_uint, std::size_t, void*, std::size_t*)                                             \
  X(clGetKernelArgInfo, cl_kernel, cl_uint, cl_uint, std::size_t, void*, std::size_t*)                                 \
  X(clGetKernelWorkGroupInfo, cl_kernel, cl_device_id, cl_uint, std::size_t, void*, std::size_t*)                      \
  X(clWaitForEvents, cl_uint, const cl_event*)                                                                         \
  X(clGetEventInfo, cl_event, cl_uint, std::size_t, void*, std::size_t*)                                               \
  X(clFlush, cl_command_queue)                                                                                         \
  X(clFinish, cl_command_queue)

struct OpenCl {
  DeviceLibrary library;
#define CALX_DECLARE(name, ...) cl_int (*name)(__VA_ARGS__) = nullptr;
  CALX_OPENCL_FUNCTIONS(CALX_DECLARE)
#undef CALX_DECLARE
  cl_context (*clCreateContext)(const std::intptr_t*, cl_uint, const cl_device_id*,
                                void (*)(const char*, const void*, std::size_t, void*), void*, cl_int*) = nullptr;
  cl_command_queue (*clCreateCommandQueue)(cl_context, cl_device_id, cl_ulong, cl_int*) = nullptr;
  cl_mem (*clCreateBuffer)(cl_context, cl_ulong, std::size_t, void*, cl_int*) = nullptr;
  cl_program (*clCreateProgramWithSource)(cl_context, cl_uint, const char**, const std::size_t*, cl_int*) = nullptr;
  cl_kernel (*clCreateKernel)(cl_program, const char*, cl_int*) = nullptr;
};

/// The loader, opened at the first call: $CALX_LIBOPENCL, else libOpenCL.so.1. Throws Error(Fault::usage). [any]
const OpenCl& opencl();

/// "CL_INVALID_BUFFER_SIZE (-61)".
std::string opencl_error(cl_int code);

}  // namespace calx
