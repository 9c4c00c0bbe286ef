#include <doctest/doctest.h>

#include <cmath>
#include <string>

#include "base/error.hpp"
#include "study/table.hpp"

namespace calx {

TEST_CASE("a table is read with its lines, comments and empty cells") {
  const Table t = parse_table("\xef\xbb\xbf# lab 3\n\"run\", time_s\r\n1,2.5\r\n\n2,\n", "a.csv");
  CHECK(t.columns == std::vector<std::string>{"run", "time_s"});
  REQUIRE(t.rows.size() == 2);
  CHECK(t.rows[0] == std::vector<double>{1, 2.5});
  CHECK(std::isnan(t.rows[1][1]));
  CHECK(t.lines == std::vector<std::size_t>{3, 5});
  CHECK_THROWS_WITH_AS(parse_table("a,b\n1,2,3\n", "a.csv"), "a.csv line 2: holds 3 values; the header names 2 columns",
                       Error);
}

}  // namespace calx
