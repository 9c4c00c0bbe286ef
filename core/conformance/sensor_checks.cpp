// sensor_checks.cpp: a sensor observes and changes nothing. Also saved state, of any kind, and the first use of a
// plugin.
#include <algorithm>
#include <cmath>
#include <cstring>

#include "conformance/checks.hpp"
#include "conformance/force_rig.hpp"
#include "conformance/law_rig.hpp"

namespace calx::conformance {
namespace {

/// Particles for a sensor to look at, and the bytes of them.
struct Scene {
  std::vector<std::uint32_t> id;
  std::vector<double> column[11];
  double reading = 0.25;  // of another sensor; instruments look at nothing else, others do not look at it
  calx_sensor_view view{};

  Scene(Subject& s, std::size_t count, double time) {
    for (std::size_t k = 0; k < count; ++k) {
      id.push_back(static_cast<std::uint32_t>(2 * k + 1));
      for (int c = 0; c < 9; ++c) column[c].push_back(s.uniform(-0.1, 0.1));
      column[9].push_back(s.uniform(1e-6, 1e-5));
      column[10].push_back(s.uniform(5e-4, 2e-3));
    }
    const auto at = [&](int c) { return column[c].data(); };
    view = {sizeof view, 0,     count, time,  id.data(), at(0), at(1),  at(2),    at(3),
            at(4),       at(5), at(6), at(7), at(8),     at(9), at(10), &reading, 1};
  }
  std::string bytes() const {
    std::string out(reinterpret_cast<const char*>(id.data()), id.size() * sizeof(std::uint32_t));
    for (const auto& c : column) out.append(reinterpret_cast<const char*>(c.data()), c.size() * sizeof(double));
    return out;
  }
};

std::vector<double> sample(const PluginInstance& instance, const Scene& scene) {
  const auto* table = static_cast<const calx_sensor*>(instance.table(CALX_SENSOR));
  require(table && table->sample, "it has no table " CALX_SENSOR);
  constexpr double canary = -7.25;
  std::vector<double> out(table->output_count + 8, canary);
  const calx_status status = table->sample(instance.get(), instance.host(), &scene.view, out.data());
  require(status >= 0, "sample gives status " + std::to_string(status));
  for (std::size_t k = table->output_count; k < out.size(); ++k)
    require(out[k] == canary, "it wrote beyond its " + std::to_string(table->output_count) + " outputs");
  out.resize(table->output_count);
  return out;
}

std::string reads_only(Subject& s) {
  const InstancePtr instance = s.any();
  for (const std::size_t count : {1, 100}) {
    Scene scene(s, count, 0.5);
    const std::string before = scene.bytes();
    sample(*instance, scene);
    require(scene.bytes() == before, "it changed the particles it looks at");
  }
  return "";
}

std::string outputs(Subject& s) {
  const InstancePtr instance = s.any();
  for (const std::size_t count : {0, 1, 100}) {
    const std::vector<double> out = sample(*instance, Scene(s, count, 0.5));
    for (std::size_t k = 0; k < out.size(); ++k) {
      const char* name = static_cast<const calx_sensor*>(instance->table(CALX_SENSOR))->output[k].name;
      require(out[k] != -7.25, std::string("it does not write \"") + name + "\"");
      // No particle, no centre: not a number says so, an infinite one says nothing.
      require(count == 0 ? !std::isinf(out[k]) : std::isfinite(out[k]) || std::isnan(out[k]),
              std::string("\"") + name + "\" is infinite with " + std::to_string(count) + " particles");
    }
  }
  return "";
}

std::string two_alike(Subject& s) {
  const InstancePtr a = s.any(), b = s.any();
  for (int k = 0; k < 5; ++k) {
    const Scene scene(s, 50, 0.1 * k);
    const std::vector<double> x = sample(*a, scene), y = sample(*b, scene);
    require(std::memcmp(x.data(), y.data(), x.size() * sizeof(double)) == 0,
            "two instances that saw the same give different numbers; is something shared or not set?");
  }
  return "";
}

struct Stream {
  calx_stream stream{};
  std::string bytes;
  std::size_t at = 0, piece;
  explicit Stream(std::string content = "", std::size_t piece_size = 1000000)
      : bytes(std::move(content)), piece(piece_size) {
    stream.struct_size = sizeof stream;
    stream.self = this;
    stream.write = [](const calx_stream* to, const void* data, std::uint64_t size) -> std::int64_t {
      static_cast<Stream*>(to->self)->bytes.append(static_cast<const char*>(data), size);
      return static_cast<std::int64_t>(size);
    };
    stream.read = [](const calx_stream* from, void* data, std::uint64_t size) -> std::int64_t {
      Stream& self = *static_cast<Stream*>(from->self);
      const std::size_t n = std::min<std::size_t>({size, self.piece, self.bytes.size() - self.at});
      std::memcpy(data, self.bytes.data() + self.at, n);
      self.at += n;
      return static_cast<std::int64_t>(n);
    };
  }
};

const calx_state& state_of(const PluginInstance& instance) {
  const auto* table = static_cast<const calx_state*>(instance.table(CALX_STATE));
  if (!table) throw Skipped{"it has no hidden state (" CALX_STATE ")"};
  return *table;
}

std::string saved(const PluginInstance& instance) {
  Stream stream;
  require(state_of(instance).save(instance.get(), &stream.stream) >= 0, "save fails");
  return stream.bytes;
}

/// Something happens to the instance that may change its hidden state.
void live(Subject& s, const PluginInstance& instance) {
  if (s.manifest().kind != CALX_SENSOR) return;
  for (int k = 0; k < 7; ++k) sample(instance, Scene(s, 20, 0.1 * k));
}

std::string state_round(Subject& s) {
  const InstancePtr a = s.any();
  const calx_state& table = state_of(*a);
  live(s, *a);
  const std::string bytes = saved(*a);
  for (const std::size_t piece : {1000000, 7, 1}) {
    const InstancePtr b = s.any();
    Stream stream(bytes, piece);
    require(table.load(b->get(), &stream.stream, table.schema) >= 0,
            piece == 1000000 ? "load refuses what save wrote"
                             : "load fails where a read gives fewer bytes than asked for; read until all are there");
    require(saved(*b) == bytes,
            "what is saved after loading is not what was loaded: a part of the state is not restored");
    if (s.manifest().kind != CALX_SENSOR) continue;
    const InstancePtr original = s.any();
    Stream again(bytes);
    table.load(original->get(), &again.stream, table.schema);
    const Scene scene(s, 20, 1.0);
    const std::vector<double> x = sample(*b, scene), y = sample(*original, scene);
    require(std::memcmp(x.data(), y.data(), x.size() * sizeof(double)) == 0,
            "after loading it measures something else");
  }
  if (s.manifest().kind == CALX_SENSOR) {
    const InstancePtr b = s.any();
    Stream stream(bytes);
    table.load(b->get(), &stream.stream, table.schema);
    const Scene scene(s, 20, 1.0);
    const std::vector<double> x = sample(*a, scene), y = sample(*b, scene);
    require(std::memcmp(x.data(), y.data(), x.size() * sizeof(double)) == 0,
            "a restored sensor does not go on as the saved one does: a part of the state is not saved");
  }
  return std::to_string(bytes.size()) + " bytes";
}

std::string state_garbage(Subject& s) {
  const InstancePtr a = s.any();
  const calx_state& table = state_of(*a);
  live(s, *a);
  const std::string bytes = saved(*a);
  const auto refused = [&](const std::string& content, std::uint32_t schema) {
    const InstancePtr b = s.any();
    Stream stream(content);
    return table.load(b->get(), &stream.stream, schema) < 0;
  };
  require(refused(bytes, table.schema + 1), "load takes bytes of a schema that it does not know");
  if (bytes.empty()) return "";
  require(refused("", table.schema), "load takes an empty stream");
  for (std::size_t cut = 1; cut < bytes.size(); cut += 1 + bytes.size() / 16)
    require(refused(bytes.substr(0, cut), table.schema), "load takes a stream that is cut after " +
                                                             std::to_string(cut) + " of " +
                                                             std::to_string(bytes.size()) + " bytes");
  // Random bytes may happen to be a state; what counts is that nothing crashes.
  for (int k = 0; k < 50; ++k) {
    std::string noise(static_cast<std::size_t>(s.uniform(0, 2 * static_cast<double>(bytes.size()) + 16)), ' ');
    for (char& c : noise) c = static_cast<char>(s.bits()());
    refused(noise, table.schema);
  }
  return "";
}

}  // namespace

void exercise(Subject& s) {
  const InstancePtr instance = s.any();
  const std::string& kind = s.manifest().kind;
  if (kind == CALX_CONTACT_LAW) {
    const LawRig rig = rigs(s).front();
    rig.evaluate<double>(rig.contacts(s, 100), rig.fresh(100));
  } else if (kind == CALX_PARTICLE_FORCE) {
    const ForceRig rig = force_rigs(s).front();
    rig.evaluate(rig.particles(s, 100), 64);
  } else if (kind == CALX_SENSOR) {
    sample(*instance, Scene(s, 100, 0.5));
  } else if (kind == CALX_MOTION) {
    calx_pose pose;
    static_cast<const calx_motion*>(instance->table(CALX_MOTION))->pose(instance->get(), 0.5, &pose);
  } else if (kind == CALX_SERVO) {
    calx_pose pose;
    const auto& servo = *static_cast<const calx_servo*>(instance->table(CALX_SERVO));
    const calx_servo_view view = {sizeof view, 0, 1e-5, 1e-5, {0, 0, -1}, {0, 0, 0}};
    servo.advance(instance->get(), instance->host(), &view);
    servo.pose(instance->get(), &pose);
  } else {
    calx_shape_sink sink{};
    sink.struct_size = sizeof sink;
    sink.triangles = [](const calx_shape_sink*, std::uint64_t, const double*, std::uint64_t,
                        const std::uint32_t*) -> calx_status { return CALX_OK; };
    sink.revolution = [](const calx_shape_sink*, const double*, const double*, std::uint64_t, const double*,
                         std::uint32_t) -> calx_status { return CALX_OK; };
    static_cast<const calx_geometry*>(instance->table(CALX_GEOMETRY))->build(instance->get(), instance->host(), &sink);
  }
}

std::vector<Check> sensor_checks() {
  constexpr const char* kind = CALX_SENSOR;
  return {
      {"reads-only", "The particles are as they were after a look at them.", kind, true, reads_only},
      {"outputs", "Every output is written, and not infinite, with no, one and many particles.", kind, true, outputs},
      {"two-alike", "Two instances that see the same measure the same.", kind, true, two_alike}};
}

std::vector<Check> state_checks() {
  return {{"state", "Saved, loaded in pieces and saved again, hidden state is the same, and goes on the same way.", "",
           true, state_round},
          {"state-garbage", "Empty, cut and random bytes and unknown schemas are refused without a crash.", "", true,
           state_garbage}};
}

}  // namespace calx::conformance
