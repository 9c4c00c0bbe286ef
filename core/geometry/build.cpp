// build.cpp: receives a shape from a geometry plugin.
#include <string>

#include "base/error.hpp"
#include "calx/host_log.h"
#include "geometry/geometry.hpp"

namespace calx {
namespace {

/// Stands between the plugin and the host during build() so that the plugin's message can be quoted. Of the host's
/// extensions only the log is passed on: others could not be told from which host struct they are called.
struct Relay {
  calx_host host;
  const calx_host* behind;
  std::string message;

  explicit Relay(const calx_host* real) : host(), behind(real) {
    if (real) host = *real;
    host.struct_size = sizeof(calx_host);
    host.abi_major = CALX_ABI_MAJOR;
    host.abi_minor = CALX_ABI_MINOR;
    host.self = this;
    if (!real) host.name = "calx", host.version = "";
    host.get_extension = &extension;
    host.fail = &fail;
  }

  static calx_status CALX_CALL fail(const calx_host* host, calx_status code, const char* text) {
    static_cast<Relay*>(host->self)->message = text ? text : "";
    return code;
  }
  static const calx_host_log* log_of(const calx_host* real) {
    if (!real || !real->get_extension) return nullptr;
    return static_cast<const calx_host_log*>(real->get_extension(real, CALX_HOST_LOG));
  }
  static void CALX_CALL write(const calx_host* host, int32_t level, const char* text) {
    const calx_host* real = static_cast<Relay*>(host->self)->behind;
    if (const calx_host_log* log = log_of(real)) log->write(real, level, text);
  }
  static const void* CALX_CALL extension(const calx_host* host, const char* id) {
    static const calx_host_log log = {sizeof(calx_host_log), 0, &write};
    const bool wants_log = id && std::string(id) == CALX_HOST_LOG;
    return wants_log && log_of(static_cast<Relay*>(host->self)->behind) ? &log : nullptr;
  }
};

/// Collects what the plugin sends; exceptions become a status, as the boundary asks.
struct Collector {
  calx_shape_sink sink;
  Surface* surface;
  std::string refused;  // why the host refused an element

  explicit Collector(Surface* s) : sink(), surface(s) {
    sink.struct_size = sizeof(calx_shape_sink);
    sink.self = this;
    sink.triangles = &triangles;
    sink.revolution = &revolution;
  }

  template <class F>
  static calx_status take(const calx_shape_sink* sink, F f) noexcept {
    Collector& c = *static_cast<Collector*>(sink->self);
    try {
      f(*c.surface);
      return CALX_OK;
    } catch (const std::bad_alloc&) {
      return CALX_E_MEMORY;
    } catch (const std::exception& e) {
      if (c.refused.empty()) c.refused = e.what();
      return CALX_E_ARGUMENT;
    }
  }
  static calx_status CALX_CALL triangles(const calx_shape_sink* sink, uint64_t vertex_count, const double* xyz,
                                         uint64_t triangle_count, const uint32_t* index) {
    return take(sink, [&](Surface& s) {
      std::vector<Vec3> vertices(vertex_count);
      for (uint64_t k = 0; k < vertex_count; ++k) vertices[k] = {xyz[3 * k], xyz[3 * k + 1], xyz[3 * k + 2]};
      s.add_triangles(vertices, std::vector<std::uint32_t>(index, index + 3 * triangle_count));
    });
  }
  static calx_status CALX_CALL revolution(const calx_shape_sink* sink, const double origin[3], const double axis[3],
                                          uint64_t point_count, const double* r_z, uint32_t closed) {
    return take(sink, [&](Surface& s) {
      s.add_revolution({origin[0], origin[1], origin[2]}, {axis[0], axis[1], axis[2]},
                       std::vector<double>(r_z, r_z + 2 * point_count), closed != 0);
    });
  }
};

}  // namespace

Surface Surface::build(const calx_geometry& table, const calx_instance* instance, const calx_host* host,
                       const std::string& part_name) {
  const std::string where = "part '" + part_name + "': ";
  Surface surface;
  Relay relay(host);
  Collector collector(&surface);
  const calx_status status = table.build(instance, &relay.host, &collector.sink);
  if (!collector.refused.empty())
    throw Error(Fault::settings, where + "its geometry plugin sent a bad shape: " + collector.refused);
  if (status < 0) {
    const std::string why =
        relay.message.empty() ? "status " + std::to_string(status) + " without a message" : relay.message;
    throw Error(Fault::plugin, where + "its geometry plugin could not build the shape: " + why);
  }
  try {
    surface.finish();
  } catch (const Error& e) {
    throw Error(e.fault(), where + e.what());
  }
  // Openings are normal for walls; a triangle without area has no normal and points at an error in the plugin.
  MeshFaults faults;
  faults.degenerate = surface.faults().degenerate;
  faults.first_degenerate = surface.faults().first_degenerate;
  if (faults.degenerate > 0)
    throw Error(Fault::settings, where + faults.describe() + "; a wall needs triangles with an area");
  return surface;
}

}  // namespace calx
