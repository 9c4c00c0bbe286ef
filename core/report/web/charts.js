// Draws the charts described in the script element "charts" (see chart.hpp) as SVG with D3 version 3.
// Hover shows values; dragging in an xy or stack chart enlarges that stretch, a double click shows all again.
(function () {
  "use strict";
  var palette = ["#1f6f8b", "#d97a2b", "#5b8c3e", "#8f4f96", "#b8902a", "#4c5f7a", "#c2483f", "#3d9a8b"];
  var mapColours = ["#f7f4ea", "#e9dcb4", "#d9b873", "#c08a45", "#96602f", "#5e3a24"];
  var charts = JSON.parse(document.getElementById("charts").textContent);
  var serial = 0;

  function number(v) {
    if (v === null || !isFinite(v)) return "-";
    var a = Math.abs(v);
    if (a !== 0 && (a < 1e-4 || a >= 1e7)) return v.toExponential(3);
    return String(+v.toPrecision(5));
  }
  function axisTitle(axis) { return axis.title + (axis.unit ? ", " + axis.unit : ""); }
  function colourOf(series, i) { return palette[(series.colour === undefined ? i : series.colour) % palette.length]; }
  function finite(v) { return v !== null && isFinite(v); }
  function tickText(scale, count) {
    var format = scale.tickFormat(count), domain = scale.domain();
    var a = Math.max(Math.abs(domain[0]), Math.abs(domain[1]));
    return a !== 0 && (a < 1e-3 || a >= 1e6) ? function (v) { return v === 0 ? "0" : String(+v.toPrecision(3)); }
      : function (v) { return format(v).replace(/,/g, "\u00a0"); };
  }
  function text(html) { return String(html).replace(/&/g, "&amp;").replace(/</g, "&lt;"); }

  function frame(node, spec, width, height, margin) {
    node.innerHTML = "";
    var svg = d3.select(node).append("svg").attr("viewBox", "0 0 " + width + " " + height)
      .attr("width", width).attr("height", height).attr("role", "img").attr("aria-label", spec.title);
    var inner = svg.append("g").attr("transform", "translate(" + margin.left + "," + margin.top + ")");
    return { svg: svg, inner: inner, w: width - margin.left - margin.right, h: height - margin.top - margin.bottom };
  }

  function legend(node, spec) {
    if (spec.series.length < 2) return;
    var box = document.createElement("div");
    box.className = "legend";
    box.innerHTML = spec.series.map(function (s, i) {
      return "<span><i" + (s.style === "points" ? " class=\"dot\"" : "") + " style=\"background:" + colourOf(s, i) + "\"></i>" + text(s.name) + "</span>";
    }).join("");
    node.insertBefore(box, node.firstChild);
  }

  function tooltip(node) {
    var tip = document.createElement("div");
    tip.className = "tip";
    node.appendChild(tip);
    return {
      show: function (html, x, y) {
        tip.innerHTML = html;
        tip.style.display = "block";
        var left = x + 16;
        if (left + tip.offsetWidth > node.clientWidth) left = x - tip.offsetWidth - 12;
        tip.style.left = Math.max(0, left) + "px";
        tip.style.top = Math.max(0, y - 10) + "px";
      },
      hide: function () { tip.style.display = "none"; }
    };
  }

  // Positive values pile up above zero, negative ones below.
  function stacked(spec) {
    var n = spec.series.length ? spec.series[0].x.length : 0, up = [], down = [], i;
    for (i = 0; i < n; ++i) { up.push(0); down.push(0); }
    return spec.series.map(function (s) {
      return s.x.map(function (x, k) {
        var v = s.y[k] || 0, base = v >= 0 ? up : down, from = base[k];
        base[k] += v;
        return { x: x, a: from, b: base[k] };
      });
    });
  }

  function extents(spec, layers) {
    var xs = [Infinity, -Infinity], ys = [Infinity, -Infinity];
    function add(range, v) { if (finite(v)) { range[0] = Math.min(range[0], v); range[1] = Math.max(range[1], v); } }
    spec.series.forEach(function (s, i) {
      s.x.forEach(function (x, k) {
        add(xs, x);
        var e = s.error ? s.error[k] : 0;
        if (layers) { add(ys, layers[i][k].a); add(ys, layers[i][k].b); } else if (finite(s.y[k])) { add(ys, s.y[k] - e); add(ys, s.y[k] + e); }
      });
    });
    (spec.bands || []).forEach(function (b) { add(ys, b.mean - b.sd); add(ys, b.mean + b.sd); });
    if (spec.x.zero) add(xs, 0);
    if (spec.y.zero || spec.series.some(function (s) { return s.style === "bars"; })) add(ys, 0);
    if (xs[0] > xs[1]) xs = [0, 1];
    if (ys[0] > ys[1]) ys = [0, 1];
    if (xs[0] === xs[1]) { xs[0] -= 0.5; xs[1] += 0.5; }
    if (ys[0] === ys[1]) { var d = Math.abs(ys[0]) * 0.1 || 1; ys[0] -= ys[0] === 0 ? 0 : d; ys[1] += d; }
    if (spec.series.some(function (s) { return s.style === "bars"; })) { xs[0] -= 0.6; xs[1] += 0.6; }
    if (spec.series.some(function (s) { return s.style === "points"; })) {
      // Room for whole dots at the ends.
      var room = 0.025 * (xs[1] - xs[0]);
      xs = spec.x.log ? [xs[0] * 0.9, xs[1] * 1.1] : [xs[0] === 0 ? 0 : xs[0] - room, xs[1] + room];
    }
    if (spec.x.categories) xs = [-0.5, spec.x.categories.length - 0.5];
    return { x: xs, y: ys };
  }

  function axes(f, spec, x, y, bare) {
    var xTicks = Math.max(3, Math.min(12, Math.round(f.w / 75))), yTicks = Math.max(2, Math.min(8, Math.round(f.h / 42)));
    var xAxis = d3.svg.axis().scale(x).orient("bottom").ticks(xTicks).tickSize(bare ? 4 : -f.h, 0).tickPadding(7).tickFormat(tickText(x, xTicks));
    if (spec.x.log) {
      // 1, 2 and 5 of each decade.
      var low = x.domain()[0], high = x.domain()[1], at = [];
      for (var e = Math.floor(Math.log(low) / Math.LN10); Math.pow(10, e) <= high; ++e) {
        [1, 2, 5].forEach(function (m) { var v = +(m * Math.pow(10, e)).toPrecision(3); if (v >= low && v <= high) at.push(v); });
      }
      xAxis.tickValues(at).tickFormat(number);
    } else if (spec.x.categories) {
      xAxis.tickValues(d3.range(spec.x.categories.length)).tickFormat(function (v) { return spec.x.categories[v]; });
    } else if (spec.kind === "xy" && spec.x.title === "cycle") {
      xAxis.tickValues(x.ticks(xTicks).filter(function (v) { return v % 1 === 0; })).tickFormat(d3.format("d"));
    }
    var yAxis = d3.svg.axis().scale(y).orient("left").ticks(yTicks).tickSize(bare ? 4 : -f.w, 0).tickPadding(6).tickFormat(tickText(y, yTicks));
    f.inner.select("g.x.axis").call(xAxis);
    f.inner.select("g.y.axis").call(yAxis);
    if (bare) f.inner.selectAll("g.x.axis, g.y.axis").classed("bare", true);
  }

  function axisFrame(f, spec, margin) {
    f.inner.append("g").attr("class", "y axis");
    f.inner.append("g").attr("class", "x axis").attr("transform", "translate(0," + f.h + ")");
    f.inner.append("text").attr("class", "axis-title").attr("text-anchor", "middle").attr("x", f.w / 2).attr("y", f.h + 38)
      .text(axisTitle(spec.x));
    f.inner.append("text").attr("class", "axis-title").attr("text-anchor", "middle")
      .attr("transform", "translate(" + (14 - margin.left) + "," + f.h / 2 + ") rotate(-90)").text(axisTitle(spec.y));
  }

  function marks(g, spec, x, f) {
    g.selectAll("*").remove();
    // A label goes to the first of three rows where it does not run into the one before; without room it is left out and
    // stays readable on hover.
    var free = [-1e9, -1e9, -1e9];
    (spec.marks || []).forEach(function (m) {
      var at = x(m.at), wide = m.name.length * 6.1 + 8;
      if (at < -0.5 || at > f.w + 0.5) return;
      var end = at + wide > f.w, from = end ? at - wide : at, row = 0;
      while (row < 3 && from < free[row]) ++row;
      var mark = g.append("g").attr("class", "mark").attr("transform", "translate(" + at + ",0)");
      mark.append("line").attr("y1", row < 3 ? -4 - 13 * row : 0).attr("y2", f.h);
      mark.append("title").text(m.name + ", " + number(m.at));
      if (row < 3) {
        free[row] = from + wide;
        mark.append("text").attr("x", end ? -4 : 4).attr("y", -5 - 13 * row).attr("text-anchor", end ? "end" : "start").text(m.name);
      }
    });
  }

  function drawSeries(g, spec, x, y, f, layers) {
    g.selectAll("*").remove();
    (spec.bands || []).forEach(function (b) {
      g.append("rect").attr("x", 0).attr("width", f.w).attr("y", y(b.mean + b.sd)).attr("height", Math.max(1, y(b.mean - b.sd) - y(b.mean + b.sd)))
        .attr("fill", palette[1]).attr("opacity", 0.22);
      [b.mean - b.sd, b.mean + b.sd].forEach(function (v) {
        g.append("line").attr("x1", 0).attr("x2", f.w).attr("y1", y(v)).attr("y2", y(v)).attr("stroke", palette[1]).attr("stroke-dasharray", "2 3");
      });
    });
    spec.series.forEach(function (s, i) {
      var colour = colourOf(s, i), rows = d3.range(s.x.length);
      var ok = function (k) { return finite(s.y[k]); }, px = function (k) { return x(s.x[k]); }, py = function (k) { return y(s.y[k]); };
      if (layers) {
        g.append("path").datum(layers[i]).attr("fill", colour).attr("opacity", 0.85).attr("d", d3.svg.area()
          .x(function (d) { return x(d.x); }).y0(function (d) { return y(d.a); }).y1(function (d) { return y(d.b); }));
      } else if (s.style === "bars") {
        var step = Math.abs(x(1) - x(0)), wide = Math.max(1.5, Math.min(40, step * 0.7));
        g.selectAll("rect.bar" + i).data(rows.filter(ok)).enter().append("rect").attr("x", function (k) { return px(k) - wide / 2; })
          .attr("width", wide).attr("y", function (k) { return Math.min(py(k), y(0)); })
          .attr("height", function (k) { return Math.abs(py(k) - y(0)); }).attr("fill", colour).attr("opacity", 0.85).attr("rx", 1.5);
      } else if (s.style === "points") {
        var many = rows.length > 25;
        if (s.error) {
          g.selectAll("path.error" + i).data(rows.filter(ok)).enter().append("path").attr("stroke", colour).attr("stroke-width", 1.6).attr("d", function (k) {
            var a = y(s.y[k] - s.error[k]), b = y(s.y[k] + s.error[k]), c = px(k), cap = many ? 2 : 7;
            return "M" + (c - cap) + " " + a + "h" + 2 * cap + "M" + c + " " + a + "V" + b + "M" + (c - cap) + " " + b + "h" + 2 * cap;
          });
        }
        g.selectAll("circle.p" + i).data(rows.filter(ok)).enter().append("circle").attr("cx", px).attr("cy", py)
          .attr("r", s.error && !many ? 5 : 3.2).attr("fill", colour);
      } else {
        if (s.style === "band") {
          g.append("path").datum(rows).attr("fill", colour).attr("opacity", 0.16).attr("d", d3.svg.area().defined(ok).x(px)
            .y0(function (k) { return y(s.y[k] - s.error[k]); }).y1(function (k) { return y(s.y[k] + s.error[k]); }));
        }
        if (s.style === "area") {
          g.append("path").datum(rows).attr("fill", colour).attr("opacity", 0.16)
            .attr("d", d3.svg.area().defined(ok).x(px).y0(Math.max(0, Math.min(f.h, y(0)))).y1(py));
        }
        g.append("path").datum(rows).attr("fill", "none").attr("stroke", colour)
          .attr("stroke-width", isRough(s) ? 1.1 : 1.8).attr("stroke-linejoin", "round")
          .attr("stroke-dasharray", s.style === "dashed" ? "7 4" : null).attr("d", d3.svg.line().defined(ok).x(px).y(py));
        // A value between two gaps is no line; a dot keeps it visible.
        if (rows.filter(ok).length === 1) g.append("circle").attr("cx", px(rows.filter(ok)[0])).attr("cy", py(rows.filter(ok)[0])).attr("r", 3).attr("fill", colour);
      }
    });
    (spec.bands || []).forEach(function (b) {
      g.append("line").attr("x1", 0).attr("x2", f.w).attr("y1", y(b.mean)).attr("y2", y(b.mean)).attr("stroke", palette[1]).attr("stroke-width", 1.8);
    });
  }

  // A line that goes up and down all the time would fill its chart with ink.
  function isRough(s) {
    var way = 0, low = Infinity, high = -Infinity;
    s.y.forEach(function (v, k) {
      if (!finite(v)) return;
      low = Math.min(low, v);
      high = Math.max(high, v);
      if (k > 0 && finite(s.y[k - 1])) way += Math.abs(v - s.y[k - 1]);
    });
    return way > 15 * (high - low);
  }

  function nearest(s, at) {
    var low = 0, high = s.x.length - 1;
    while (high - low > 1) { var mid = (low + high) >> 1; if (s.x[mid] <= at) low = mid; else high = mid; }
    return Math.abs(s.x[high] - at) < Math.abs(s.x[low] - at) ? high : low;
  }

  function xy(node, spec) {
    var width = Math.max(280, node.clientWidth), layers = spec.kind === "stack" ? stacked(spec) : null;
    var range = extents(spec, layers), rows = (spec.marks || []).length;
    var margin = { left: 62, right: 14, top: rows > 0 ? 46 : 12, bottom: 48 };
    var height = width > 700 ? 380 : 300;
    var x = (spec.x.log ? d3.scale.log() : d3.scale.linear()).domain(range.x), y = d3.scale.linear().domain(range.y);
    if (spec.equal) {
      var per = (width - margin.left - margin.right) / (range.x[1] - range.x[0]), high = per * (range.y[1] - range.y[0]) * 1.08;
      if (high > 420) { per *= 420 / high; high = 420; }
      var middle = (range.x[0] + range.x[1]) / 2, half = (width - margin.left - margin.right) / per / 2;
      high = Math.max(high, 120);
      height = high + margin.top + margin.bottom;
      x.domain([middle - half, middle + half]);
      y.domain([range.y[0], range.y[0] + high / per]);
    }
    if (!spec.equal) {
      if (range.y[0] !== 0) y.domain([range.y[0] - 0.04 * (range.y[1] - range.y[0]), range.y[1]]);
      y.domain([y.domain()[0], y.domain()[1] + 0.06 * (range.y[1] - range.y[0])]).nice();
      // Room for long numbers, so that they do not run into the title of the axis.
      margin.left = Math.max(margin.left, 30 + 7 * d3.max(y.ticks(8).map(tickText(y, 8)), function (s) { return s.length; }));
    }
    var f = frame(node, spec, width, height, margin);
    x.range([0, f.w]);
    y.range([f.h, 0]);
    legend(node, spec);
    axisFrame(f, spec, margin);
    var id = "clip" + (++serial);
    f.svg.append("defs").append("clipPath").attr("id", id).append("rect").attr("width", f.w).attr("height", f.h + 2).attr("y", -2);
    var lines = f.inner.append("g").attr("class", "series").attr("clip-path", "url(#" + id + ")"), markLayer = f.inner.append("g");
    var cursor = f.inner.append("line").attr("y2", f.h).attr("stroke", "#9aa5b1").style("display", "none").style("pointer-events", "none");
    var whole = x.domain();
    function redraw() {
      axes(f, spec, x, y);
      drawSeries(lines, spec, x, y, f, layers);
      marks(markLayer, spec, x, f);
    }
    redraw();

    var tip = tooltip(node), offset = function () { return f.svg.node().offsetTop || 0; };
    var brush = d3.svg.brush().x(x).on("brushend", function () {
      if (brush.empty() || spec.equal || spec.x.categories) { brushLayer.call(brush.clear()); return; }
      var part = brush.extent();
      brushLayer.call(brush.clear());
      x.domain(part);
      redraw();
    });
    var brushLayer = f.inner.append("g").attr("class", "brush").call(brush);
    brushLayer.selectAll("rect").attr("height", f.h);
    brushLayer.on("mousemove.tip", function () {
      var at = d3.mouse(f.inner.node()), value = x.invert(at[0]), lead = null;
      var body = spec.series.map(function (s, i) {
        if (!s.x.length) return "";
        var k = nearest(s, value);
        if (s.style === "dashed") {
          var share = (value - s.x[0]) / (s.x[s.x.length - 1] - s.x[0]);
          return "<br>" + text(s.name) + " " + number(s.y[0] + share * (s.y[s.y.length - 1] - s.y[0]));
        }
        if (lead === null) lead = s.x[k];
        return "<br><span style=\"color:" + colourOf(s, i) + "\">\u25cf</span> " + text(s.name) + " <b>" + number(s.y[k]) + "</b> " + text(spec.y.unit) +
          (s.error ? " \u00b1 " + number(s.error[k]) : "");
      }).join("");
      if (lead === null) return;
      cursor.style("display", null).attr("x1", x(lead)).attr("x2", x(lead));
      var head = spec.x.categories ? spec.x.categories[Math.round(lead)] : spec.x.title + " " + number(lead) + " " + spec.x.unit;
      tip.show(text(head) + body, at[0] + margin.left, at[1] + margin.top + offset());
    }).on("mouseleave.tip", function () { tip.hide(); cursor.style("display", "none"); })
      .on("dblclick", function () { x.domain(whole); redraw(); });
  }

  function map(node, spec) {
    var width = Math.max(280, node.clientWidth), margin = { left: 62, right: 92, top: 12, bottom: 48 };
    var wide = width - margin.left - margin.right, per = wide / (spec.nx * spec.cell), high = per * spec.ny * spec.cell;
    if (high > 420) { per *= 420 / high; high = 420; wide = per * spec.nx * spec.cell; }
    width = wide + margin.left + margin.right;
    var f = frame(node, spec, width, high + margin.top + margin.bottom, margin);
    f.svg.style("width", width + "px").style("max-width", "100%").style("margin", "0 auto");
    var x = d3.scale.linear().domain([spec.x0, spec.x0 + spec.nx * spec.cell]).range([0, f.w]);
    var y = d3.scale.linear().domain([spec.y0, spec.y0 + spec.ny * spec.cell]).range([f.h, 0]);
    axisFrame(f, spec, margin);
    var values = spec.values.filter(finite), low = d3.min(values), top = d3.max(values);
    if (low === undefined) { low = 0; top = 1; }
    if (low === top) top = low + 1;
    var colour = d3.scale.linear().domain(mapColours.map(function (c, i) { return low + (top - low) * i / (mapColours.length - 1); })).range(mapColours);
    var canvas = document.createElement("canvas");
    canvas.width = spec.nx;
    canvas.height = spec.ny;
    var pen = canvas.getContext("2d");
    spec.values.forEach(function (v, k) {
      if (!finite(v)) return;
      pen.fillStyle = colour(v);
      pen.fillRect(k % spec.nx, spec.ny - 1 - Math.floor(k / spec.nx), 1, 1);
    });
    axes(f, spec, x, y, true);
    f.inner.append("image").attr("width", f.w).attr("height", f.h).attr("preserveAspectRatio", "none").attr("href", canvas.toDataURL())
      .style("image-rendering", "pixelated");
    var bar = f.inner.append("g").attr("transform", "translate(" + (f.w + 18) + ",0)"), id = "shade" + (++serial);
    var shade = f.svg.append("defs").append("linearGradient").attr("id", id).attr("x1", 0).attr("x2", 0).attr("y1", 1).attr("y2", 0);
    mapColours.forEach(function (c, i) { shade.append("stop").attr("offset", 100 * i / (mapColours.length - 1) + "%").attr("stop-color", c); });
    bar.append("rect").attr("width", 14).attr("height", f.h).attr("fill", "url(#" + id + ")").attr("stroke", "#9aa5b1").attr("stroke-width", 0.5);
    var scale = d3.scale.linear().domain([low, top]).range([f.h, 0]);
    bar.append("g").attr("class", "axis bare").attr("transform", "translate(14,0)")
      .call(d3.svg.axis().scale(scale).orient("right").ticks(6).tickSize(4, 0).tickPadding(4).tickFormat(tickText(scale, 6)));
    bar.append("text").attr("class", "axis-title").attr("text-anchor", "middle")
      .attr("transform", "translate(66," + f.h / 2 + ") rotate(-90)").text(axisTitle(spec.value));
    var tip = tooltip(node);
    f.inner.append("rect").attr("width", f.w).attr("height", f.h).attr("fill", "transparent").on("mousemove", function () {
      var at = d3.mouse(this), i = Math.floor(at[0] / f.w * spec.nx), j = Math.floor((1 - at[1] / f.h) * spec.ny), v = spec.values[j * spec.nx + i];
      tip.show("x " + number(x.invert(at[0])) + ", y " + number(y.invert(at[1])) + " " + text(spec.x.unit) + "<br>" + text(spec.value.title) + " <b>" +
        (finite(v) ? number(v) + "</b> " + text(spec.value.unit) : "empty</b>"), at[0] + margin.left + f.svg.node().offsetLeft, at[1] + margin.top);
    }).on("mouseleave", tip.hide);
  }

  function drawAll() {
    Array.prototype.forEach.call(document.querySelectorAll(".plot"), function (node) {
      var spec = charts[+node.getAttribute("data-chart")];
      if (spec.kind === "map") map(node, spec); else xy(node, spec);
    });
  }
  drawAll();
  var timer = null, lastWidth = window.innerWidth;
  window.addEventListener("resize", function () {
    if (window.innerWidth === lastWidth) return;
    lastWidth = window.innerWidth;
    clearTimeout(timer);
    timer = setTimeout(drawAll, 200);
  });
}());
