// geometry_checks.cpp: the shape of a part.
#include <algorithm>
#include <cmath>
#include <cstring>

#include "base/error.hpp"
#include "conformance/checks.hpp"
#include "geometry/elements.hpp"
#include "geometry/geometry.hpp"

namespace calx::conformance {
namespace {

struct Built {
  std::string name;
  Surface surface;
};

Surface build(const PluginInstance& instance, const std::string& name) {
  const auto* table = static_cast<const calx_geometry*>(instance.table(CALX_GEOMETRY));
  require(table && table->build, name + ": it has no table " CALX_GEOMETRY);
  try {
    return Surface::build(*table, instance.get(), instance.host(), name);
  } catch (const Error& e) {
    throw Failed{e.what()};
  }
}

std::vector<Built> every_shape(Subject& s) {
  std::vector<Built> out;
  for (const Variant& variant : s.variants()) {
    InstancePtr instance;
    try {
      instance = s.make(variant);
    } catch (const Failed&) {
      continue;  // creates tells it
    }
    out.push_back({variant.name, build(*instance, variant.name)});
  }
  if (out.empty()) s.any();
  return out;
}

std::string builds(Subject& s) {
  std::size_t elements = 0;
  const auto all = every_shape(s);
  for (const Built& one : all) {
    const Box box = one.surface.bounds();
    const double size = norm(box.hi - box.lo);
    require(std::isfinite(size) && size > 0, one.name + ": its bounds are not finite");
    require(size < 1e4, one.name + ": it is " + short_number(size) + " m large; are its lengths in metres?");
    elements += one.surface.element_count();
  }
  return std::to_string(all.size()) + " configurations, " + std::to_string(elements) + " elements";
}

/// Everything that was sent, as bytes.
struct Recorder {
  calx_shape_sink sink{};
  std::string bytes;
  Recorder() {
    sink.struct_size = sizeof sink;
    sink.self = this;
    sink.triangles = [](const calx_shape_sink* to, std::uint64_t vertices, const double* xyz, std::uint64_t triangles,
                        const std::uint32_t* index) -> calx_status {
      std::string& out = static_cast<Recorder*>(to->self)->bytes;
      out.append(reinterpret_cast<const char*>(xyz), vertices * 3 * sizeof(double));
      out.append(reinterpret_cast<const char*>(index), triangles * 3 * sizeof(std::uint32_t));
      for (std::uint64_t k = 0; k < 3 * triangles; ++k)
        if (index[k] >= vertices) return CALX_E_ARGUMENT;
      return CALX_OK;
    };
    sink.revolution = [](const calx_shape_sink* to, const double*, const double*, std::uint64_t points,
                         const double* r_z, std::uint32_t closed) -> calx_status {
      std::string& out = static_cast<Recorder*>(to->self)->bytes;
      out.append(reinterpret_cast<const char*>(r_z), points * 2 * sizeof(double));
      out += closed ? 'c' : 'o';
      return CALX_OK;
    };
  }
};

std::string repeats(Subject& s) {
  const InstancePtr instance = s.any();
  const auto* table = static_cast<const calx_geometry*>(instance->table(CALX_GEOMETRY));
  std::string first;
  for (int k = 0; k < 3; ++k) {
    Recorder recorder;
    const calx_status status = table->build(instance->get(), instance->host(), &recorder.sink);
    require(status >= 0, "build gives status " + std::to_string(status) + " when it is called again");
    if (k > 0) require(recorder.bytes == first, "build sends another shape when it is called again");
    first = recorder.bytes;
  }
  // A host that refuses an element wants to hear of it.
  Recorder refusing;
  refusing.sink.triangles = [](const calx_shape_sink*, std::uint64_t, const double*, std::uint64_t,
                               const std::uint32_t*) -> calx_status { return CALX_E_MEMORY; };
  refusing.sink.revolution = [](const calx_shape_sink*, const double*, const double*, std::uint64_t, const double*,
                                std::uint32_t) -> calx_status { return CALX_E_MEMORY; };
  require(table->build(instance->get(), instance->host(), &refusing.sink) < 0,
          "build goes on after the host refused an element; return the negative status of the sink");
  return "";
}

/// Rims of surfaces of revolution: ends of profiles off the axis where nothing follows.
std::size_t rims(const Surface& surface) {
  std::size_t open = 0;
  for (const geometry::ProfilePoint& point : surface.elements().points)
    open += point.count < 2 && point.position.r > surface.elements().tolerance;
  return open;
}

/// Corners that lie on an edge of one triangle, between its ends: where one triangle's edge meets two of others.
struct Halfway {
  std::size_t count = 0;
  Vec3 first;
};

Halfway halfway_corners(const Surface& surface) {
  const geometry::Elements& e = surface.elements();
  const double near = 2 * geometry::weld_share * e.size;
  std::vector<Vec3> corners;
  for (const geometry::Vertex& vertex : e.vertices)
    if (vertex.count > 0) corners.push_back(vertex.position);
  const auto left_of = [](const Vec3& a, const Vec3& b) { return a.x < b.x; };
  std::sort(corners.begin(), corners.end(), left_of);
  Halfway out;
  for (const geometry::Edge& edge : e.edges) {
    if (edge.count != 1) continue;
    const Vec3 end = edge.start + edge.length * edge.direction, margin{near, 0, 0};
    const auto from =
        std::lower_bound(corners.begin(), corners.end(), std::min(edge.start, end, left_of) - margin, left_of);
    const auto to = std::upper_bound(from, corners.end(), std::max(edge.start, end, left_of) + margin, left_of);
    for (auto at = from; at != to; ++at) {
      const double t = dot(*at - edge.start, edge.direction);
      if (t <= near || t >= edge.length - near || norm(*at - edge.start - t * edge.direction) > near) continue;
      if (out.count++ == 0) out.first = *at;
    }
  }
  return out;
}

/// "; at 1 place (first at ...) a corner lies halfway ..."; empty where none does.
std::string halfway_text(const Surface& surface) {
  const Halfway found = halfway_corners(surface);
  if (found.count == 0) return "";
  return "; at " + std::to_string(found.count) + (found.count == 1 ? " place" : " places") + " (first at (" +
         short_number(found.first.x) + ", " + short_number(found.first.y) + ", " + short_number(found.first.z) +
         ") m) a corner lies halfway on an edge of another triangle, which so counts as a rim: split that triangle "
         "there";
}

std::string mesh(Subject& s) {
  std::size_t open = 0;
  std::string halfway;
  for (const Built& one : every_shape(s)) {
    MeshFaults faults = one.surface.faults();
    const std::size_t edges = faults.open_edges + rims(one.surface);
    open += edges;
    faults.open_edges = 0;
    const std::string text = faults.describe();
    require(text.empty(), one.name + ": " + text + "; wind triangles counter-clockwise seen from outside, each once");
    if (edges > 0 && halfway.empty()) halfway = halfway_text(one.surface);
    require(edges == 0 || s.manifest().open,
            one.name + ": the surface is open, with " + std::to_string(one.surface.faults().open_edges) +
                " open edges of triangles and " + std::to_string(edges - one.surface.faults().open_edges) + " rims" +
                halfway +
                "; close it, or say \"surface\": \"open\" in the plugin's entry of the manifest if that is meant");
  }
  return open ? "open on purpose" + halfway : "closed";
}

}  // namespace

std::vector<CheckShape> shapes(Subject& s) {
  std::vector<CheckShape> out;
  for (const Built& one : every_shape(s)) {
    const Box box = one.surface.bounds();
    const Tessellation mesh = one.surface.tessellate(5e-3 * norm(box.hi - box.lo));
    CheckShape shape{one.name, {}, mesh.triangles};
    for (const Vec3& v : mesh.vertices) shape.vertices.insert(shape.vertices.end(), {v.x, v.y, v.z});
    const bool seen = std::any_of(out.begin(), out.end(), [&](const CheckShape& other) {
      return other.vertices == shape.vertices && other.triangles == shape.triangles;
    });
    if (!seen) out.push_back(std::move(shape));
    if (out.size() == 6) break;
  }
  return out;
}

std::vector<Check> geometry_checks() {
  constexpr const char* kind = CALX_GEOMETRY;
  return {{"shape", "The shape is built, finite and of a size in metres.", kind, false, builds},
          {"shape-repeats", "The same instance sends the same shape each time, and stops when the host refuses.", kind,
           false, repeats},
          {"shape-mesh",
           "The surface is closed unless the manifest calls it open, wound outwards, without double triangles.", kind,
           false, mesh}};
}

}  // namespace calx::conformance
