// law.cpp: calx law: a contact law or law list pressed, struck and sheared; tables, a page and a picture of it.
#include "law.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "base/error.hpp"
#include "base/text_table.hpp"
#include "base/units.hpp"
#include "base/version.hpp"
#include "io/io.hpp"
#include "options.hpp"
#include "plugin/effects.hpp"
#include "report/chart_svg.hpp"
#include "report/json_text.hpp"
#include "report/page.hpp"
#include "sim/law_bench.hpp"

namespace calx {
namespace {

struct LawFlags {
  std::vector<std::string> laws, set, plugin_path;
  std::string case_path, between, out;
  LawBenchOptions bench;
  bool json = false;
};

/// "/parameters/kn" is that of the first law, "/materials/young" that of both materials; others point into the case.
std::vector<std::pair<std::string, std::string>> overrides_of(const LawFlags& flags) {
  std::vector<std::pair<std::string, std::string>> out;
  for (const std::string& text : flags.set) {
    const auto one = split_override(text, "/parameters/friction=0.3");
    const auto names = [&](const char* start) { return one.first.rfind(start, 0) == 0; };
    if (flags.case_path.empty() && names("/parameters"))
      out.emplace_back("/contacts/0/laws/0" + one.first, one.second);
    else if (flags.case_path.empty() && names("/materials/") && one.first.find('/', 11) == std::string::npos)
      for (const char* material : {"/i", "/j"})
        out.emplace_back("/materials" + (material + one.first.substr(10)), one.second);
    else
      out.push_back(one);
  }
  return out;
}

/// The bench's own case, or that of --case; i and j: the materials.
CaseFile case_of(const LawFlags& flags, const std::vector<std::string>& search, PluginRegistry& registry,
                 std::string (&pair)[2]) {
  if (flags.case_path.empty()) {
    if (flags.laws.empty())
      throw Error(
          Fault::usage,
          "law: the id of a contact law is needed, as in calx law calx.hertz-mindlin, or --case with --between");
    pair[0] = "i";
    pair[1] = "j";
    return parse_case(law_bench_case(flags.laws, registry), "calx law", overrides_of(flags));
  }
  if (!flags.laws.empty()) throw Error(Fault::usage, "law: give ids of laws, or --case, not both");
  const auto comma = flags.between.find(',');
  if (comma == std::string::npos || comma == 0 || comma + 1 == flags.between.size())
    throw Error(Fault::usage,
                "--between \"" + flags.between + "\": expected two materials of the case, as in calcine,steel");
  pair[0] = flags.between.substr(0, comma);
  pair[1] = flags.between.substr(comma + 1);
  const PluginEffects effects(search);
  return read_case(flags.case_path, overrides_of(flags), &effects);
}

std::string csv(const std::string& head, const std::vector<const std::vector<double>*>& columns) {
  std::string out = head + "\n";
  for (std::size_t row = 0; row < columns[0]->size(); ++row)
    for (std::size_t k = 0; k < columns.size(); ++k) {
      char number[32];
      std::snprintf(number, sizeof number, "%.9g", (*columns[k])[row]);
      out += std::string(number) + (k + 1 < columns.size() ? "," : "\n");
    }
  return out;
}

std::string press_csv(const LawBench& bench) {
  std::vector<double> loop, overlap, force;
  for (std::size_t k = 0; k < bench.press.size(); ++k) {
    loop.insert(loop.end(), bench.press[k].overlap.size(), static_cast<double>(k + 1));
    overlap.insert(overlap.end(), bench.press[k].overlap.begin(), bench.press[k].overlap.end());
    force.insert(force.end(), bench.press[k].force.begin(), bench.press[k].force.end());
  }
  return csv("loop_1,overlap_m,force_N", {&loop, &overlap, &force});
}

double largest(const std::vector<double>& values) {
  double out = 0;
  for (const double v : values) out = std::max(out, std::fabs(v));
  return out;
}

/// In micrometres, for axes that people read.
std::vector<double> micro(std::vector<double> metres) {
  for (double& x : metres) x *= 1e6;
  return metres;
}

std::vector<Chart> charts_of(const LawBench& bench) {
  std::vector<Chart> out(3);
  out[0].title = "Force over overlap";
  out[0].caption =
      "Fresh contacts, pressed to a third, two thirds and all of the overlap and released, so slowly that dashpots "
      "rest.";
  out[0].x = {"overlap", "um", true, {}};
  out[0].y = {"normal force", "N", false, {}};
  for (const LawPress& press : bench.press) {
    ChartSeries series;
    series.name = "to " + brief_quantity(1e6 * *std::max_element(press.overlap.begin(), press.overlap.end()), "um");
    series.x = micro(press.overlap);
    series.y = press.force;
    out[0].series.push_back(series);
  }
  out[1].title = "Restitution over speed";
  out[1].caption = "Head-on impacts without gravity; 0: they stay together.";
  out[1].x = {"speed before", "m/s", false, {}, true};
  out[1].y = {"restitution", "", true, {}};
  out[1].series.resize(1);
  out[1].series[0].name = "restitution";
  out[1].series[0].x = bench.speed;
  out[1].series[0].y = bench.restitution;
  out[2].title = "Tangential loop";
  out[2].caption = "Held at " + brief_quantity(1e6 * bench.sheared_overlap, "um") +
                   " of overlap, then sheared to, fro and to again.";
  out[2].x = {"displacement", "um", false, {}};
  out[2].y = {"tangential force", "N", false, {}};
  out[2].series.resize(1);
  out[2].series[0].name = "tangential force";
  out[2].series[0].x = micro(bench.displacement);
  out[2].series[0].y = bench.tangential;
  if (!(largest(bench.torque) > 0)) return out;
  Chart rolling;
  rolling.title = "Rolling loop";
  rolling.caption =
      "At the same overlap, rolled to, fro and to again at " + brief_quantity(bench.roll_spin, "rad/s") + ".";
  rolling.x = {"angle", "rad", false, {}};
  rolling.y = {"rolling torque", "N m", false, {}};
  rolling.series.resize(1);
  rolling.series[0].name = "rolling torque";
  rolling.series[0].x = bench.angle;
  rolling.series[0].y = bench.torque;
  out.push_back(rolling);
  return out;
}

std::string laws_text(const LawBench& bench) {
  std::string out;
  for (const std::string& law : bench.laws) out += (out.empty() ? "" : " + ") + law;
  return out;
}

/// Laws, pair and what was set, above the picture.
std::string title_of(const LawBench& bench, const LawFlags& flags) {
  std::string out = laws_text(bench);
  if (!flags.case_path.empty()) out += ", " + bench.pair;
  for (const std::string& one : flags.set) out += ", " + one.substr(one.rfind('/') + 1);
  return out;
}

/// Lines of name and value, for stdout and the page.
std::vector<std::pair<std::string, std::string>> figures(const LawBench& bench) {
  const LawPress& full = bench.press.back();
  const std::size_t last = bench.speed.size() - 1;
  const double grip = largest(bench.tangential);
  std::vector<std::pair<std::string, std::string>> out = {
      {"effective mass", brief_quantity(bench.mass, "kg")},
      {"effective radius", brief_quantity(bench.radius, "m")},
      {"deepest press", brief_quantity(*std::max_element(full.overlap.begin(), full.overlap.end()), "m") + ", " +
                            brief_quantity(full.most, "N")},
      {"lowest force of its release", brief_quantity(full.least, "N")},
      {"work lost in the loop", brief_quantity(100 * full.loss_share, "%")},
      {"restitution", brief_quantity(bench.restitution[0], "") + " at " + brief_quantity(bench.speed[0], "m/s") + ", " +
                          brief_quantity(bench.restitution[last], "") + " at " +
                          brief_quantity(bench.speed[last], "m/s")},
      {"largest tangential force",
       brief_quantity(grip, "N") + ", " +
           (bench.sheared_force > 0 ? brief_quantity(grip / bench.sheared_force, "") + " of the normal force"
                                    : "normal force " + brief_quantity(bench.sheared_force, "N"))}};
  if (largest(bench.torque) > 0)
    out.push_back({"largest rolling torque", brief_quantity(largest(bench.torque), "N m")});
  if (!(full.most > 0))
    out.push_back(
        {"note", "nothing pushes apart; a law that adds to others stands behind one: calx law calx.hertz-mindlin ID"});
  if (bench.reach > 0) out.push_back({"acts up to a gap of", brief_quantity(bench.reach, "m")});
  return out;
}

std::string page_of(const LawBench& bench, const CaseFile& file, const std::vector<PluginProvenance>& from) {
  Page page("calx law: " + laws_text(bench));
  page.header("<h1>" + html_text(laws_text(bench)) + "</h1><p>" + html_text(bench.pair) + ". Calx " +
              html_text(version()) + ".</p>");
  std::string drawn;
  for (const Chart& chart : charts_of(bench)) drawn += page.chart(chart);
  std::vector<std::vector<std::string>> rows = {{"figure", "value"}};
  for (const auto& one : figures(bench)) rows.push_back({html_text(one.first), html_text(one.second)});
  page.section("curves", "Curves", "Curves", "<div class=\"charts\">" + drawn + "</div>" + html_table(rows, 2));
  std::vector<std::vector<std::string>> plugins = {{"plugin", "version", "sha256"}};
  for (const PluginProvenance& one : from)
    plugins.push_back({html_text(one.id), html_text(one.version), html_text(one.sha256)});
  std::string presets;
  for (const std::string& line : bench.presets) presets += "<li>" + html_text(line) + "</li>";
  page.section("origin", "Where it comes from", "Origin",
               html_table(plugins, 3) + (presets.empty() ? "" : "<p>Left to presets:</p><ul>" + presets + "</ul>") +
                   "<pre>" + html_text(file.resolved) + "</pre>");
  return page.html();
}

std::string json_of(const LawBench& bench) {
  constexpr int digits = 9;
  const LawPress& full = bench.press.back();
  JsonText out;
  const auto number = [&](const char* name, double value) { out.key(name).value(value, digits); };
  out.begin_object().member("pair", bench.pair);
  number("mass_kg", bench.mass);
  number("radius_m", bench.radius);
  number("most_force_N", full.most);
  number("least_force_N", full.least);
  number("loss_share", full.loss_share);
  out.key("speed_m_s").values(bench.speed, digits).key("restitution").values(bench.restitution, digits);
  number("sheared_force_N", bench.sheared_force);
  number("largest_tangential_force_N", largest(bench.tangential));
  number("largest_rolling_torque_N_m", largest(bench.torque));
  return out.end_object().text();
}

/// What the laws were given, as the case has it: materials, and the parameters of each law.
std::string given_text(const CaseFile& file, const std::string (&pair)[2]) {
  std::vector<std::vector<std::string>> rows;
  for (const MaterialSettings& material : file.settings.materials)
    if (material.name == pair[0] || material.name == pair[1])
      rows.push_back({"material " + material.name, material.properties.json});
  for (const ContactSettings& contact : file.settings.contacts) {
    const auto& [a, b] = contact.between;
    if (!(a == pair[0] && b == pair[1]) && !(a == pair[1] && b == pair[0])) continue;
    for (const LawSettings& law : contact.laws)
      rows.push_back({"given to " + law.name, law.parameters.json == "{}" ? "presets alone" : law.parameters.json});
  }
  return text_table(rows);
}

void run_law(const LawFlags& flags) {
  if (!(flags.bench.radius > 0)) throw Error(Fault::usage, "--radius: expected a radius above 0, m");
  const std::vector<std::string> search = plugin_search_path(flags.plugin_path);
  PluginRegistry registry(search);
  std::string pair[2];
  const CaseFile file = case_of(flags, search, registry, pair);
  const LawBench bench = bench_law_list(file, pair[0], pair[1], flags.bench, registry);
  const std::string out =
      !flags.out.empty() ? flags.out : (flags.laws.empty() ? flags.between : flags.laws[0]) + ".law";
  std::error_code bad;
  std::filesystem::create_directories(out, bad);
  if (bad) throw Error(Fault::files, out + ": " + bad.message());
  write_text_atomically(out + "/press.csv", press_csv(bench));
  write_text_atomically(out + "/restitution.csv",
                        csv("speed_m_s,restitution_1,overlap_m,contact_time_s",
                            {&bench.speed, &bench.restitution, &bench.deepest, &bench.contact_time}));
  write_text_atomically(out + "/shear.csv", csv("displacement_m,force_N", {&bench.displacement, &bench.tangential}));
  write_text_atomically(out + "/roll.csv", csv("angle_rad,torque_N_m", {&bench.angle, &bench.torque}));
  write_text_atomically(out + "/case.json", file.resolved);
  write_text_atomically(out + "/law.svg", charts_svg(title_of(bench, flags), charts_of(bench)));
  write_text_atomically(out + "/law.html", page_of(bench, file, registry.provenance()));
  if (flags.json) {
    std::printf("%s\n", json_of(bench).c_str());
    return;
  }
  std::printf(
      "%s, %s%s\n%s", laws_text(bench).c_str(), bench.pair.c_str(),
      flags.case_path.empty() ? ": the materials of the bench, to be changed by --set /materials/KEY=value" : "",
      given_text(file, pair).c_str());
  for (const auto& one : figures(bench)) std::printf("  %-28s %s\n", one.first.c_str(), one.second.c_str());
  std::printf("%s/law.html\n", out.c_str());
}

}  // namespace

void add_law_command(CLI::App& app) {
  auto* command =
      app.add_subcommand("law", "press, strike and shear a contact law: curves of force, restitution and friction");
  auto flags = std::make_shared<LawFlags>();
  command->add_option("id", flags->laws, "contact law; several ids are a law list, whose forces add");
  command->add_option("--set", flags->set,
                      "repeatable: /parameters/KEY=value of the first law, /materials/KEY=value of both materials, "
                      "/materials/j/KEY=value of one, or any place of the case");
  command->add_option("--case", flags->case_path, "take materials and laws from this case");
  command->add_option("--between", flags->between, "with --case: its two materials, as in calcine,steel");
  command->add_option("--radius", flags->bench.radius, "of the spheres, m (default: 0.001)");
  command->add_flag("--wall", flags->bench.wall, "the second is a wall, not a sphere");
  command
      ->add_option("--overlap", flags->bench.overlap, "of the deepest press, m (default: that of an impact at 0.1 m/s)")
      ->check(zero_or_more());
  command->add_option("-o,--out", flags->out, "folder of the results (default: ID.law)");
  command->add_option("--plugin-path", flags->plugin_path, "folder with plugins, searched first; repeatable");
  command->add_flag("--json", flags->json, "figures as JSON on stdout");
  command->callback([flags] { run_law(*flags); });
}

}  // namespace calx
