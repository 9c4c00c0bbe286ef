// Statistics, units, series, JSON text: what the figures of a report rest on.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "report/chart.hpp"
#include "report/key_figures.hpp"
#include "report/series_csv.hpp"
#include "report/statistics.hpp"
#include "report/units.hpp"

using namespace calx;

TEST_CASE("mean and sample standard deviation leave out what is not a number") {
  const Spread s = spread_of({2, 4, std::nan(""), 4, 4, 5, 5, 7, 9});
  CHECK(s.count == 8);
  CHECK(s.mean == doctest::Approx(5));
  CHECK(s.deviation == doctest::Approx(std::sqrt(32.0 / 7)));
  CHECK(spread_of({3}).deviation == 0);
  CHECK(spread_of({}).count == 0);
}

TEST_CASE("a straight line is found with its R squared") {
  const LinearFit exact = fit_line({1, 2, 3, 4}, {3, 5, 7, 9});
  CHECK(exact.slope == doctest::Approx(2));
  CHECK(exact.intercept == doctest::Approx(1));
  CHECK(exact.r_squared == doctest::Approx(1));
  // x 1..5, y 2 4 5 4 5: slope 0.6, intercept 2.2, R squared 0.6.
  const LinearFit rough = fit_line({1, 2, 3, 4, 5}, {2, 4, 5, 4, 5});
  CHECK(rough.slope == doctest::Approx(0.6));
  CHECK(rough.intercept == doctest::Approx(2.2));
  CHECK(rough.r_squared == doctest::Approx(0.6));
  CHECK_FALSE(fit_line({1, 1}, {2, 3}).possible);
}

TEST_CASE("column names give title and unit") {
  CHECK(quantity_of("mass_kg").title == "mass");
  CHECK(quantity_of("mass_kg").unit == "kg");
  CHECK(quantity_of("torque_y_N_m").unit == "N m");
  CHECK(quantity_of("torque_y_N_m").title == "torque y");
  CHECK(quantity_of("density_kg_m3").unit == "kg/m3");
  CHECK(quantity_of("rate_kg_s").unit == "kg/s");
  CHECK(quantity_of("solid_fraction_1").unit == "");
  CHECK(quantity_of("solid_fraction_1").title == "solid fraction");
  CHECK(quantity_of("something_else").title == "something else");
}

TEST_CASE("quantities are shown with a readable prefix") {
  CHECK(format_quantity(2.18276, "kg", 5) == "2.1828\xc2\xa0kg");
  CHECK(format_quantity(0.05456, "kg") == "54.56\xc2\xa0g");
  CHECK(format_quantity(6.05e-6, "s") == "6.05\xc2\xa0us");
  CHECK(format_quantity(0.0025, "m") == "2.5\xc2\xa0mm");
  CHECK(format_quantity(15000, "Pa") == "15\xc2\xa0kPa");
  CHECK(format_quantity(std::nan(""), "kg") == "-");
  CHECK(format_count(3884297) ==
        "3\xc2\xa0"
        "884\xc2\xa0"
        "297");
  CHECK(format_count(-1000) ==
        "-1\xc2\xa0"
        "000");
  CHECK(format_count(999) == "999");
}

TEST_CASE("a series that is being written loses only its last, cut row") {
  const SeriesTable t = parse_series("time_s,mass_kg,centre_x_m\n0,0,nan\n0.5,1.25,-0.03\n1,2");
  REQUIRE(t.columns == std::vector<std::string>{"mass_kg", "centre_x_m"});
  REQUIRE(t.time == std::vector<double>{0, 0.5});
  CHECK(t.values[0][1] == 1.25);
  CHECK(std::isnan(t.values[1][0]));
  CHECK(t.values[1][1] == -0.03);
  CHECK(parse_series("").time.empty());
  CHECK(parse_series("time_s,mass_kg").columns.size() == 1);
}

TEST_CASE("long series are thinned out without losing a peak") {
  std::vector<double> x, y;
  for (int k = 0; k < 10000; ++k) x.push_back(k), y.push_back(k == 7777 ? 50 : std::sin(0.01 * k));
  thin_out(x, y, 1000);
  CHECK(x.size() <= 1002);
  CHECK(x.size() == y.size());
  CHECK(x.front() == 0);
  CHECK(x.back() == 9999);
  CHECK(std::find(y.begin(), y.end(), 50.0) != y.end());
  CHECK(std::is_sorted(x.begin(), x.end()));
}

TEST_CASE("a chart is valid JSON that cannot end its script element") {
  Chart chart;
  chart.title = "</script> \"quoted\"\n";
  chart.series.push_back({ChartSeries::Style::bars, "a", {1, 2}, {0.5, std::nan("")}, {}, 0});
  chart.bands.push_back({0.5, 0.1, "mean"});
  JsonText text;
  write_json(text, chart);
  CHECK(text.text().find("</") == std::string::npos);
  const auto json = nlohmann::json::parse(text.text());
  CHECK(json["title"] == chart.title);
  CHECK(json["series"][0]["style"] == "bars");
  CHECK(json["series"][0]["y"][0] == 0.5);
  CHECK(json["series"][0]["y"][1].is_null());
  CHECK(json["bands"][0]["sd"] == 0.1);
}

TEST_CASE("statistics of the dose leave out the first two of many cycles and repeated rows") {
  SensorSeries s;
  s.columns = {"cycle_1", "mass_kg", "total_kg"};
  s.values = {{0, 1, 1, 2, 3, 4, 5, 5},
              {0, 0.02, 0.02, 0.04, 0.05, 0.06, 0.055, 0.055},
              {0, 0.02, 0.02, 0.06, 0.11, 0.17, 0.225, 0.225}};
  s.time = {0, 1, 2, 3, 4, 5, 6, 7};
  const CycleFigures c = cycle_figures(s);
  CHECK(c.cycle == std::vector<double>{1, 2, 3, 4, 5});
  CHECK(c.first == 3);
  CHECK(c.per_cycle.count == 3);
  CHECK(c.per_cycle.mean == doctest::Approx(0.055));
  CHECK(c.per_cycle.deviation == doctest::Approx(0.005));
  CHECK(c.line.slope == doctest::Approx(0.0575));
}

TEST_CASE("the mass ledger closes only when counts agree") {
  RunFolder run;
  CHECK(key_figures(run).ledger == KeyFigures::Closed::unknown);
  run.mass = {{"inserted_particles", 100}, {"inside_particles", 97}, {"left_particles", 3}};
  CHECK(key_figures(run).ledger == KeyFigures::Closed::yes);
  run.mass[1].value = 96;
  CHECK(key_figures(run).ledger == KeyFigures::Closed::no);
  CHECK(key_figures(run).ledger_text == "100 inserted = 96 inside + 3 left does not hold");
}
