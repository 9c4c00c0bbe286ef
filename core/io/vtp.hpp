// vtp.hpp: one VTK XML PolyData file (.vtp), arrays appended raw, as ParaView 5.11 and VTK 9 read it.
// VTK File Formats, "XML File Formats": little endian, each array preceded by its length in bytes as UInt64.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace calx {

class VtpFile {
 public:
  /// Points x y z, m. time: s, shown by ParaView.
  VtpFile(double time, std::vector<float> points);
  /// One vertex cell per point, so that glyphs and filters see each sphere.
  void set_vertices();
  /// Three point numbers each.
  void set_triangles(const std::vector<std::uint32_t>& index);
  void point_data(const std::string& name, unsigned components, std::vector<float> values);
  void point_data(const std::string& name, std::vector<std::uint32_t> values);
  void cell_data(const std::string& name, std::vector<std::uint32_t> values);
  void write(const std::string& path) const;

 private:
  struct Array {
    std::string type, name;
    unsigned components;
    std::vector<unsigned char> bytes;
  };
  template <class T>
  static Array array(const char* type, const std::string& name, unsigned components, const std::vector<T>& values);
  double time_;
  std::size_t point_count_, vertex_count_ = 0, triangle_count_ = 0;
  std::vector<Array> points_, point_data_, cell_data_, vertices_, triangles_;
};

/// Text as it may stand in an XML attribute.
std::string xml_text(const std::string& text);

}  // namespace calx
