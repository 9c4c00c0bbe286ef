#include "report/section_picture.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include "report/page.hpp"
#include "report/svg.hpp"
#include "report/units.hpp"

namespace calx {
namespace {

const std::size_t most_spheres = 14000;  // some 60 bytes each: below 1 MB

// Axes of the picture as numbers 0..2 of the world: right, up, and the direction of view.
struct Axes {
  int right = 0, up = 2, depth = 1;
  double up_sign = 1;
};

Axes axes_for(const Vec3& gravity) {
  Axes a;
  for (int k = 0; k < 3; ++k) {
    if (std::fabs(gravity[k]) > std::fabs(gravity[a.up])) a.up = k;
  }
  a.up_sign = gravity[a.up] > 0 ? -1 : 1;
  a.right = (a.up + 1) % 3;
  a.depth = (a.up + 2) % 3;
  return a;
}

struct Line {
  double x1, y1, x2, y2;
};

Vec3 vertex(const PartMesh& part, std::uint32_t number, const FrameData::PartPose& pose) {
  const float* v = &part.vertices[3 * static_cast<std::size_t>(number)];
  return rotate(pose.turn, Vec3{v[0], v[1], v[2]}) + pose.shift;
}

void cut(const PartMesh& part, const FrameData::PartPose& pose, const Axes& axes, double plane,
         std::vector<Line>& lines) {
  for (std::size_t t = 0; t + 2 < part.triangles.size(); t += 3) {
    double ends[6];
    int found = 0;
    Vec3 p[3];
    for (int k = 0; k < 3; ++k) p[k] = vertex(part, part.triangles[t + static_cast<std::size_t>(k)], pose);
    for (int k = 0; k < 3; ++k) {
      const Vec3 &a = p[k], &b = p[(k + 1) % 3];
      const double da = a[axes.depth] - plane, db = b[axes.depth] - plane;
      if ((da < 0) == (db < 0)) continue;
      const Vec3 c = a + da / (da - db) * (b - a);
      ends[2 * found] = c[axes.right];
      ends[2 * found + 1] = axes.up_sign * c[axes.up];
      if (++found == 2) break;
    }
    if (found == 2) lines.push_back({ends[0], ends[1], ends[2], ends[3]});
  }
}

struct Extent {
  double x0 = 1e300, x1 = -1e300, y0 = 1e300, y1 = -1e300;
  void add(double x, double y) {
    x0 = std::min(x0, x), x1 = std::max(x1, x), y0 = std::min(y0, y), y1 = std::max(y1, y);
  }
};

// A scale bar of 1, 2 or 5 times a power of ten, about a quarter of the width.
std::string scale_bar(double width_m, double pixels_per_m, double x, double y) {
  double length = std::pow(10, std::floor(std::log10(width_m / 4)));
  for (double f : {5.0, 2.0}) {
    if (length * f <= width_m / 3) {
      length *= f;
      break;
    }
  }
  const double w = length * pixels_per_m;
  return "<path d=\"M" + svg_number(x) + " " + svg_number(y - 4) + "v8m0 -4h" + svg_number(w) +
         "m0 -4v8\" stroke=\"#444\" fill=\"none\"/>" + "<text x=\"" + svg_number(x + w / 2) + "\" y=\"" +
         svg_number(y - 7) + "\" text-anchor=\"middle\">" + format_quantity(length, "m", 3) + "</text>";
}

}  // namespace

std::string speed_colour(double share) {
  static const double anchors[6][3] = {{116, 142, 184}, {52, 136, 178}, {64, 172, 142},
                                       {166, 206, 96},  {247, 192, 66}, {212, 62, 42}};
  const double at = 5 * std::min(1.0, std::max(0.0, share));
  const int k = std::min(4, static_cast<int>(at));
  const auto mixed = [&](int c) { return anchors[k][c] + (at - k) * (anchors[k + 1][c] - anchors[k][c]); };
  return svg_colour(mixed(0), mixed(1), mixed(2));
}

SectionPicture draw_section(const FrameSet& set, const FrameData& frame, const Vec3& gravity, double highest_speed) {
  SectionPicture out;
  const Axes axes = axes_for(gravity);
  Box parts, grains;
  for (std::size_t p = 0; p < set.parts.size() && p < frame.parts.size(); ++p) {
    if (!frame.parts[p].present) continue;
    for (std::size_t v = 0; v < set.parts[p].vertices.size() / 3; ++v) {
      parts.add(vertex(set.parts[p], static_cast<std::uint32_t>(v), frame.parts[p]));
    }
  }
  double largest = 0;
  for (std::size_t i = 0; i < frame.x.size(); ++i) {
    grains.add({frame.x[i], frame.y[i], frame.z[i]});
    largest = std::max(largest, static_cast<double>(frame.radius[i]));
  }
  const Box& middle = parts.lo.x <= parts.hi.x ? parts : grains;
  if (middle.lo.x > middle.hi.x) return out;
  const double plane = (middle.lo[axes.depth] + middle.hi[axes.depth]) / 2 + 1e-9;

  std::vector<Line> lines;
  for (std::size_t p = 0; p < set.parts.size() && p < frame.parts.size(); ++p) {
    if (frame.parts[p].present) cut(set.parts[p], frame.parts[p], axes, plane, lines);
  }
  std::vector<std::size_t> shown;
  for (std::size_t i = 0; i < frame.x.size(); ++i) {
    const double behind = Vec3{frame.x[i], frame.y[i], frame.z[i]}[axes.depth] - plane;
    if (behind >= 0 && behind < 2 * largest) shown.push_back(i);
  }
  const auto depth = [&](std::size_t i) { return Vec3{frame.x[i], frame.y[i], frame.z[i]}[axes.depth]; };
  std::stable_sort(shown.begin(), shown.end(), [&](std::size_t a, std::size_t b) { return depth(a) > depth(b); });
  if (shown.size() > most_spheres) shown.erase(shown.begin(), shown.end() - static_cast<std::ptrdiff_t>(most_spheres));

  Extent extent;
  for (const Line& l : lines) extent.add(l.x1, l.y1), extent.add(l.x2, l.y2);
  for (std::size_t i : shown) {
    const Vec3 c{frame.x[i], frame.y[i], frame.z[i]};
    extent.add(c[axes.right], axes.up_sign * c[axes.up]);
  }
  if (extent.x0 > extent.x1) return out;
  const double width_m = std::max(extent.x1 - extent.x0, 1e-9), height_m = std::max(extent.y1 - extent.y0, 1e-9);
  const double scale = std::min(560 / width_m, 620 / height_m), margin = 14;
  const double width = width_m * scale + 2 * margin, height = height_m * scale + 2 * margin + 26;
  const auto px = [&](double x) { return margin + (x - extent.x0) * scale; };
  const auto py = [&](double y) { return margin + (extent.y1 - y) * scale; };

  out.svg = "<svg class=\"section-picture\" viewBox=\"0 0 " + svg_number(width) + " " + svg_number(height) +
            "\" width=\"" + svg_number(width) +
            "\" role=\"img\" aria-label=\"Section through the apparatus\"><g stroke=\"#20304a\" "
            "stroke-opacity=\"0.35\" stroke-width=\"0.4\">";
  for (std::size_t i : shown) {
    const Vec3 c{frame.x[i], frame.y[i], frame.z[i]};
    const double part = highest_speed > 0 ? std::sqrt(frame.speed[i] / highest_speed) : 0;
    out.svg += "<circle cx=\"" + svg_number(px(c[axes.right])) + "\" cy=\"" +
               svg_number(py(axes.up_sign * c[axes.up])) + "\" r=\"" +
               svg_number(std::max(0.4, frame.radius[i] * scale)) + "\" fill=\"" + speed_colour(part) + "\"/>";
  }
  out.svg += "</g><path fill=\"none\" stroke=\"#1d2733\" stroke-width=\"1.4\" stroke-linecap=\"round\" d=\"";
  for (const Line& l : lines) {
    out.svg += "M" + svg_number(px(l.x1)) + " " + svg_number(py(l.y1)) + "L" + svg_number(px(l.x2)) + " " +
               svg_number(py(l.y2));
  }
  out.svg += "\"/><g font-size=\"12\" fill=\"#444\">" + scale_bar(width_m, scale, margin, height - 8) + "</g></svg>";
  out.spheres = shown.size();
  return out;
}

}  // namespace calx
