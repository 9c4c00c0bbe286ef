// Stills, the section through the apparatus and the playback.
#include <algorithm>

#include "base/error.hpp"
#include "report/playback.hpp"
#include "report/section_picture.hpp"
#include "report/sections.hpp"
#include "report/units.hpp"

namespace calx {
namespace {

std::string speed_bar(double highest) {
  std::string stops;
  for (int k = 0; k <= 10; ++k) stops += (k > 0 ? "," : "") + speed_colour(k / 10.0);
  // The scale goes with the square root of the speed, so the middle of the bar is a quarter of the highest speed.
  return "<div class=\"speed-bar\"><i style=\"background:linear-gradient(90deg," + stops +
         ")\"></i><span>0</span><span>" + format_number(highest / 4, 3) + "</span><span>" + format_number(highest, 3) +
         " m/s</span></div>";
}

const char* const playback_html = R"(<div id="viewer" class="viewer"><div class="stage"><canvas></canvas>
<div class="clock"></div><div class="hint">drag: turn &middot; wheel: zoom &middot; right drag: move</div></div>
<div class="controls">
<div class="line"><button id="play" type="button" aria-label="Play or pause">&#9654;</button>
<input id="slider" type="range" min="0" max="1000" value="0" step="1" aria-label="Time"></div>
<div class="line"><label>Speed <select id="rate"><option value="0.02">0.02 &times;</option><option value="0.1">0.1 &times;</option>
<option value="0.25">0.25 &times;</option><option value="0.5">0.5 &times;</option><option value="1" selected>1 &times;</option>
<option value="2">2 &times;</option><option value="5">5 &times;</option></select></label>
<label>Colour <select id="colour"><option value="speed" selected>speed</option><option value="radius">radius</option>
<option value="none">none</option></select></label>
<label>Cut <select id="cut"><option value="none">none</option><option value="parts" selected>parts</option>
<option value="all">parts and grains</option></select></label>
<label>at <input id="cut-angle" type="range" min="0" max="360" value="0" step="1" aria-label="Angle of the cut"></label>
<label>Parts <input id="opacity" type="range" min="0" max="100" value="100" step="1" aria-label="Opacity of parts"></label>
<label><input id="smooth" type="checkbox"> move smoothly between frames</label></div>
<div class="line" id="views">View <button type="button" data-view="front">front</button><button type="button"
 data-view="side">side</button><button type="button" data-view="top">top</button><button type="button"
 data-view="oblique">oblique</button></div>
<div class="line chips" id="parts"></div></div><div id="scale"></div></div>)";

}  // namespace

void Sections::pictures() {
  const std::size_t count = run.frames.times.size();
  if (count == 0) {
    page.section(
        "pictures", "Pictures", "Pictures",
        html_absent("No pictures: particles.h5 is not there, or holds no frame. Set output/frames_every in the case."));
    return;
  }
  std::string out;
  try {
    const Playback playback = pack_playback(run);
    page.playback(playback.json, playback.frames);
    out += "<h3>Moments</h3><div id=\"stills\" class=\"stills\"></div>";
    out += "<h3 class=\"screen\">Playback</h3>" + std::string(playback_html);
    if (!playback.note.empty()) out += "<p class=\"note\">" + html_text(playback.note) + "</p>";

    std::string sections;
    double highest = 0;
    for (std::size_t number : spaced_frames(count, 3)) {
      const FrameData frame = read_frame(run.dir, number);
      for (float v : frame.speed) highest = std::max(highest, static_cast<double>(v));
    }
    for (std::size_t number : spaced_frames(count, 3)) {
      const SectionPicture picture = draw_section(run.frames, read_frame(run.dir, number), run.gravity, highest);
      if (picture.svg.empty()) continue;
      sections += "<figure>" + picture.svg + "<figcaption>t = " + format_quantity(run.frames.times[number], "s", 4) +
                  ", " + format_count(static_cast<double>(picture.spheres)) + " spheres</figcaption></figure>";
    }
    if (!sections.empty()) {
      out += "<h3>Section</h3><div class=\"stills\">" + sections + "</div>" + speed_bar(highest) +
             "<p class=\"note\">Spheres up to one diameter behind the plane through the middle of the apparatus, "
             "coloured by speed; lines: "
             "the parts where the plane cuts them.</p>";
    }
  } catch (const Error& e) {
    out = html_absent(std::string("No pictures: particles.h5 could not be read: ") + e.what());
  }
  page.section("pictures", "Pictures and playback", "Pictures", out);
}

}  // namespace calx
