#include "report/paper_rows.hpp"

#include <algorithm>
#include <filesystem>

#include "base/error.hpp"
#include "base/nearest.hpp"
#include "base/units.hpp"
#include "config/node.hpp"

namespace calx {
namespace {

std::vector<std::string> sentences(Object& object, const std::string& key) {
  std::vector<std::string> out;
  for (const Node& n : object.items(key, "sentences")) out.push_back(n.text("a sentence"));
  return out;
}

using Changes = std::vector<std::pair<std::string, std::string>>;

Changes read_changes(Object& object) {
  Changes out;
  for (const auto& [pointer, value] : object.section("set", "JSON pointers and values").entries()) {
    if (pointer.empty() || pointer[0] != '/')
      value.fail("\"" + pointer + "\" is no JSON pointer; must start with /, such as \"/time/end\"");
    out.emplace_back(pointer, value.json().dump());
  }
  return out;
}

PaperForm read_form(const Node& node, bool is_reduced) {
  PaperForm form;
  form.pointer = node.pointer();
  Object object(node, "a form of a run");
  const Node file = object.need("case", "the path of a case file");
  form.case_path = node.document().absolute_path(file.text("the path of a case file"));
  if (!std::filesystem::exists(form.case_path))
    file.fail("\"" + file.json().get<std::string>() + "\" does not exist; must be the path of a case, relative to " +
              node.document().folder());
  form.set = read_changes(object);
  form.reduced = sentences(object, "reduced");
  if (is_reduced && form.reduced.empty())
    object.need("reduced", "a reduced form must say what it leaves out, in a list of sentences");
  if (!is_reduced && !form.reduced.empty()) node.fail("is the full form but holds \"reduced\"; must leave nothing out");
  object.done();
  return form;
}

PaperRun read_run(const std::string& name, const Node& node) {
  check_name(node, name);
  PaperRun run;
  run.name = name;
  run.pointer = node.pointer();
  Object object(node, "a run");
  if (const auto full = object.find("full")) run.forms[paper_full] = read_form(*full, false);
  if (const auto reduced = object.find("reduced")) run.forms[paper_reduced] = read_form(*reduced, true);
  if (run.forms[0].case_path.empty() && run.forms[1].case_path.empty())
    object.need("full", "a run must have a \"full\" form, a \"reduced\" one, or both");
  const Node seeds = object.need("seeds", "a list of seeds, such as [1, 2, 3]");
  for (const Node& n : seeds.items("seeds")) {
    run.seeds.push_back(n.whole(0));
    if (std::count(run.seeds.begin(), run.seeds.end(), run.seeds.back()) > 1) n.fail("stands twice; seeds must differ");
  }
  if (run.seeds.empty()) seeds.fail("is an empty list; must hold at least one seed");
  object.done();
  return run;
}

PaperReference read_reference(const Node& node) {
  using Kind = PaperReference::Kind;
  PaperReference out;
  Object object(node, "a reference");
  const auto value = object.find("value"), range = object.find("range"), sign = object.find("sign"),
             words = object.find("words");
  if (value.has_value() + range.has_value() + sign.has_value() + words.has_value() != 1)
    node.fail("must hold one of \"value\", \"range\", \"sign\" and \"words\"");
  if (value) {
    out.kind = Kind::value;
    out.low = out.high = value->number("1");
  } else if (range) {
    out.kind = Kind::range;
    const std::vector<Node> ends = range->items("two numbers, the lower one first");
    if (ends.size() != 2) range->fail(shown(range->json()) + "; must be two numbers, the lower one first");
    out.low = ends[0].number("1");
    out.high = ends[1].number("1");
    if (!(out.low < out.high))
      range->fail(format_number(out.low) + " is not below " + format_number(out.high) +
                  "; the lower one must be first");
  } else if (sign) {
    out.kind = Kind::sign;
    out.sign = sign->choice("a sign", {"negative", "positive"}) == 0 ? -1 : 1;
  } else {
    out.kind = Kind::words;
    out.words = words->text("words");
  }
  out.where = object.need("where", "the place in the publication").text("the place in the publication");
  out.derived = object.boolean("derived", false);
  object.done();
  return out;
}

PaperTerm read_term(Object& object) {
  PaperTerm term;
  term.sensor = object.need("sensor", "the name of a sensor of the case").text("the name of a sensor");
  term.column = object.need("column", "the name of one of its columns, with unit").text("the name of a column");
  term.at = object.text("at", "the name of an event");
  term.since = object.text("since", "the name of an event");
  term.factor = object.number("factor", "1", 1);
  return term;
}

std::vector<PaperTerm> read_terms(const Node& node) {
  std::vector<PaperTerm> terms;
  for (const Node& n : node.items("terms")) {
    Object term(n, "a term");
    terms.push_back(read_term(term));
    term.done();
  }
  if (terms.empty()) node.fail("is an empty list; must hold at least one term");
  return terms;
}

PaperFigure read_figure(const Node& node, const std::vector<std::string>& runs) {
  PaperFigure figure;
  Object object(node, "a figure");
  figure.run = object.need("run", "the name of a run").name_of("run", runs);
  if (const auto minus = object.find("minus")) figure.minus_run = minus->name_of("run", runs);
  if (const auto sum = object.find("sum"))
    figure.terms[paper_full] = read_terms(*sum);
  else if (object.has("sensor"))
    figure.terms[paper_full].push_back(read_term(object));
  figure.terms[paper_reduced] = figure.terms[paper_full];
  if (const auto reduced = object.find("reduced_sum")) {
    figure.terms[paper_reduced] = read_terms(*reduced);
    if (figure.terms[paper_full].empty()) object.need("sum", "the figure of the full form");
  }
  object.done();
  return figure;
}

PaperAxis read_axis(Object& plot, const std::string& key) {
  PaperAxis axis;
  const auto node = plot.find(key);
  if (!node) return axis;
  Object object(*node, "an axis");
  axis.title = object.need("title", "the quantity that is drawn").text("a quantity");
  axis.unit = object.need("unit", "its unit").text("a unit");
  axis.factor = object.need("factor", "value drawn over value of the column").number("1");
  object.done();
  return axis;
}

PaperPlot read_plot(const Node& node) {
  PaperPlot plot;
  Object object(node, "a plot");
  plot.title = object.need("title", "the title of the plot").text("a title");
  plot.picture = object.boolean("picture", false);
  if (!plot.picture) {
    plot.sensor = object.need("sensor", "the name of a sensor, or \"picture\": true").text("the name of a sensor");
    plot.curve = object.text("curve", "the name of a curve of the sensor");
    if (plot.curve.empty()) {
      plot.x = object.need("x", "a column, \"time_s\", or give \"curve\"").text("the name of a column");
      plot.y = object.need("y", "a column").text("the name of a column");
      plot.x_sensor = object.text("x_sensor", "the name of a sensor");
      plot.since = object.text("since", "the name of an event");
      plot.x_axis = read_axis(object, "x_axis");
      plot.y_axis = read_axis(object, "y_axis");
    }
  }
  object.done();
  return plot;
}

PaperRow read_row(const Node& node, const std::vector<std::string>& runs) {
  PaperRow row;
  row.pointer = node.pointer();
  Object object(node, "a row");
  row.name = object.need("name", "a name for the row").text("a name");
  row.group = object.need("group", "the heading it stands under").text("a heading");
  if (const auto unit = object.find("unit")) {
    row.unit = unit->text("a unit");
    try {
      parse_unit(row.unit);
    } catch (const Error& e) {
      unit->fail(e.what());
    }
  }
  row.measured = read_reference(object.need("measured", "what was measured, or {\"words\": ..}"));
  if (const auto simulated = object.find("simulated")) row.simulated = read_reference(*simulated);
  row.figure = read_figure(object.need("calx", "the run and figure here"), runs);
  if (row.has_figure() && row.unit.empty())
    object.need("unit", "the unit of the figures, such as \"g\"; \"1\" for none");
  for (const Node& n : object.items("plots", "plots")) row.plots.push_back(read_plot(n));
  for (const Node& n : object.items("claims", "claims")) {
    Object claim(n, "a claim");
    PaperClaim c;
    c.words = claim.need("words", "what the publication says").text("words");
    c.where = claim.need("where", "the place in the publication").text("a place");
    c.sign = claim.need("sign", "\"below\" or \"above\": where it says the simulation lies")
                         .choice("a side", {"below", "above"}) == 0
                 ? -1
                 : 1;
    claim.done();
    row.claims.push_back(c);
  }
  row.assumed = sentences(object, "assumed");
  row.notes = sentences(object, "notes");
  row.against_scatter = object.boolean("against_scatter", false);
  if (row.against_scatter && row.figure.minus_run.empty())
    node.fail("is judged against the scatter of seeds; /calx/minus must name the run it is the difference to");
  object.done();
  return row;
}

}  // namespace

PaperRows read_paper_rows(const std::string& path) {
  Document document(read_text_file(path), path, {});
  Object root(Node(document, document.root(), ""), "a rows file");
  PaperRows out;
  out.file = path;
  const Node version = root.need("calx_paper", "the number of the format, 1");
  if (version.whole(1) != 1) version.fail(shown(version.json()) + " is not known; this calx reads 1");
  out.title = root.need("title", "a title").text("a title");
  out.source = root.need("source", "the publication").text("the publication");
  out.intro = root.text("intro", "a sentence");
  const Changes common = read_changes(root);
  std::vector<std::string> runs, names;
  for (const auto& [name, node] : root.section("runs", "runs by name").entries()) {
    out.runs.push_back(read_run(name, node));
    for (PaperForm& form : out.runs.back().forms) form.set.insert(form.set.begin(), common.begin(), common.end());
    runs.push_back(name);
  }
  const Node rows = root.need("rows", "a list of rows");
  for (const Node& node : rows.items("rows")) {
    out.rows.push_back(read_row(node, runs));
    if (std::find(names.begin(), names.end(), out.rows.back().name) != names.end())
      document.fail(node.pointer() + "/name",
                    "another row is called \"" + out.rows.back().name + "\"; names of rows must differ");
    names.push_back(out.rows.back().name);
  }
  if (out.rows.empty()) rows.fail("is an empty list; must hold at least one row");
  root.done();
  return out;
}

const PaperRun& paper_run(const PaperRows& rows, const std::string& name) {
  return *std::find_if(rows.runs.begin(), rows.runs.end(), [&](const PaperRun& r) { return r.name == name; });
}

std::string paper_run_folder(const std::string& out, const PaperRun& run, int form, std::uint64_t seed) {
  return out + "/runs/" + run.name + "/" + (form == paper_full ? "full" : "reduced") + "/seed-" + std::to_string(seed);
}

}  // namespace calx
