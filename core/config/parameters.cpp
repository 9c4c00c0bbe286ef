// Values of plugin parameter tables out of the user's JSON.
#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "base/nearest.hpp"
#include "base/units.hpp"
#include "config/config.hpp"
#include "config/extra_schema.hpp"
#include "config/tables.hpp"

namespace calx {
namespace {

struct Reading {
  const Node& object;
  const std::string& owner;
};

// A value a rounding error outside of its range, as 360 degrees may be, is brought back to the bound.
double in_range(const Node& node, double x, const calx_field& f, bool in_degrees, const std::string& owner) {
  const auto near = [](double a, double b) { return std::abs(a - b) <= 1e-12 * std::abs(b); };
  if (x < f.lowest && near(x, f.lowest)) x = f.lowest;
  if (x > f.highest && near(x, f.highest)) x = f.highest;
  if (x >= f.lowest && x <= f.highest) return x;
  const std::string unit = in_degrees ? degree_unit(f.unit) : f.unit;
  // Shown as the user wrote it; the limits in the table's unit, or in degrees.
  const double per = in_degrees ? from_degrees(1, f.unit) : 1;
  const auto limit = [&](double y) { return std::abs(y) >= unbounded ? y : std::round(y / per * 1e9) / 1e9; };
  const Json& j = node.json();
  std::string given = format_quantity(in_degrees ? x / per : x, unit);
  if (j.is_object()) given = format_quantity(j["value"].get<double>(), j["unit"].get<std::string>());
  if (j.is_number()) given = format_quantity(j.get<double>(), unit);
  node.fail(given + " is out of range; " + owner + " allows " +
            (in_degrees ? range_text(limit(f.lowest), limit(f.highest), unit) : range_text(f.lowest, f.highest, unit)));
}

double number(const Reading& r, const Node& node, const calx_field& f, bool in_degrees) {
  const Json& j = node.json();
  const bool whole = (f.flags & CALX_FIELD_INTEGER) != 0;
  if (whole && j.is_boolean() && f.lowest == 0 && f.highest == 1) return j.get<bool>() ? 1 : 0;
  double x = in_degrees ? from_degrees(node.number("1"), f.unit) : node.number(f.unit);
  if (whole && x != std::floor(x))
    node.fail(format_number(x) + " is not a whole number; " + r.owner + " allows whole numbers, " +
              range_text(f.lowest, f.highest, f.unit));
  return in_range(node, x, f, in_degrees, r.owner);
}

void read_entry(const Reading& r, const TableEntry& e, const Node& node, bool in_degrees, double* out) {
  const calx_field& f = *e.field;
  if (!e.choices.empty()) {
    out[0] = static_cast<double>(node.choice("a choice of " + r.owner, e.choices));
    return;
  }
  if (e.rows == 1) {
    out[0] = number(r, node, f, in_degrees);
    return;
  }
  const Vec3 v = node.vector(in_degrees ? "1" : f.unit);
  for (std::uint32_t k = 0; k < 3; ++k) {
    const double x = v[static_cast<int>(k)];
    // Units of a whole vector are converted by now, so a component is shown in the table's unit.
    const Json component = x;
    const Node place(node.document(), component, node.pointer() + pointer_token(std::size_t(k)));
    out[k] = in_range(place, in_degrees ? from_degrees(x, f.unit) : x, e.field[k], in_degrees, r.owner);
  }
}

void refuse_unknown(const Node& object, const std::vector<std::string>& known, const std::string& owner,
                    const std::vector<std::string>& ignore) {
  for (const auto& item : object.json().items()) {
    const auto in = [&](const std::vector<std::string>& names) {
      return std::find(names.begin(), names.end(), item.key()) != names.end();
    };
    if (!in(known) && !in(ignore))
      object.document().fail(
          object.pointer() + pointer_token(item.key()),
          "unknown key" + (owner.empty() ? "" : " for " + owner) + "; " + did_you_mean(item.key(), known));
  }
}

}  // namespace

ResolvedParameters resolve_parameters(const Parameters& parameters, const std::vector<FieldTable>& tables,
                                      const char* extra_schema, const std::string& owner, const std::string& file,
                                      const std::vector<std::string>& ignore) {
  Document document(parameters, file);
  const Node object(document, document.root(), parameters.pointer);
  if (!object.json().is_object()) object.fail(shown(object.json()) + "; must be an object of parameters");
  const Json schema = parse_extra_schema(extra_schema, owner);

  std::vector<std::string> known;
  const auto add = [&](const std::vector<std::string>& keys) {
    for (const std::string& key : keys)
      if (std::find(known.begin(), known.end(), key) == known.end()) known.push_back(key);
  };
  for (const FieldTable& t : tables) add(table_keys(t));
  add(extra_keys(schema));
  refuse_unknown(object, known, owner, ignore);

  ResolvedParameters out;
  const Reading reading{object, owner};
  const auto find = [&](const std::string& key) {
    const auto it = object.json().find(key);
    return it == object.json().end() ? std::optional<Node>()
                                     : Node(document, *it, parameters.pointer + pointer_token(key));
  };
  for (const FieldTable& t : tables) {
    std::vector<double> values(t.count);
    for (const TableEntry& e : table_entries(t)) {
      const auto plain = find(e.name);
      const auto degrees = e.is_angle ? find(e.name + "_deg") : std::nullopt;
      if (plain && degrees) degrees->fail("stands beside \"" + e.name + "\"; give one of them");
      if (plain) {
        read_entry(reading, e, *plain, false, &values[e.first]);
      } else if (degrees) {
        read_entry(reading, e, *degrees, true, &values[e.first]);
      } else if (e.field->flags & CALX_FIELD_REQUIRED) {
        // The unit of a choice is the list of its names.
        const std::string kind = !e.choices.empty()                  ? ", one of " + quoted_list(e.choices)
                                 : std::string(e.field->unit) != "1" ? std::string(", ") + e.field->unit
                                                                     : "";
        document.fail(parameters.pointer + pointer_token(e.name),
                      "is missing; " + owner + " needs " + e.name + kind + ": " + e.field->doc);
      } else {
        for (std::uint32_t k = 0; k < e.rows; ++k) values[e.first + k] = e.field[k].preset;
        if (std::find(out.presets_used.begin(), out.presets_used.end(), e.name) == out.presets_used.end())
          out.presets_used.push_back(e.name);
      }
    }
    out.values.push_back(std::move(values));
  }
  out.extra_json = read_extra(object, schema, owner).dump();
  return out;
}

std::vector<std::pair<std::string, std::string>> parameter_keys(const Parameters& parameters) {
  const Json object = Json::parse(parameters.json);
  std::vector<std::pair<std::string, std::string>> out;
  for (const auto& item : object.items()) out.emplace_back(item.key(), parameters.pointer + pointer_token(item.key()));
  return out;
}

void check_keys(const Parameters& parameters, const std::vector<std::string>& known, const std::string& file) {
  Document document(parameters, file);
  refuse_unknown(Node(document, document.root(), parameters.pointer), known, "", {});
}

}  // namespace calx
