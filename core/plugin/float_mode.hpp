// float_mode.hpp: the rounding mode and the treatment of denormal numbers of the calling thread.
// A library linked with -ffast-math turns on flush-to-zero for the whole process when it loads (measured: MXCSR 0x1f80
// becomes 0x9fc0), which would change the results of every other plugin; the loader looks for that.
#pragma once
#include <cfenv>
#include <cstdint>
#include <cstdio>
#include <string>
#if defined(__x86_64__)
#include <xmmintrin.h>
#endif

namespace calx {

class FloatMode {
 public:
  static FloatMode now() {
    FloatMode mode;
    mode.rounding_ = std::fegetround();
#if defined(__x86_64__)
    mode.control_ = _mm_getcsr() & ~0x3fu;  // the low six bits are sticky exception flags, not a mode
#elif defined(__aarch64__)
    std::uint64_t fpcr;
    asm volatile("mrs %0, fpcr" : "=r"(fpcr));
    mode.control_ = static_cast<std::uint32_t>(fpcr);
#endif
    return mode;
  }
  void restore() const {
    std::fesetround(rounding_);
#if defined(__x86_64__)
    _mm_setcsr(control_);
#elif defined(__aarch64__)
    const std::uint64_t fpcr = control_;
    asm volatile("msr fpcr, %0" : : "r"(fpcr));
#endif
  }
  bool operator==(const FloatMode& other) const { return rounding_ == other.rounding_ && control_ == other.control_; }
  bool operator!=(const FloatMode& other) const { return !(*this == other); }
  /// "MXCSR 0x1f80" on x86-64, "FPCR 0x0" on AArch64.
  std::string text() const {
#if defined(__x86_64__)
    const char* form = "MXCSR 0x%x";
#elif defined(__aarch64__)
    const char* form = "FPCR 0x%x";
#else
    const char* form = "control word 0x%x";
#endif
    char out[32];
    std::snprintf(out, sizeof out, form, static_cast<unsigned>(control_));
    return out;
  }

 private:
  int rounding_ = 0;
  std::uint32_t control_ = 0;
};

}  // namespace calx
