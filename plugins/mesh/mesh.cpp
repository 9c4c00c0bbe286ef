// mesh.cpp: walls from an STL file, calx.mesh. Faults that would let grains through or double a wall are refused by
// name.
#include <calx/shape.hpp>
#include <vector>

#include "faults.hpp"
#include "path.hpp"
#include "stl.hpp"

namespace {

const calx_field fields[] = {
    {"unit", "m|mm|cm|inch", "unit of the file's coordinates; STL files do not say it", 0, 3, 0,
     CALX_FIELD_CHOICE | CALX_FIELD_REQUIRED, 0},
    {"scale", "1", "factor on all coordinates, besides the unit", 1e-9, 1e9, 1, 0, 0},
    {"position_x", "m", "where the file's origin lies, x", -1e6, 1e6, 0, CALX_VEC(1), 0},
    {"position_y", "m", "where the file's origin lies, y", -1e6, 1e6, 0, CALX_VEC(1), 0},
    {"position_z", "m", "where the file's origin lies, z", -1e6, 1e6, 0, CALX_VEC(1), 0},
    {"allow_open", "no|yes",
     "yes takes open, inverted and non-manifold meshes as they are and leaves degenerate and duplicate triangles out",
     0, 1, 0, CALX_FIELD_CHOICE, 0}};

const char extra_schema[] =
    "{\"properties\": {\"file\": {\"type\": \"string\", \"format\": \"path\", \"description\": "
    "\"STL file, ASCII or binary, relative to the case file\"}}, \"required\": [\"file\"]}";

const double unit_length[] = {1, 1e-3, 1e-2, 0.0254};

class Mesh : public calx::shape::Shape {
 public:
  static const calx_descriptor descriptor;

  Mesh(const calx_host*, const calx_config& c) {
    const auto get = [&](const char* name) { return calx::parameter(descriptor, c, name); };
    const std::string path = c.json ? file_of(std::string(c.json, c.json_size)) : std::string();
    if (path.empty()) throw calx::ConfigError("file: missing; give the path of an STL file");
    const double scale = unit_length[static_cast<int>(get("unit"))] * get("scale");
    const double position[3] = {get("position_x"), get("position_y"), get("position_z")};
    std::vector<double> corners = read_stl(path);
    for (size_t k = 0; k < corners.size(); ++k) corners[k] = scale * corners[k] + position[k % 3];
    mesh_ = check_mesh(corners);
    const std::string faults = mesh_.describe();
    if (!faults.empty() && get("allow_open") < 0.5)
      throw calx::ConfigError("file: " + path + ": " + faults +
                              "; repair the mesh, or set \"allow_open\": \"yes\" if these do not matter");
    if (mesh_.index.empty()) throw calx::ConfigError("file: " + path + ": no triangle has an area");
  }

  calx_status send(const calx_shape_sink* sink) const override {
    return sink->triangles(sink, mesh_.xyz.size() / 3, mesh_.xyz.data(), mesh_.index.size() / 3, mesh_.index.data());
  }

 private:
  CheckedMesh mesh_;
};

const calx_descriptor Mesh::descriptor =
    calx::shape::descriptor("calx.mesh", "Mesh", "1.0.0", "Calx", "Apache-2.0",
                            "Triangles from an STL file, checked for faults.", fields, extra_schema);

}  // namespace

CALX_PLUGIN(Mesh)
