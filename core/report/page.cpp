#include "report/page.hpp"

#include "report/assets.hpp"

namespace calx {

std::string html_text(const std::string& plain) {
  std::string out;
  out.reserve(plain.size());
  for (char c : plain) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

std::string html_table(const std::vector<std::vector<std::string>>& rows, std::size_t number_columns_from,
                       const std::string& css_class) {
  std::string out = "<div class=\"scroll\"><table" + (css_class.empty() ? "" : " class=\"" + css_class + "\"") + ">";
  for (std::size_t r = 0; r < rows.size(); ++r) {
    out += r == 0 ? "<thead><tr>" : r == 1 ? "<tbody><tr>" : "<tr>";
    const char* tag = r == 0 ? "th" : "td";
    for (std::size_t k = 0; k < rows[r].size(); ++k) {
      out +=
          std::string("<") + tag + (k >= number_columns_from ? " class=\"n\">" : ">") + rows[r][k] + "</" + tag + ">";
    }
    out += r == 0 ? "</tr></thead>" : "</tr>";
  }
  return out + (rows.size() > 1 ? "</tbody>" : "") + "</table></div>";
}

std::string html_card(const std::string& name, const std::string& value, const std::string& note,
                      const std::string& mood) {
  return "<div class=\"card " + mood + "\"><span class=\"name\">" + name + "</span><span class=\"value\">" + value +
         "</span><span class=\"note\">" + note + "</span></div>";
}

std::string html_check(const std::string& mood, const std::string& what, const std::string& text) {
  return "<li class=\"" + mood + "\"><b>" + what + "</b> " + text + "</li>";
}

std::string html_absent(const std::string& why) { return "<p class=\"absent\">" + html_text(why) + "</p>"; }

std::string Page::chart(const Chart& chart) {
  if (chart_count_ == 0) charts_.begin_array();
  write_json(charts_, chart);
  std::string out = "<figure class=\"chart" + std::string(chart.wide ? " wide" : "") + "\"><h3>" +
                    html_text(chart.title) + "</h3><div class=\"plot\" data-chart=\"" + std::to_string(chart_count_) +
                    "\"></div>";
  ++chart_count_;
  if (!chart.caption.empty()) out += "<figcaption>" + chart.caption + "</figcaption>";
  return out + "</figure>";
}

void Page::section(const std::string& id, const std::string& heading, const std::string& in_menu,
                   const std::string& content) {
  sections_.push_back({id, heading, in_menu, content});
}

void Page::playback(const std::string& playback_json, const std::string& frames) {
  playback_json_ = playback_json;
  frames_ = frames;
}

std::string Page::html() const {
  std::string out;
  out.reserve(frames_.size() + charts_.text().size() + 2000000);
  // The policy makes the browser refuse every request, so that the page shows the same with and without a network.
  out +=
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; img-src data: blob:; "
      "style-src 'unsafe-inline'; script-src 'unsafe-inline'\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>";
  out += html_text(title_) + "</title>\n<style>\n";
  out += asset_style();
  out += "</style></head>\n<body>\n<header>" + header_ + "</header>\n<nav>";
  for (const Section& s : sections_) {
    if (!s.menu.empty()) out += "<a href=\"#" + s.id + "\">" + html_text(s.menu) + "</a>";
  }
  out += "</nav>\n<main>\n";
  for (const Section& s : sections_) {
    out += "<section id=\"" + s.id + "\"><h2>" + html_text(s.heading) + "</h2>\n" + s.content + "\n</section>\n";
  }
  out +=
      "</main>\n<footer>Written by calx. Contains three.js (MIT licence, three.js authors) and D3 (BSD 3-clause "
      "licence, Michael Bostock). This page makes no network request.</footer>\n";
  out += "<script type=\"application/json\" id=\"charts\">" + (chart_count_ > 0 ? charts_.text() + "]" : "[]") +
         "</script>\n<script>\n";
  out += asset_d3();
  out += "\n</script>\n<script>\n";
  out += asset_charts();
  out += "</script>\n";
  if (!playback_json_.empty()) {
    out += "<script type=\"application/json\" id=\"playback-data\">" + playback_json_ +
           "</script>\n<script type=\"text/plain\" id=\"frames\">" + frames_ + "</script>\n<script>\n";
    out += asset_three();
    out += "\n</script>\n<script>\n";
    out += asset_orbit();
    out += "\n</script>\n<script>\n";
    out += asset_viewer();
    out += "</script>\n";
  }
  return out + "</body></html>\n";
}

}  // namespace calx
