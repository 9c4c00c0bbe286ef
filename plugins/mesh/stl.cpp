#include "stl.hpp"

#include <calx/plugin.hpp>
#include <cmath>
#include <fstream>
#include <iterator>
#include <locale>
#include <sstream>

namespace {

uint32_t little_u32(const char* p) {
  const unsigned char* b = reinterpret_cast<const unsigned char*>(p);
  return b[0] | static_cast<uint32_t>(b[1]) << 8 | static_cast<uint32_t>(b[2]) << 16 |
         static_cast<uint32_t>(b[3]) << 24;
}

double little_float(const char* p) {
  const uint32_t bits = little_u32(p);
  float f;
  std::memcpy(&f, &bits, sizeof f);
  return f;
}

[[noreturn]] void refuse(const std::string& path, const std::string& why) {
  throw calx::ConfigError("file: " + path + ": " + why);
}

/// Header of 80 bytes, count, then 50 bytes each: normal, three vertices, two bytes unused. The normal is not used: the
/// order of the vertices says the same.
std::vector<double> read_binary(const std::string& bytes) {
  const uint32_t count = little_u32(bytes.data() + 80);
  std::vector<double> xyz;
  xyz.reserve(9 * static_cast<size_t>(count));
  for (uint32_t t = 0; t < count; ++t)
    for (int k = 0; k < 9; ++k)
      xyz.push_back(little_float(bytes.data() + 84 + 50 * static_cast<size_t>(t) + 12 + 4 * k));
  return xyz;
}

std::vector<double> read_ascii(const std::string& path, const std::string& bytes) {
  std::istringstream text(bytes);
  text.imbue(std::locale::classic());
  std::string line;
  std::getline(text, line);  // "solid" and a name of any words
  std::vector<double> xyz;
  std::string word;
  size_t in_facet = 0;
  while (text >> word) {
    const std::string where = "triangle " + std::to_string(xyz.size() / 9 + 1);
    if (word == "solid") {
      std::getline(text, line);
    } else if (word == "endsolid") {
      std::getline(text, line);
    } else if (word == "facet") {
      in_facet = xyz.size();
    } else if (word == "vertex") {
      double v[3];
      if (!(text >> v[0] >> v[1] >> v[2])) refuse(path, where + ": \"vertex\" is not followed by three numbers");
      xyz.insert(xyz.end(), v, v + 3);
    } else if (word == "endfacet") {
      if (xyz.size() != in_facet + 9)
        refuse(path, "a facet has " + std::to_string((xyz.size() - in_facet) / 3) + " vertices; STL facets have 3");
    }
  }
  if (xyz.size() % 9 != 0) refuse(path, "the text ends within a facet; the file is cut short");
  return xyz;
}

}  // namespace

std::vector<double> read_stl(const std::string& path) {
  std::ifstream in(path.c_str(), std::ios::binary);
  if (!in) refuse(path, "cannot be opened; give the path of an STL file, relative to the case file or absolute");
  const std::string bytes((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  std::vector<double> xyz;
  // Some binary files also begin with "solid", so the size decides first.
  const bool is_binary =
      bytes.size() >= 84 && bytes.size() == 84 + 50 * static_cast<size_t>(little_u32(bytes.data() + 80));
  if (is_binary) {
    xyz = read_binary(bytes);
  } else if (bytes.compare(0, 5, "solid") == 0 && bytes.find('\0') == std::string::npos) {
    xyz = read_ascii(path, bytes);
  } else if (bytes.size() >= 84) {
    refuse(path, "is no STL file, or a binary one cut short: it announces " +
                     std::to_string(little_u32(bytes.data() + 80)) + " triangles, which needs " +
                     std::to_string(84 + 50 * static_cast<size_t>(little_u32(bytes.data() + 80))) + " bytes; it has " +
                     std::to_string(bytes.size()));
  } else {
    refuse(path, "is no STL file: it begins neither with \"solid\" nor with the 84 bytes of a binary header");
  }
  if (xyz.empty()) refuse(path, "holds no triangle");
  for (size_t k = 0; k < xyz.size(); ++k)
    if (!std::isfinite(xyz[k]))
      refuse(path, "triangle " + std::to_string(k / 9 + 1) + " has a coordinate that is not finite");
  return xyz;
}
