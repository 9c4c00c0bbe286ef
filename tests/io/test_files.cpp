#include <doctest/doctest.h>

#include <limits>

#include "full_disk.hpp"
#include "io/io.hpp"
#include "scratch.hpp"

using namespace calx;
using namespace calx_test;

TEST_CASE("text comes back and replaces what was there") {
  const Scratch dir;
  write_text_atomically(dir / "a.json", "one");
  write_text_atomically(dir / "a.json", std::string("two\0\n", 5));
  CHECK(read_text(dir / "a.json") == std::string("two\0\n", 5));
  CHECK(dir.file_count() == 1);
}

TEST_CASE("a text that does not fit leaves the old one and no temporary file") {
  const Scratch dir;
  write_text_atomically(dir / "a.json", "old");
  std::string message;
  {
    const FileSizeLimit full(1000);
    message = file_error([&] { write_text_atomically(dir / "a.json", std::string(5000, 'x')); });
  }
  CHECK(message == "cannot write " + (dir / "a.json") +
                       ": File too large; raise the file size limit (ulimit -f); what was written before is kept");
  CHECK(read_text(dir / "a.json") == "old");
  CHECK(dir.file_count() == 1);
}

TEST_CASE("messages name the path and the reason") {
  const Scratch dir;
  CHECK(file_error([&] { read_text(dir / "none.json"); }) ==
        "cannot read " + (dir / "none.json") + ": No such file or directory");
  CHECK(file_error([&] { read_text(dir.path); }) == "cannot read " + dir.path + ": Is a directory");
  CHECK(file_error([&] { write_text_atomically(dir / "no/such/a.json", "x"); }) ==
        "cannot write " + (dir / "no/such/a.json") + ": No such file or directory");
}

TEST_CASE("a series holds a header and one row per sample, at once") {
  const Scratch dir;
  SeriesFile series(dir / "series/mass.csv", {"mass_kg", "count"}, -1);
  CHECK(read_text(dir / "series/mass.csv") == "time_s,mass_kg,count\n");
  series.write(0.1, {1.0 / 3, 1e20});
  series.write(12345.6789012, {-std::numeric_limits<double>::quiet_NaN(), -2});
  CHECK(read_text(dir / "series/mass.csv") == "time_s,mass_kg,count\n0.1,0.333333333,1e+20\n12345.6789,nan,-2\n");
}

TEST_CASE("a resumed series drops later rows, whatever rounding did to the time") {
  const Scratch dir;
  const std::string path = dir / "m.csv";
  const double last = 0.29999999996;  // printed as 0.3
  {
    SeriesFile series(path, {"m_kg"}, -1);
    for (const double t : {0.1, 0.2, last, 0.4, 0.5}) series.write(t, {t});
  }
  {
    SeriesFile series(path, {"m_kg"}, last);
    series.write(0.45, {7});
  }
  CHECK(read_text(path) == "time_s,m_kg\n0.1,0.1\n0.2,0.2\n0.3,0.3\n0.45,7\n");
}

TEST_CASE("a half-written last row is dropped on resuming, also one that reads as a number") {
  const Scratch dir;
  const std::string path = dir / "m.csv";
  write_text_atomically(path, "time_s,m_kg\n0.1,5\n0.2,5");
  SeriesFile(path, {"m_kg"}, 10).write(0.3, {6});
  CHECK(read_text(path) == "time_s,m_kg\n0.1,5\n0.3,6\n");
  write_text_atomically(path, "time_s,m_");
  SeriesFile(path, {"m_kg"}, 10).write(0.3, {6});
  CHECK(read_text(path) == "time_s,m_kg\n0.3,6\n");
}

TEST_CASE("a run that does not resume starts the series anew") {
  const Scratch dir;
  SeriesFile(dir / "m.csv", {"m_kg"}, -1).write(1, {1});
  SeriesFile(dir / "m.csv", {"n"}, -1);
  CHECK(read_text(dir / "m.csv") == "time_s,n\n");
}

TEST_CASE("a series refuses other columns and rows of another length") {
  const Scratch dir;
  SeriesFile(dir / "m.csv", {"m_kg"}, -1).write(1, {1});
  const std::string other = file_error([&] { SeriesFile(dir / "m.csv", {"n"}, 2); });
  CHECK(other ==
        dir /
            "m.csv: the columns are \"time_s,m_kg\", but the case now gives \"time_s,n\"; resume with the same "
            "sensors, or move the file away");
  CHECK(read_text(dir / "m.csv") == "time_s,m_kg\n1,1\n");
  SeriesFile series(dir / "n.csv", {"a", "b"}, -1);
  CHECK(file_error([&] {
          series.write(0.5, {1, 2, 3});
        }) == dir / "n.csv: a row of 3 values for 2 columns at t = 0.5 s");
}

TEST_CASE("a row that does not fit is taken back whole") {
  const Scratch dir;
  SeriesFile series(dir / "m.csv", {"m_kg"}, -1);
  series.write(1, {1});
  std::string message;
  {
    const FileSizeLimit full(20);
    message = file_error([&] { series.write(1.23456789, {9.87654321}); });
  }
  CHECK(contains(message, "cannot write " + (dir / "m.csv") + ": File too large"));
  CHECK(read_text(dir / "m.csv") == "time_s,m_kg\n1,1\n");
  series.write(2, {2});
  CHECK(read_text(dir / "m.csv") == "time_s,m_kg\n1,1\n2,2\n");
}
