#include "io/vtp.hpp"

#include <cstring>
#include <numeric>

#include "io/files.hpp"

namespace calx {

std::string xml_text(const std::string& text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

template <class T>
VtpFile::Array VtpFile::array(const char* type, const std::string& name, unsigned components,
                              const std::vector<T>& values) {
  Array a{type, name, components, std::vector<unsigned char>(values.size() * sizeof(T))};
  if (!values.empty()) std::memcpy(a.bytes.data(), values.data(), a.bytes.size());
  return a;
}

VtpFile::VtpFile(double time, std::vector<float> points) : time_(time), point_count_(points.size() / 3) {
  points_.push_back(array("Float32", "Points", 3, points));
}

void VtpFile::set_vertices() {
  std::vector<std::int32_t> index(point_count_);
  std::iota(index.begin(), index.end(), 0);
  vertices_ = {array("Int32", "connectivity", 1, index)};
  for (std::int32_t& k : index) ++k;
  vertices_.push_back(array("Int32", "offsets", 1, index));
  vertex_count_ = point_count_;
}

void VtpFile::set_triangles(const std::vector<std::uint32_t>& index) {
  triangle_count_ = index.size() / 3;
  std::vector<std::int32_t> offsets(triangle_count_);
  for (std::size_t k = 0; k < triangle_count_; ++k) offsets[k] = static_cast<std::int32_t>(3 * (k + 1));
  triangles_ = {array("Int32", "connectivity", 1, std::vector<std::int32_t>(index.begin(), index.end())),
                array("Int32", "offsets", 1, offsets)};
}

void VtpFile::point_data(const std::string& name, unsigned components, std::vector<float> values) {
  point_data_.push_back(array("Float32", name, components, values));
}

void VtpFile::point_data(const std::string& name, std::vector<std::uint32_t> values) {
  point_data_.push_back(array("UInt32", name, 1, values));
}

void VtpFile::cell_data(const std::string& name, std::vector<std::uint32_t> values) {
  cell_data_.push_back(array("UInt32", name, 1, values));
}

void VtpFile::write(const std::string& path) const {
  std::uint64_t offset = 0;
  std::string head;
  const auto group = [&](const std::string& tag, const std::vector<Array>& arrays) {
    head += "<" + tag + ">\n";
    for (const Array& a : arrays) {
      head += "<DataArray type=\"" + a.type + "\" Name=\"" + xml_text(a.name) + "\" NumberOfComponents=\"" +
              std::to_string(a.components) + "\" format=\"appended\" offset=\"" + std::to_string(offset) + "\"/>\n";
      offset += 8 + a.bytes.size();
    }
    head += "</" + tag + ">\n";
  };
  const Array time = array("Float64", "TimeValue", 1, std::vector<double>{time_});
  head +=
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" "
      "header_type=\"UInt64\">\n<PolyData>\n<FieldData>\n<DataArray type=\"Float64\" Name=\"TimeValue\" "
      "NumberOfTuples=\"1\" format=\"appended\" offset=\"0\"/>\n</FieldData>\n";
  offset = 8 + time.bytes.size();
  head += "<Piece NumberOfPoints=\"" + std::to_string(point_count_) + "\" NumberOfVerts=\"" +
          std::to_string(vertex_count_) + "\" NumberOfLines=\"0\" NumberOfStrips=\"0\" NumberOfPolys=\"" +
          std::to_string(triangle_count_) + "\">\n";
  group("PointData", point_data_);
  group("CellData", cell_data_);
  group("Points", points_);
  if (vertex_count_ > 0) group("Verts", vertices_);
  if (triangle_count_ > 0) group("Polys", triangles_);
  head += "</Piece>\n</PolyData>\n<AppendedData encoding=\"raw\">\n_";

  NewFile file(path);
  file.write(head.data(), head.size());
  const auto block = [&file](const Array& a) {
    const std::uint64_t size = a.bytes.size();
    file.write(&size, sizeof size);
    file.write(a.bytes.data(), a.bytes.size());
  };
  block(time);
  for (const Array& a : point_data_) block(a);
  for (const Array& a : cell_data_) block(a);
  for (const Array& a : points_) block(a);
  if (vertex_count_ > 0)
    for (const Array& a : vertices_) block(a);
  if (triangle_count_ > 0)
    for (const Array& a : triangles_) block(a);
  const std::string tail = "\n</AppendedData>\n</VTKFile>\n";
  file.write(tail.data(), tail.size());
  file.commit(false);
}

}  // namespace calx
