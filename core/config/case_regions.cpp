// Regions: volumes in the world frame, as users write them and as the engine asks about them.
#include <cmath>

#include "base/nearest.hpp"
#include "base/units.hpp"
#include "config/case_reader.hpp"

namespace calx {
namespace {

const double pi = 3.141592653589793;

// Share of the way from a to b and squared distance from the axis.
void on_axis(const RegionSettings& r, const Vec3& p, double& along, double& off2) {
  const Vec3 d = r.b - r.a, q = p - r.a;
  along = dot(q, d) / norm2(d);
  off2 = norm2(q - along * d);
}

// A disc of radius r across the unit vector u reaches r sqrt(1 - u_k^2) along axis k.
void add_disc(Box& box, const Vec3& centre, const Vec3& u, double r) {
  Vec3 reach;
  for (int k = 0; k < 3; ++k) reach[k] = r * std::sqrt(std::fmax(0, 1 - u[k] * u[k]));
  box.add(centre - reach);
  box.add(centre + reach);
}

}  // namespace

bool RegionSettings::contains(const Vec3& p) const {
  double along = 0, off2 = 0;
  switch (kind) {
    case Kind::box:
      return Box{a, b}.contains(p);
    case Kind::sphere:
      return norm2(p - a) <= radius * radius;
    case Kind::cylinder:
      on_axis(*this, p, along, off2);
      return along >= 0 && along <= 1 && off2 <= radius * radius;
    case Kind::cone: {
      on_axis(*this, p, along, off2);
      const double r = radius + along * (radius_b - radius);
      return along >= 0 && along <= 1 && off2 <= r * r;
    }
  }
  return false;
}

double RegionSettings::volume() const {
  const Vec3 d = b - a;
  switch (kind) {
    case Kind::box:
      return d.x * d.y * d.z;
    case Kind::sphere:
      return 4 * pi / 3 * radius * radius * radius;
    case Kind::cylinder:
      return pi * radius * radius * norm(d);
    case Kind::cone:
      return pi / 3 * norm(d) * (radius * radius + radius * radius_b + radius_b * radius_b);
  }
  return 0;
}

Box RegionSettings::bounds() const {
  if (kind == Kind::box) return {a, b};
  Box box;
  if (kind == Kind::sphere) {
    const Vec3 r{radius, radius, radius};
    box.add(a - r);
    box.add(a + r);
    return box;
  }
  const Vec3 u = normalized(b - a);
  add_disc(box, a, u, radius);
  add_disc(box, b, u, kind == Kind::cone ? radius_b : radius);
  return box;
}

RegionSettings CaseReader::region(const Node& node, const std::string& name) {
  static const std::vector<std::string> kinds = {"box", "cylinder", "cone", "sphere"};
  RegionSettings r;
  r.name = name;
  r.pointer = node.pointer();
  Object object(node, "a region");
  if (const auto follows = object.find("follows")) r.follows = follows->name_of("part", names_.parts);
  std::string found;
  for (const std::string& kind : kinds)
    if (object.has(kind)) {
      if (!found.empty())
        node.fail("holds \"" + found + "\" and \"" + kind + "\"; must hold one of " + quoted_list(kinds));
      found = kind;
    }
  object.done();
  if (found.empty()) node.fail("has no volume; must hold one of " + quoted_list(kinds));

  Object shape(*object.find(found), "a " + found);
  const auto axis = [&] {
    r.a = shape.need("from", "one end of the axis, m").vector("m");
    r.b = shape.need("to", "the other end of the axis, m").vector("m");
    if (norm2(r.b - r.a) == 0) shape.node().fail("\"from\" and \"to\" are the same point; the axis must have a length");
  };
  if (found == "box") {
    r.kind = RegionSettings::Kind::box;
    r.a = shape.need("min", "the lowest corner, m").vector("m");
    r.b = shape.need("max", "the highest corner, m").vector("m");
    check_corners(shape.node(), r.a, r.b);
  } else if (found == "cylinder") {
    r.kind = RegionSettings::Kind::cylinder;
    axis();
    r.radius = shape.need("radius", "the radius in m").number("m", Allow::above_zero);
  } else if (found == "cone") {
    r.kind = RegionSettings::Kind::cone;
    axis();
    r.radius = shape.need("radius_from", "the radius at \"from\", m").number("m", Allow::not_negative);
    r.radius_b = shape.need("radius_to", "the radius at \"to\", m").number("m", Allow::not_negative);
    if (r.radius == 0 && r.radius_b == 0) shape.node().fail("both radii are 0; one must be above 0");
  } else {
    r.kind = RegionSettings::Kind::sphere;
    r.a = shape.need("centre", "the centre, m").vector("m");
    r.radius = shape.need("radius", "the radius in m").number("m", Allow::above_zero);
  }
  shape.done();
  return r;
}

RegionSettings CaseReader::named_region(Document& document, const std::string& name) {
  CaseReader reader(document);
  const Node root(document, document.root(), "");
  reader.collect_names(root);
  Object object(root, "a case");
  Object regions = object.section("regions", "regions by name");
  return reader.region(regions.need(name, "must be a region"), name);
}

std::string CaseReader::region_name(const Node& node, const std::string& made_up) {
  if (!node.json().is_object()) return node.name_of("region", names_.regions);
  RegionSettings r = region(node, made_up);
  r.is_named = false;
  for (const RegionSettings& other : case_.regions)
    if (other.name == made_up)
      node.fail("needs the name \"" + made_up + "\", which another region has; rename that one");
  case_.regions.push_back(r);
  return made_up;
}

void CaseReader::read_regions(Object& root) {
  for (const auto& entry : root.section("regions", "regions by name").entries()) {
    check_name(entry.second, entry.first);
    case_.regions.push_back(region(entry.second, entry.first));
  }
}

void check_corners(const Node& node, const Vec3& lowest, const Vec3& highest) {
  for (int k = 0; k < 3; ++k)
    if (!(lowest[k] < highest[k]))
      node.fail(std::string("min ") + "xyz"[k] + " = " + format_quantity(lowest[k], "m") + " is not below max " +
                "xyz"[k] + " = " + format_quantity(highest[k], "m") + "; every min must be below its max");
}

}  // namespace calx
