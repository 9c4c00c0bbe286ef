// page.hpp: puts sections, charts and the browser's parts together into one HTML text without outside references.
#pragma once
#include <string>
#include <vector>

#include "report/chart.hpp"

namespace calx {

/// Text made safe for HTML content and attribute values.
std::string html_text(const std::string& plain);

/// One row of cells per entry; the first row is the head. Cells are HTML. Columns from number_columns_from on are
/// aligned right, as numbers are.
std::string html_table(const std::vector<std::vector<std::string>>& rows, std::size_t number_columns_from,
                       const std::string& css_class = "");

/// A figure in a card of the header. name, value, note: HTML. mood: "good", "bad", "main" or "".
std::string html_card(const std::string& name, const std::string& value, const std::string& note,
                      const std::string& mood = "");

/// One entry of <ul class="checks">. mood: "good", "bad" or "open"; what, text: HTML.
std::string html_check(const std::string& mood, const std::string& what, const std::string& text);

/// A sentence that says why something is absent.
std::string html_absent(const std::string& why);

class Page {
 public:
  explicit Page(std::string title) : title_(std::move(title)) {}
  /// Keeps the chart and returns the figure element it will be drawn in.
  std::string chart(const Chart& chart);
  /// content: HTML. in_menu: the short name in the page's menu; empty: not there.
  void section(const std::string& id, const std::string& heading, const std::string& in_menu,
               const std::string& content);
  void header(const std::string& content) { header_ = content; }
  /// playback_json: meta data of the playback ("" when there is none); frames: base64, one line per frame.
  void playback(const std::string& playback_json, const std::string& frames);
  std::string html() const;

 private:
  struct Section {
    std::string id, heading, menu, content;
  };
  std::string title_, header_, playback_json_, frames_;
  std::vector<Section> sections_;
  JsonText charts_;
  std::size_t chart_count_ = 0;
};

}  // namespace calx
