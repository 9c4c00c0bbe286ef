// paper_rows.hpp: a file that sets a publication's figures beside runs of Calx: what was measured, what the
// publication's own simulation gave, which runs give the figure here, what is assumed and what a reduced run leaves
// out.
#pragma once
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace calx {

/// One form of a run: a case and what is changed in it.
struct PaperForm {
  std::string case_path;  // absolute; empty: the run has no such form
  // JSON pointer -> JSON value; what the file sets in every run comes first, so that a form's own changes win.
  std::vector<std::pair<std::string, std::string>> set;
  std::vector<std::string> reduced;  // sentences: what this form leaves out; none for a full one
  std::string pointer;
};

/// A case that rows take figures from, run with several seeds.
struct PaperRun {
  std::string name, pointer;
  PaperForm forms[2];                // full, reduced
  std::vector<std::uint64_t> seeds;  // of which --seeds N takes the first N
};
enum PaperFormIndex { paper_full = 0, paper_reduced = 1 };

/// A reference: one number, a range, a sign, or only words where the publication has a picture.
struct PaperReference {
  enum class Kind { none, value, range, sign, words } kind = Kind::none;
  double low = 0, high = 0;  // in the row's unit; equal for one number
  int sign = 0;              // -1, +1
  std::string words, where;  // where: the place in the publication
  bool derived = false;      // by arithmetic from numbers of the publication
};

/// factor times a column of a sensor: its last value, or the last one up to an event.
struct PaperTerm {
  std::string sensor, column, at, since;  // events; at empty: the end; since: the value then is subtracted
  double factor = 1;
};

/// Sum of terms of one run, in the row's unit; minus_run: the same figure of another run is subtracted.
struct PaperFigure {
  std::string run, minus_run;
  std::vector<PaperTerm> terms[2];  // by form: a reduced run may have to extrapolate
};

/// How a column is drawn where it is not drawn as it is: a force over a known area as a stress.
struct PaperAxis {
  std::string title, unit;  // empty: those of the column
  double factor = 1;        // value shown in unit = factor * value of the column
};

/// A curve: columns of a sensor's series against each other, or a curve that the sensor gives ("profile").
struct PaperPlot {
  std::string title, sensor, curve, x, y;  // x: a column or "time_s"
  std::string x_sensor;                    // of x; the same sensor when empty
  std::string since;                       // event: rows before it are left out
  PaperAxis x_axis, y_axis;
  bool picture = false;  // the apparatus cut open at the end of the first run instead
};

/// What the publication says in words about a difference, whatever its numbers say.
struct PaperClaim {
  std::string words, where;
  int sign = 0;  // of simulated - measured
};

struct PaperRow {
  std::string name, group, unit, pointer;  // unit "": the row is words and curves only
  PaperReference measured, simulated;
  PaperFigure figure;  // without terms: shape only, no number
  std::vector<PaperPlot> plots;
  std::vector<PaperClaim> claims;
  std::vector<std::string> assumed, notes;
  bool against_scatter = false;  // the figure is a difference that must not exceed the scatter of seeds
  bool has_figure() const { return !figure.terms[0].empty(); }
};

struct PaperRows {
  std::string file, title, source, intro;
  std::vector<PaperRun> runs;
  std::vector<PaperRow> rows;
};

/// Reads and checks a rows file; cases are found, not read. Throws Error(Fault::settings): "rows.json
/// /rows/3/calx/sensor: ...", Error(Fault::files) when the file cannot be read.
PaperRows read_paper_rows(const std::string& path);

const PaperRun& paper_run(const PaperRows& rows, const std::string& name);

/// Where the run of that name, form and seed stands below the folder of a paper.
std::string paper_run_folder(const std::string& out, const PaperRun& run, int form, std::uint64_t seed);

}  // namespace calx
