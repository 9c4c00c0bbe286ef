// Materials, contacts, shapes and sources.
#include <algorithm>
#include <cmath>
#include <filesystem>

#include "base/error.hpp"
#include "base/nearest.hpp"
#include "base/units.hpp"
#include "config/case_reader.hpp"

namespace calx {

void CaseReader::read_materials(Object& root) {
  for (const auto& entry : root.section("materials", "materials by name").entries()) {
    const Node& node = entry.second;
    check_name(node, entry.first);
    MaterialSettings m;
    m.name = entry.first;
    m.pointer = node.pointer();
    Object object(node, "a material");
    if (const auto density = object.find("density")) m.density = density->number("kg/m^3", Allow::above_zero);
    // Ranges that hold whatever the law; each law's own table narrows them.
    if (const auto young = object.find("young")) young->number("Pa", Allow::above_zero);
    if (const auto poisson = object.find("poisson")) {
      const double nu = poisson->number("1");
      if (!(nu > -1 && nu <= 0.5))
        poisson->fail(format_number(nu) + " is out of range; must be above -1 and at most 0.5");
    }
    m.properties = node.parameters();
    case_.materials.push_back(m);
  }
}

void CaseReader::read_contacts(Object& root) {
  for (const Node& node : root.items("contacts", "contacts")) {
    ContactSettings c;
    c.pointer = node.pointer();
    Object object(node, "a contact");
    const Node between = object.need("between", "the names of the two materials");
    const std::vector<Node> pair = between.items("two names of materials");
    if (pair.size() != 2)
      between.fail(shown(between.json()) + "; must be the names of two materials, which may be the same");
    for (int k = 0; k < 2; ++k) c.between[k] = pair[static_cast<std::size_t>(k)].name_of("material", names_.materials);
    for (const ContactSettings& other : case_.contacts)
      if ((other.between[0] == c.between[0] && other.between[1] == c.between[1]) ||
          (other.between[0] == c.between[1] && other.between[1] == c.between[0]))
        between.fail("\"" + c.between[0] + "\" and \"" + c.between[1] + "\" already have the contact " + other.pointer +
                     "; a pair has one, with several \"laws\" where they add");

    const auto law_of = [](Object& entry) {
      LawSettings law;
      law.pointer = entry.pointer();
      law.law = entry.need("law", "the id of a contact law, such as \"calx.epam\"").text("the id of a contact law");
      law.parameters = entry.parameters();
      law.name = entry.text("name", "a name");
      if (law.name.empty()) law.name = law.law;
      return law;
    };
    if (const auto laws = object.find("laws")) {
      for (const char* key : {"law", "parameters"})
        if (object.has(key))
          node.fail("holds \"laws\" and \"" + std::string(key) + "\"; must hold one law or a list of laws");
      for (const Node& entry : laws->items("laws")) {
        Object law(entry, "a law");
        c.laws.push_back(law_of(law));
        law.done();
        for (std::size_t k = 0; k + 1 < c.laws.size(); ++k)
          if (c.laws[k].name == c.laws.back().name)
            entry.fail("a law before it is called \"" + c.laws[k].name + "\" too; give one of them another \"name\"");
      }
      if (c.laws.empty()) laws->fail("is an empty list; must hold at least one law");
    } else {
      c.laws.push_back(law_of(object));
    }
    object.done();
    case_.contacts.push_back(c);
  }
}

void CaseReader::read_shapes(Object& root) {
  for (const auto& entry : root.section("shapes", "shapes by name").entries()) {
    check_name(entry.second, entry.first);
    ShapeSettings shape;
    shape.name = entry.first;
    shape.pointer = entry.second.pointer();
    Object object(entry.second, "a shape");
    const auto list = object.find("spheres"), one = object.find("sphere");
    if (static_cast<bool>(list) == static_cast<bool>(one))
      entry.second.fail(list ? "holds \"spheres\" and \"sphere\"; must hold one of them"
                             : "has no spheres; must hold \"spheres\" or \"sphere\"");
    if (one) {
      Object sphere(*one, "a sphere");
      shape.spheres.push_back({{}, sphere.need("radius", "the radius in m").number("m", Allow::above_zero)});
      sphere.done();
    } else {
      for (const Node& node : list->items("spheres")) {
        Object sphere(node, "a sphere");
        SphereSettings s;
        s.at = sphere.need("at", "the place of the centre in the frame of the shape, m").vector("m");
        s.radius = sphere.need("radius", "the radius in m").number("m", Allow::above_zero);
        sphere.done();
        shape.spheres.push_back(s);
      }
      if (shape.spheres.empty()) list->fail("is an empty list; must hold at least one sphere");
    }
    object.done();
    case_.shapes.push_back(shape);
  }
}

SizeSettings CaseReader::read_size(const Node& node) {
  using Kind = SizeSettings::Kind;
  SizeSettings s;
  if (!node.json().is_object()) {
    s.scale = s.lowest = s.highest = node.number("1", Allow::above_zero);
    return s;
  }
  Object object(node, "a size");
  if (const auto scale = object.find("scale")) {
    s.scale = s.lowest = s.highest = scale->number("1", Allow::above_zero);
    object.done();
    return s;
  }
  const std::size_t kind = object.need("distribution", "or give \"scale\" for one size")
                               .choice("a distribution", {"uniform", "normal", "lognormal", "list"});
  if (kind == 3) {
    s.kind = Kind::list;
    const Node scales = object.need("scales", "the list of scale factors"),
               shares = object.need("shares", "the shares by mass");
    for (const Node& n : scales.items("scale factors")) s.scales.push_back(n.number("1", Allow::above_zero));
    double sum = 0;
    for (const Node& n : shares.items("shares by mass"))
      sum += s.shares.emplace_back(n.number("1", Allow::not_negative));
    if (s.scales.empty()) scales.fail("is an empty list; must hold at least one scale factor");
    if (s.scales.size() != s.shares.size())
      shares.fail(shown(shares.json()) + " for " + std::to_string(s.scales.size()) +
                  " scales; must be one share for each");
    if (!(sum > 0)) shares.fail("all shares are 0; one must be above 0");
    for (double& share : s.shares) share /= sum;
    s.lowest = *std::min_element(s.scales.begin(), s.scales.end());
    s.highest = *std::max_element(s.scales.begin(), s.scales.end());
  } else {
    if (kind == 0) {
      s.kind = Kind::uniform;
      s.lowest = object.need("lowest", "the lowest scale factor").number("1", Allow::above_zero);
      s.highest = object.need("highest", "the highest scale factor").number("1", Allow::above_zero);
      s.scale = (s.lowest + s.highest) / 2;
    } else {
      s.kind = kind == 1 ? Kind::normal : Kind::lognormal;
      s.scale = object.number(kind == 1 ? "mean" : "median", "1", 1, Allow::above_zero);
      s.deviation = object
                        .need("deviation", kind == 1 ? "the standard deviation of the scale factor"
                                                     : "the standard deviation of ln(scale factor)")
                        .number("1", Allow::above_zero);
      // Cut-offs three deviations away hold 99.7 % of the draws.
      const double spread = std::exp(3 * s.deviation);
      const double low = kind == 1 ? s.scale - 3 * s.deviation : s.scale / spread;
      if (!(low > 0) && !object.has("lowest"))
        node.fail("three deviations below the mean is a scale of " + format_number(low) + "; give \"lowest\" above 0");
      s.lowest = object.number("lowest", "1", low, Allow::above_zero);
      s.highest =
          object.number("highest", "1", kind == 1 ? s.scale + 3 * s.deviation : s.scale * spread, Allow::above_zero);
    }
    if (!(s.lowest < s.highest))
      node.fail("lowest " + format_number(s.lowest) + " is not below highest " + format_number(s.highest) +
                "; lowest must be below highest");
  }
  object.done();
  return s;
}

void CaseReader::read_positions(Object& source, SourceSettings& s) {
  if (const auto positions = source.find("positions")) {
    for (const Node& n : positions->items("positions")) s.positions.push_back(n.vector("m"));
    if (s.positions.empty()) positions->fail("is an empty list; must hold at least one position");
  }
  const auto check_length = [&](const Node& list, std::size_t length) {
    if (length != s.positions.size())
      list.fail(shown(list.json()) + " for " + std::to_string(s.positions.size()) +
                " positions; must be one for each position");
  };
  if (const auto list = source.find("orientations")) {
    for (const Node& n : list->items("quaternions [w, x, y, z]")) {
      if (!n.json().is_array() || n.json().size() != 4) n.fail(shown(n.json()) + "; must be a quaternion [w, x, y, z]");
      const std::vector<Node> q = n.items("four numbers");
      const Quat given{q[0].number("1"), q[1].number("1"), q[2].number("1"), q[3].number("1")};
      const double length2 = given.w * given.w + given.x * given.x + given.y * given.y + given.z * given.z;
      if (std::abs(length2 - 1) > 1e-6)
        n.fail("the quaternion has length " + format_number(std::sqrt(length2)) + "; must have length 1");
      s.orientations.push_back(normalized(given));
    }
    check_length(*list, s.orientations.size());
  }
  const auto vectors = [&](const char* key, const char* unit, std::vector<Vec3>& out) {
    const auto list = source.find(key);
    if (!list) return;
    for (const Node& n : list->items("vectors")) out.push_back(n.vector(unit));
    check_length(*list, out.size());
  };
  vectors("velocities", "m/s", s.velocities);
  vectors("spins", "rad/s", s.spins);
}

// One way to say how many: a list of positions, a file, or a region to fill with a mass or a count.
void CaseReader::read_source_amount(Object& source, SourceSettings& s) {
  read_positions(source, s);
  const auto file = source.find("file"), region = source.find("region"), mass = source.find("mass"),
             count = source.find("count"), rate = source.find("rate");
  if (file) {
    s.file = document_.absolute_path(file->text("the path of a CSV file"));
    if (!std::filesystem::exists(s.file))
      throw Error(Fault::files, document_.file_of(file->pointer()) + " " + file->pointer() + ": " + s.file +
                                    " does not exist; must be the path of a CSV file, relative to " +
                                    document_.folder());
  }
  if (!s.positions.empty() || file) {
    if (!s.positions.empty() && file) file->fail("a source has \"positions\" or a \"file\" of them; must have one");
    for (const auto* other : {&region, &mass, &count, &rate})
      if (*other) (*other)->fail("does not go with given positions; leave it out");
    return;
  }
  if (!region) source.need("region", "the region to fill: a name or a volume; or give \"positions\" or \"file\"");
  if (region->json().is_object()) {
    s.region = this->region(*region, "source " + s.name);
    s.region.is_named = false;
  } else {
    const std::string name = region->name_of("region", names_.regions);
    s.region = *std::find_if(case_.regions.begin(), case_.regions.end(),
                             [&](const RegionSettings& r) { return r.name == name; });
  }
  if (mass && count) count->fail("a source has a \"mass\" or a \"count\"; must have one");
  if (mass) s.mass = mass->number("kg", Allow::above_zero);
  if (count) s.count = count->whole(1);
  if (!mass && !count) source.need("mass", "the mass to make in kg, or \"count\", the number of particles");
  if (rate) s.rate = rate->number("kg/s", Allow::not_negative);
}

void CaseReader::read_sources(Object& root) {
  std::size_t index = 0;
  for (const Node& node : root.items("sources", "sources")) {
    SourceSettings s;
    s.pointer = node.pointer();
    Object object(node, "a source");
    s.name = object.text("name", "a name");
    if (s.name.empty()) {
      s.name = "source " + std::to_string(index);
      document_.fill(node.pointer() + "/name", s.name);
    }
    check_name(node, s.name);
    for (const SourceSettings& other : case_.sources)
      if (other.name == s.name) node.fail("another source is called \"" + s.name + "\"; names of sources must differ");
    s.shape = object.need("shape", "the name of a shape").name_of("shape", names_.shapes);
    const Node material = object.need("material", "the name of a material");
    s.material = material.name_of("material", names_.materials);
    for (const MaterialSettings& m : case_.materials)
      if (m.name == s.material && m.density == 0)
        document_.fail(m.pointer + "/density",
                       "is missing; the density in kg/m^3 of particles of source \"" + s.name + "\"");
    if (const auto size = object.find("size")) s.size = read_size(*size);
    read_source_amount(object, s);
    s.velocity = object.vector("velocity", "m/s", {});
    if (const auto when = object.find("when")) s.when = event(*when, "source " + s.name);
    s.random_orientation = object.boolean("random_orientation", s.orientations.empty());
    object.done();
    case_.sources.push_back(s);
    ++index;
  }
}

}  // namespace calx
