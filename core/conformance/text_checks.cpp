// text_checks.cpp: the text of a law or a force: dialect, and the same numbers as its native code on devices.
#include <cmath>
#include <cstring>
#include <filesystem>
#include <functional>

#include "base/error.hpp"
#include "compute/cuda_compile.hpp"
#include "compute/device.hpp"
#include "compute/force_text.hpp"
#include "compute/law_text.hpp"
#include "conformance/checks.hpp"
#include "conformance/force_rig.hpp"
#include "conformance/law_rig.hpp"
#include "plugin/law_lint.hpp"

namespace calx::conformance {
namespace {

struct Text {
  std::string source, symbol, sha256;
};

/// Throws Skipped where the plugin can have no text or brings none.
Text text_of(const PluginInstance& instance) {
  Text text;
  if (const auto* law = static_cast<const calx_contact_law*>(instance.table(CALX_CONTACT_LAW))) {
    if (law->source) text = {std::string(law->source, law->source_size), law->symbol, law->source_sha256};
  } else if (const auto* force = static_cast<const calx_particle_force*>(instance.table(CALX_PARTICLE_FORCE))) {
    if (force->source) text = {std::string(force->source, force->source_size), force->symbol, force->source_sha256};
  } else {
    throw Skipped{"only laws and forces have a text"};
  }
  if (text.source.empty()) throw Skipped{"it brings no text; its cases stay on the processor"};
  return text;
}

std::string text_dialect(Subject& s) {
  const Text text = text_of(*s.any());
  // The stem of the file is not in the table: what the symbols of all its laws have in common begins with it.
  std::string stem = text.symbol;
  for (std::size_t at = 0; (at = text.source.find("_DECLARE", at)) != std::string::npos; ++at) {
    const std::size_t open = text.source.find('(', at);
    if (open == std::string::npos) break;
    const std::string symbol = text.source.substr(open + 1, text.source.find_first_of(",)", open) - open - 1);
    std::size_t common = 0;
    while (common < stem.size() && common < symbol.size() && stem[common] == symbol[common]) ++common;
    stem.resize(common);
  }
  // Cut inside of a word: "epam_n" of epam_n1 and epam_n15.
  if (stem != text.symbol && text.symbol[stem.size()] != '_')
    stem.resize(stem.rfind('_') == std::string::npos ? 0 : stem.rfind('_'));
  require(!stem.empty(), "its symbol \"" + text.symbol + "\" is not that of the law declared in its text");
  std::vector<LintFinding> findings = lint_law(text.source, stem);
  require(findings.empty(), lint_text(findings, text.symbol));
  return std::to_string(text.source.size()) + " bytes";
}

/// A law list of one term, as the host makes them.
LawList list_of(const LawRig& rig) {
  LawList list;
  list.terms.resize(1);
  list.terms[0].table = &rig.table();
  list.terms[0].id = rig.law().id();
  list.terms[0].pair_row = rig.pair();
  list.preset = rig.law().new_history();
  list.state_count = rig.table().state_count;
  return list;
}

constexpr const char* kLawKernel = R"(
KERNEL(CALX_ID(check_law), u32 count, double dt, GLOBAL const double* RESTRICT in, GLOBAL double* RESTRICT history,
       GLOBAL const double* RESTRICT numbers, GLOBAL double* RESTRICT out) {
  const u32 k = ITEM;
  if (k >= count) return;
  const u64 n = count;
  CALX_ID(calx_contact) c;
  CALX_ID(calx_wrench) w;
  c.overlap = (real)in[k];
  c.nx = (real)in[n + k];
  c.ny = (real)in[2 * n + k];
  c.nz = (real)in[3 * n + k];
  c.vx = (real)in[4 * n + k];
  c.vy = (real)in[5 * n + k];
  c.vz = (real)in[6 * n + k];
  c.wx = (real)in[7 * n + k];
  c.wy = (real)in[8 * n + k];
  c.wz = (real)in[9 * n + k];
  c.r_eff = (real)in[10 * n + k];
  c.m_eff = (real)in[11 * n + k];
  c.r_i = (real)in[12 * n + k];
  c.r_j = (real)in[13 * n + k];
  c.fn_before = R(0.0);
  c.dt = (real)dt;
  CALX_ID(calx_contact_laws)(0u, &c, history + k, n, 0u, numbers, &w);
  out[k] = w.fx;
  out[n + k] = w.fy;
  out[2 * n + k] = w.fz;
  out[3 * n + k] = w.mx;
  out[4 * n + k] = w.my;
  out[5 * n + k] = w.mz;
  out[6 * n + k] = w.elastic;
  out[7 * n + k] = w.friction;
  out[8 * n + k] = w.damping;
  out[9 * n + k] = w.plastic;
}
)";

ModuleText law_module(const LawProgram& program, bool both) {
  ModuleText module;
  module.label = "plugin check";
  for (const int bits : {64, 32}) {
    if (bits == 32 && !both) continue;
    module.add_laws(bits, program.laws);
    module.add("laws", program.text);
    module.add("check", kLawKernel);
  }
  return module;
}

std::unique_ptr<Device> open(const std::string& kind) {
  try {
    return open_device(kind);
  } catch (const Error& e) {
    throw Skipped{e.what()};
  }
}

/// Bits, or for a law that is not exact a relative error that a different square root or sine may make.
bool near(double a, double b, bool exact, bool single) {
  if (exact) return std::memcmp(&a, &b, sizeof a) == 0 || (a == 0 && b == 0);
  return std::fabs(a - b) <= (single ? 1e-4 : 1e-11) * std::max(std::fabs(a), std::fabs(b)) + 1e-300;
}

template <class Real>
void compare_law(Subject& s, Device& device, const DeviceModule& module, const LawRig& rig, const LawProgram& program) {
  constexpr std::size_t n = 500;
  const bool single = sizeof(Real) == 4;
  const std::uint32_t states = rig.table().state_count;
  const std::vector<Contact> rows = rig.contacts(s, n);
  Evaluated native;
  native.state = rig.fresh(n);
  std::vector<double> in(CALX_IN_COUNT * n), history(std::max(1u, states) * n);
  for (std::size_t r = 0; r < n; ++r) {
    for (std::size_t k = 0; k < CALX_IN_COUNT; ++k) in[k * n + r] = rows[r].in[k];
    for (std::size_t k = 0; k < states; ++k) history[k * n + r] = native.state[r * states + k];
  }
  const DeviceBuffer inputs = device.upload(in), memory = device.upload(history),
                     numbers = device.upload(program.numbers),
                     outputs = device.allocate(CALX_OUT_COUNT * n * sizeof(double));
  const DeviceKernel kernel = module.kernel(single ? "check_law_f32" : "check_law_f64");
  for (int step = 0; step < 5; ++step) {
    native = rig.evaluate<Real>(rows, native.state);
    device.launch(kernel, n, arguments(static_cast<std::uint32_t>(n), rig.dt(), inputs, memory, numbers, outputs));
  }
  const std::vector<double> out = device.download<double>(outputs, CALX_OUT_COUNT * n);
  const std::vector<double> state = device.download<double>(memory, std::max(1u, states) * n);
  static const char* const names[] = {"fx", "fy", "fz", "mx", "my", "mz", "elastic", "friction", "damping", "plastic"};
  const std::string where = rig.name() + ", " + (single ? "single" : "double") + " precision: ";
  for (std::size_t r = 0; r < n; ++r) {
    for (std::size_t k = 0; k < CALX_OUT_COUNT; ++k) {
      const double a = native.out[r * CALX_OUT_COUNT + k], b = out[k * n + r];
      require(near(a, b, rig.law().is_exact(), single),
              where + names[k] + " is " + short_number(a) + " natively and " + short_number(b) + " from the text (" +
                  short_number(std::fabs(a - b)) +
                  " apart); is the text the one that was compiled, and does NEEDS name all " + "it reads?");
    }
    for (std::size_t k = 0; k < states; ++k)
      require(near(native.state[r * states + k], state[k * n + r], rig.law().is_exact(), single),
              where + "history \"" + rig.table().state[k].name + "\" differs between native code and text");
  }
}

void compare_force(Subject& s, Device& device, const ForceRig& rig) {
  ForceProgram program = force_program({{&rig.table(), rig.instance(), rig.name()}});
  if (program.numbers.empty()) program.numbers.push_back(0);  // a device has no empty buffer
  ModuleText module;
  module.label = "plugin check";
  module.add_laws(64, program.forces);
  module.add("forces", program.text);
  module.add("check", R"(
KERNEL(check_force, u32 count, double dt, double time, GLOBAL const double* RESTRICT in,
       GLOBAL const double* RESTRICT numbers, GLOBAL double* RESTRICT out) {
  const u32 k = ITEM;
  if (k >= count) return;
  const u64 n = count;
  calx_body_f64 b;
  calx_wrench_f64 w;
  b.x = in[k];
  b.y = in[n + k];
  b.z = in[2 * n + k];
  b.vx = in[3 * n + k];
  b.vy = in[4 * n + k];
  b.vz = in[5 * n + k];
  b.wx = in[6 * n + k];
  b.wy = in[7 * n + k];
  b.wz = in[8 * n + k];
  b.mass = in[9 * n + k];
  b.radius = in[10 * n + k];
  b.dt = dt;
  b.time = time;
  w.fx = w.fy = w.fz = w.mx = w.my = w.mz = 0.0;
  calx_particle_forces(&b, numbers, &w);
  out[k] = w.fx;
  out[n + k] = w.fy;
  out[2 * n + k] = w.fz;
  out[3 * n + k] = w.mx;
  out[4 * n + k] = w.my;
  out[5 * n + k] = w.mz;
}
)");
  const std::size_t n = 500;
  const ForceRig::Columns columns = rig.particles(s, n);
  std::vector<double> in;
  for (const std::vector<double>& column : columns) in.insert(in.end(), column.begin(), column.end());
  const DeviceBuffer inputs = device.upload(in), numbers = device.upload(program.numbers),
                     outputs = device.allocate(6 * n * sizeof(double));
  const DeviceKernel kernel = device.build(module).kernel("check_force");
  device.launch(kernel, n,
                arguments(static_cast<std::uint32_t>(n), ForceRig::dt, ForceRig::time, inputs, numbers, outputs));
  const std::vector<double> out = device.download<double>(outputs, 6 * n);
  const std::vector<double> native = rig.evaluate(columns, n);
  for (std::size_t k = 0; k < out.size(); ++k)
    require(near(native[k], out[k], true, false), rig.name() + ": the force is " + short_number(native[k]) +
                                                      " natively and " + short_number(out[k]) + " from the text");
}

std::string on_device(Subject& s, const std::string& kind) {
  text_of(*s.any());
  const std::unique_ptr<Device> device = open(kind);
  int configurations = 0;
  if (s.manifest().kind == CALX_PARTICLE_FORCE) {
    for (const ForceRig& rig : force_rigs(s)) {
      compare_force(s, *device, rig);
      ++configurations;
    }
  } else {
    for (const LawRig& rig : rigs(s)) {
      if (rig.table().prop_count) throw Skipped{"it reads particle columns, which devices do not bring"};
      const LawList list = list_of(rig);
      LawProgram program = law_program({&list});
      if (program.numbers.empty()) program.numbers.push_back(0);
      const bool both = rig.table().eval_f32 != nullptr;
      const DeviceModule module = device->build(law_module(program, both));
      compare_law<double>(s, *device, module, rig, program);
      if (both) compare_law<float>(s, *device, module, rig, program);
      ++configurations;
    }
  }
  return std::to_string(configurations) + " configurations on " + device->name();
}

std::string text_host(Subject& s) { return on_device(s, "host"); }
std::string text_opencl(Subject& s) { return on_device(s, "opencl"); }

std::string text_cuda(Subject& s) {
  const InstancePtr instance = s.any();
  const Text text = text_of(*instance);
  if (s.manifest().kind != CALX_CONTACT_LAW) throw Skipped{"forces are compiled with the kernels of a run"};
  const LawRig rig = rigs(s).front();
  const LawList list = list_of(rig);
  DeviceCache cache("");
  CudaBinary binary;
  try {
    binary =
        compile_cuda(law_module(law_program({&list}), rig.table().eval_f32 != nullptr), "sm_90", "plugin check", cache);
  } catch (const Error& e) {
    if (e.fault() == Fault::usage) throw Skipped{e.what()};
    throw Failed{e.what()};
  }
  std::string detail;
  for (const auto& kernel : binary.resources) {
    require(kernel.second.spill_bytes <= 0, kernel.first + " spills " + std::to_string(kernel.second.spill_bytes) +
                                                " bytes of registers; make the law shorter");
    detail +=
        (detail.empty() ? "" : ", ") + kernel.first + " " + std::to_string(kernel.second.registers) + " registers";
  }
  return detail;
}

}  // namespace

std::vector<Check> text_checks() {
  return {
      {"text-dialect", "The law's text keeps to the dialect.", "", false, text_dialect},
      {"text-host", "The text, compiled by the machine's C++ compiler, gives the bits of the native code.", "", true,
       text_host, true},
      {"text-opencl", "The text gives the bits of the native code on an OpenCL device.", "", true, text_opencl, true},
      {"text-cuda", "NVRTC compiles the text for an NVIDIA GPU, without spilling registers.", "", false, text_cuda,
       true}};
}

}  // namespace calx::conformance
