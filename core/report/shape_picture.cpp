#include "report/shape_picture.hpp"

#include <algorithm>
#include <cmath>

#include "report/svg.hpp"
#include "report/units.hpp"

namespace calx {
namespace {

// Direction of view: from the front, a third to the right, a quarter from above.
const Vec3 right_of_view = normalized(Vec3{1, 0.45, 0});
const Vec3 to_viewer = normalized(Vec3{0.39, -0.86, 0.45});
const Vec3 up_of_view = normalized(cross(to_viewer, right_of_view));

struct Face {
  double depth, light;
  double x[3], y[3];
};

/// Cut until no side is longer than longest: farther faces are drawn first, which holds for small faces only.
void add_faces(const Vec3& a, const Vec3& b, const Vec3& c, double longest, double light, std::vector<Face>& faces) {
  const double ab = norm(b - a), bc = norm(c - b), ca = norm(a - c);
  const double side = std::max({ab, bc, ca});
  if (side > longest && side > 0) {
    if (side == ab) {
      const Vec3 m = 0.5 * (a + b);
      add_faces(a, m, c, longest, light, faces);
      add_faces(m, b, c, longest, light, faces);
    } else if (side == bc) {
      const Vec3 m = 0.5 * (b + c);
      add_faces(a, b, m, longest, light, faces);
      add_faces(a, m, c, longest, light, faces);
    } else {
      const Vec3 m = 0.5 * (c + a);
      add_faces(a, b, m, longest, light, faces);
      add_faces(m, b, c, longest, light, faces);
    }
    return;
  }
  Face face{dot(a + b + c, to_viewer), light, {}, {}};
  int k = 0;
  for (const Vec3* p : {&a, &b, &c}) {
    face.x[k] = dot(*p, right_of_view);
    face.y[k++] = dot(*p, up_of_view);
  }
  faces.push_back(face);
}

std::string shade(double light) {
  // Outside is blue, inside orange; both darker where the face turns away from the viewer.
  const double outside[3] = {118, 160, 214}, inside[3] = {232, 164, 92};
  const double* colour = light >= 0 ? outside : inside;
  const double share = 0.45 + 0.55 * std::round(16 * std::min(1.0, std::fabs(light))) / 16;
  return svg_colour(share * colour[0], share * colour[1], share * colour[2]);
}

}  // namespace

std::string draw_shape(const std::vector<Vec3>& vertices, const std::vector<std::uint32_t>& triangles) {
  const std::size_t count = triangles.size() / 3;
  if (count == 0) return "";
  const std::size_t stride = (count + 9999) / 10000;
  Box box, seen;
  for (const std::uint32_t k : triangles) box.add(vertices[k]);
  std::vector<Face> faces;
  for (std::size_t t = 0; t < count; t += stride) {
    const Vec3 &a = vertices[triangles[3 * t]], &b = vertices[triangles[3 * t + 1]],
               &c = vertices[triangles[3 * t + 2]];
    const double light = dot(normalized(cross(b - a, c - a)), to_viewer);
    add_faces(a, b, c, norm(box.hi - box.lo) / 10, light, faces);
  }
  for (const Face& face : faces)
    for (int k = 0; k < 3; ++k) seen.add({face.x[k], face.y[k], 0});
  std::stable_sort(faces.begin(), faces.end(), [](const Face& a, const Face& b) { return a.depth < b.depth; });
  const double width_m = std::max(seen.hi.x - seen.lo.x, 1e-12), height_m = std::max(seen.hi.y - seen.lo.y, 1e-12);
  const double scale = std::min(420 / width_m, 360 / height_m), margin = 10;
  const double width = std::max(width_m * scale, 300.0) + 2 * margin, height = height_m * scale + 2 * margin + 22;
  std::string svg = "<svg viewBox=\"0 0 " + svg_number(width) + " " + svg_number(height) + "\" width=\"" +
                    svg_number(width) +
                    "\" role=\"img\" aria-label=\"The shape\"><g stroke-width=\"0.5\" stroke-linejoin=\"round\">";
  std::string colour;
  for (const Face& face : faces) {
    const std::string next = shade(face.light);
    // Neighbours in depth of one colour are one path: a quarter of the text.
    if (next != colour)
      svg += (colour.empty() ? "" : "\"/>") + ("<path fill=\"" + next + "\" stroke=\"" + next) + "\" d=\"";
    colour = next;
    for (int k = 0; k < 3; ++k)
      svg += (k == 0 ? "M" : "L") + svg_number(margin + (face.x[k] - seen.lo.x) * scale) + " " +
             svg_number(margin + (seen.hi.y - face.y[k]) * scale);
    svg += "z";
  }
  if (!colour.empty()) svg += "\"/>";
  const Vec3 size = box.hi - box.lo;
  svg += "</g><text x=\"" + svg_number(margin) + "\" y=\"" + svg_number(height - 6) +
         "\" font-size=\"12\" fill=\"#444\">x, y, z: " + format_quantity(size.x, "m", 3) + ", " +
         format_quantity(size.y, "m", 3) + ", " + format_quantity(size.z, "m", 3) + "</text></svg>";
  return svg;
}

}  // namespace calx
