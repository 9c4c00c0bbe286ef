// page_text.hpp: a page that was written, as text and as the charts it holds.
#pragma once
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

namespace calx_test {

/// All of a file.
inline std::string slurp(const std::string& path) {
  std::ostringstream all;
  all << std::ifstream(path).rdbuf();
  return all.str();
}

inline bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

/// The list of charts as chart.hpp writes it for the page's script.
inline nlohmann::json charts_of(const std::string& page) {
  const std::string open = "id=\"charts\">";
  const std::size_t from = page.find(open) + open.size();
  return nlohmann::json::parse(page.substr(from, page.find("</script>", from) - from));
}

}  // namespace calx_test
