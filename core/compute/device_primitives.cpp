// device_primitives.cpp: scans and reductions on a device: the launches of core/kernels/primitives.h level by level.
#include <map>

#include "base/error.hpp"
#include "compute/device.hpp"

namespace calx {
namespace {

/// CALX_RUN of primitives.h.
constexpr std::size_t kRun = 64;

std::size_t runs(std::size_t n) { return (n + kRun - 1) / kRun; }

/// Work space for n entries of up to 8 bytes: sums of runs and what comes before them, for all levels.
std::size_t work_bytes(std::size_t n) {
  std::size_t bytes = 16;
  for (std::size_t level = runs(n); level > 1; level = runs(level)) bytes += (2 * level + 1) * 8;
  return bytes;
}

std::uint32_t u32(std::size_t value) { return static_cast<std::uint32_t>(value); }

}  // namespace

struct Device::Primitives {
  DeviceModule module;
  std::map<std::string, DeviceKernel> kernels;
  std::shared_ptr<DeviceBuffer> work;

  const DeviceKernel& kernel(const std::string& name) {
    DeviceKernel& known = kernels[name];
    if (!known) known = module.kernel(name);
    return known;
  }
};

void Device::reserve(std::size_t n) {
  if (n > 0xffffffffu - 1023u)
    throw Error(Fault::settings, "a scan or reduction of " + std::to_string(n) + " entries; at most 2^32 - 1024");
  if (!primitives_) {
    ModuleText text;
    text.label = "scans and reductions";
    text.add("primitives.h");
    auto made = std::make_shared<Primitives>();
    made->module = build(text);
    primitives_ = std::move(made);
  }
  // A graph keeps the work space that it was recorded with.
  if (!primitives_->work || primitives_->work->bytes() < work_bytes(n))
    primitives_->work = std::make_shared<DeviceBuffer>(allocate(work_bytes(n)));
  if (capturing_) kept_.push_back(primitives_->work);
}

void Device::exclusive_scan(const DeviceBuffer& in, const DeviceBuffer& out, std::size_t n) {
  if (in.bytes() < 4 * n || out.bytes() < 4 * (n + 1) || in.memory() == out.memory())
    throw Error(Fault::numerics, "a scan of " + std::to_string(n) + " entries needs buffers of " +
                                     std::to_string(4 * n) + " and " + std::to_string(4 * (n + 1)) +
                                     " bytes, not the same; it got " + std::to_string(in.bytes()) + " and " +
                                     std::to_string(out.bytes()));
  if (n == 0) return zero(out, 4);
  reserve(n);
  Primitives& p = *primitives_;
  struct Level {
    const DeviceBuffer* sums;
    std::size_t first, n;
    const DeviceBuffer* offsets;
    std::size_t offsets_first;
  };
  std::vector<Level> levels = {{&in, 0, n, &out, 0}};
  for (std::size_t end = 0; levels.back().n > kRun;) {
    const Level below = levels.back();
    const std::size_t count = runs(below.n);
    levels.push_back({p.work.get(), end, count, p.work.get(), end + count});
    end += 2 * count + 1;
    launch(p.kernel("scan_sums"), count,
           arguments(*below.sums, u32(below.first), *p.work, u32(levels.back().first), u32(below.n), u32(count)));
  }
  for (std::size_t k = levels.size(); k-- > 0;) {
    const Level& level = levels[k];
    const std::size_t before = k + 1 < levels.size() ? levels[k + 1].offsets_first : 0;
    const std::size_t count = runs(level.n);
    launch(p.kernel("scan_write"), count,
           arguments(*level.sums, u32(level.first), *p.work, u32(before), *level.offsets, u32(level.offsets_first),
                     u32(level.n), u32(count)));
  }
}

void Device::reduce(Reduction what, const char* suffix, std::size_t size, const DeviceBuffer& in, std::size_t n,
                    const DeviceBuffer& out, std::size_t out_index) {
  if (in.bytes() < size * n || out.bytes() < size * (out_index + 1))
    throw Error(Fault::numerics, "a reduction of " + std::to_string(n) + " entries needs buffers of " +
                                     std::to_string(size * n) + " and " + std::to_string(size * (out_index + 1)) +
                                     " bytes; it got " + std::to_string(in.bytes()) + " and " +
                                     std::to_string(out.bytes()));
  if (n == 0) return zero(out, size, size * out_index);
  reserve(n);
  Primitives& p = *primitives_;
  const char* name = what == Reduction::sum        ? "reduce_sum"
                     : what == Reduction::smallest ? "reduce_smallest"
                                                   : "reduce_largest";
  const DeviceKernel& kernel = p.kernel(std::string(name) + suffix);
  const DeviceBuffer* from = &in;
  std::size_t first = 0, end = 0;
  for (std::size_t count = n; count > 1 || from == &in;) {
    const std::size_t items = runs(count);
    const bool last = items == 1;
    launch(kernel, items,
           arguments(*from, u32(first), last ? out : *p.work, u32(last ? out_index : end), u32(count), u32(items)));
    if (last) return;
    from = p.work.get();
    first = end;
    end += items;
    count = items;
  }
}

template <>
void Device::reduce<float>(Reduction what, const DeviceBuffer& in, std::size_t n, const DeviceBuffer& out,
                           std::size_t out_index) {
  reduce(what, "_f32", 4, in, n, out, out_index);
}
template <>
void Device::reduce<double>(Reduction what, const DeviceBuffer& in, std::size_t n, const DeviceBuffer& out,
                            std::size_t out_index) {
  reduce(what, "_f64", 8, in, n, out, out_index);
}
template <>
void Device::reduce<std::uint32_t>(Reduction what, const DeviceBuffer& in, std::size_t n, const DeviceBuffer& out,
                                   std::size_t out_index) {
  reduce(what, "_u32", 4, in, n, out, out_index);
}

}  // namespace calx
