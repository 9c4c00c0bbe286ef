// 3-D stills and playback of the embedded frames (see playback.hpp) with three.js. Grains are one draw call of shaded
// quads with the depth of a sphere: 60 000 of them at the rate of the screen. Both frames around the present moment lie
// on the graphics card, so moving between them costs nothing per grain.
(function () {
  "use strict";
  var data = JSON.parse(document.getElementById("playback-data").textContent);
  var lines = document.getElementById("frames").textContent.split("\n");
  var frames = data.frames, last = frames.length - 1;
  var element = function (id) { return document.getElementById(id); };
  var stage = document.querySelector("#viewer .stage"), canvas = stage.querySelector("canvas"), clock = stage.querySelector(".clock");
  // The anchors of section_picture.cpp: slow blue to fast red.
  var ramp = [[116, 142, 184], [52, 136, 178], [64, 172, 142], [166, 206, 96], [247, 192, 66], [212, 62, 42]];

  function bytes(base64) {
    var raw = atob(base64), out = new Uint8Array(raw.length);
    for (var i = 0; i < raw.length; ++i) out[i] = raw.charCodeAt(i);
    return out.buffer;
  }
  function short(v) { return String(+v.toPrecision(3)); }

  function refuse(why) {
    stage.innerHTML = "<p class=\"absent\"></p>";
    stage.firstChild.textContent = why;
    stage.style.height = "auto";
    document.querySelector("#viewer .controls").style.display = "none";
    element("stills").innerHTML = "<p class=\"absent\"></p>";
    element("stills").firstChild.textContent = why + " The section below needs none.";
  }
  var options = { antialias: true, alpha: true };
  var context = canvas.getContext("webgl2", options) || canvas.getContext("webgl", options);
  if (!context) return refuse("3-D pictures need WebGL, which this browser does not offer.");
  var renderer = new THREE.WebGLRenderer({ canvas: canvas, context: context, alpha: true, antialias: true });
  renderer.setClearColor(0x000000, 0);
  renderer.localClippingEnabled = true;

  var scene = new THREE.Scene(), camera = new THREE.PerspectiveCamera(24, 1, 0.01, 100);
  scene.add(new THREE.HemisphereLight(0xffffff, 0x8d949c, 0.72));
  var sun = new THREE.DirectionalLight(0xffffff, 0.5);
  scene.add(sun);

  // Axes of the picture: up against gravity, the front seen along the third axis, as in the section drawings.
  var up = 2;
  data.up.forEach(function (v, k) { if (Math.abs(v) > Math.abs(data.up[up])) up = k; });
  var sign = data.up[up] < 0 ? -1 : 1;
  function axis(k, length) { var v = new THREE.Vector3(); v.setComponent(k % 3, length); return v; }
  var vUp = axis(up, sign), vRight = axis(up + 1, 1), vDepth = axis(up + 2, 1);
  camera.up.copy(vUp);

  var lo = new THREE.Vector3().fromArray(data.lo), hi = new THREE.Vector3().fromArray(data.hi);
  var cut = new THREE.Plane(vDepth.clone(), 0);

  // ---- parts -----------------------------------------------------------------------------------------------------
  // Normals are shared across edges flatter than 35 degrees, so that cylinders look round and edges stay sharp.
  function softened(vertices, triangles) {
    var count = triangles.length, at = new Float32Array(3 * count), normals = new Float32Array(3 * count), faces = [], around = {};
    var a = new THREE.Vector3(), b = new THREE.Vector3(), c = new THREE.Vector3(), i, k;
    for (i = 0; i < count; i += 3) {
      for (k = 0; k < 3; ++k) at.set(vertices.subarray(3 * triangles[i + k], 3 * triangles[i + k] + 3), 3 * (i + k));
      a.fromArray(at, 3 * i); b.fromArray(at, 3 * i + 3).sub(a); c.fromArray(at, 3 * i + 6).sub(a);
      faces.push(b.clone().cross(c));
      for (k = 0; k < 3; ++k) {
        var key = Math.round(at[3 * (i + k)] * 1e6) + "," + Math.round(at[3 * (i + k) + 1] * 1e6) + "," + Math.round(at[3 * (i + k) + 2] * 1e6);
        (around[key] = around[key] || []).push(i + k);
      }
    }
    Object.keys(around).forEach(function (key) {
      var corners = around[key];
      corners.forEach(function (corner) {
        var own = faces[Math.floor(corner / 3)], sum = new THREE.Vector3();
        corners.forEach(function (other) {
          var face = faces[Math.floor(other / 3)];
          if (own.dot(face) > 0.82 * own.length() * face.length()) sum.add(face);
        });
        (sum.lengthSq() > 0 ? sum : own.clone()).normalize().toArray(normals, 3 * corner);
      });
    });
    var geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(at, 3));
    geometry.setAttribute("normal", new THREE.BufferAttribute(normals, 3));
    return geometry;
  }

  var totalTriangles = 0;
  var parts = data.parts.map(function (part, number) {
    var vertices = new Float32Array(bytes(part.vertices)), triangles = new Uint32Array(bytes(part.triangles));
    totalTriangles += triangles.length / 3;
    var geometry = softened(vertices, triangles), group = new THREE.Group();
    var tint = new THREE.Color().setHSL(0.58, 0.10, 0.70 - 0.05 * (number % 3));
    var skin = new THREE.MeshPhongMaterial({ color: tint, specular: 0x333333, shininess: 28, side: THREE.DoubleSide, clippingPlanes: [cut],
      polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1 });
    group.add(new THREE.Mesh(geometry, skin));
    if (triangles.length < 60000) {
      group.add(new THREE.LineSegments(new THREE.EdgesGeometry(geometry, 35),
        new THREE.LineBasicMaterial({ color: 0x4a5663, transparent: true, opacity: 0.55, clippingPlanes: [cut] })));
    }
    scene.add(group);
    return { name: part.name, vertices: vertices, triangles: triangles, group: group, skin: skin, shown: true };
  });

  // The lines in which the cut plane meets the parts.
  var outline = new THREE.LineSegments(new THREE.BufferGeometry(), new THREE.LineBasicMaterial({ color: 0x111820 }));
  outline.frustumCulled = false;
  scene.add(outline);
  function drawOutline() {
    var points = [], p = [new THREE.Vector3(), new THREE.Vector3(), new THREE.Vector3()], d = [0, 0, 0], n = cut.normal;
    outline.visible = state.cut !== "none";
    if (!outline.visible) return;
    parts.forEach(function (part) {
      if (!part.group.visible) return;
      part.group.updateMatrixWorld(true);
      var m = part.group.matrixWorld.elements, v = part.vertices, world = new Float32Array(v.length), side = new Float32Array(v.length / 3);
      for (var i = 0, s = 0; i < v.length; i += 3, ++s) {
        for (var r = 0; r < 3; ++r) world[i + r] = m[r] * v[i] + m[4 + r] * v[i + 1] + m[8 + r] * v[i + 2] + m[12 + r];
        side[s] = n.x * world[i] + n.y * world[i + 1] + n.z * world[i + 2] + cut.constant;
      }
      for (var t = 0; t < part.triangles.length; t += 3) {
        for (var k = 0; k < 3; ++k) d[k] = side[part.triangles[t + k]];
        if ((d[0] < 0) === (d[1] < 0) && (d[1] < 0) === (d[2] < 0)) continue;
        for (k = 0; k < 3; ++k) p[k].fromArray(world, 3 * part.triangles[t + k]);
        for (k = 0; k < 3; ++k) {
          var o = (k + 1) % 3;
          if ((d[k] < 0) === (d[o] < 0)) continue;
          var share = d[k] / (d[k] - d[o]);
          points.push(p[k].x + share * (p[o].x - p[k].x), p[k].y + share * (p[o].y - p[k].y), p[k].z + share * (p[o].z - p[k].z));
        }
      }
    });
    outline.geometry.dispose();
    outline.geometry = new THREE.BufferGeometry();
    outline.geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array(points), 3));
  }

  // ---- grains ----------------------------------------------------------------------------------------------------
  var radii = new Float32Array(bytes(data.radii)), smallest = Infinity, greatest = 0;
  radii.forEach(function (r) { if (r > 0) { smallest = Math.min(smallest, r); greatest = Math.max(greatest, r); } });
  var decoded = {};
  function rows(k) {
    if (!decoded[k]) decoded[k] = new Uint16Array(bytes(lines[k]));
    return decoded[k];
  }
  function column(k) {
    var attribute = new THREE.InstancedBufferAttribute(new Uint16Array(rows(k)), 4, true, 1);
    attribute.setUsage ? attribute.setUsage(THREE.DynamicDrawUsage) : attribute.setDynamic(true);
    return { attribute: attribute, frame: k };
  }
  function load(slot, k) {
    if (slot.frame === k) return;
    slot.attribute.array.set(rows(k));
    slot.attribute.needsUpdate = true;
    slot.frame = k;
  }
  var uniforms = {
    lo: { value: lo }, size: { value: hi.clone().sub(lo) }, share: { value: 0 }, cutOn: { value: 0 }, jump: { value: 0.5 * hi.distanceTo(lo) },
    plane: { value: new THREE.Vector4() }, mode: { value: 0 }, radiusRange: { value: new THREE.Vector2(smallest, Math.max(greatest - smallest, 1e-12)) },
    ramp: { value: ramp.map(function (c) { return new THREE.Vector3(c[0] / 255, c[1] / 255, c[2] / 255); }) }
  };
  var vertexShader = [
    "attribute vec4 now; attribute vec4 next; attribute float radius;",
    "uniform vec3 lo; uniform vec3 size; uniform float share; uniform float cutOn; uniform float jump; uniform vec4 plane;",
    "uniform float mode; uniform vec2 radiusRange; uniform vec3 ramp[6];",
    "varying vec2 at; varying vec3 centre; varying float r; varying vec3 colour;",
    "void main() {",
    "  vec3 a = lo + size * now.xyz, b = lo + size * next.xyz;",
    // A grain that is gone in the next frame, or crossed a periodic boundary, stays where it is.
    "  float m = next.w > 0.0 && distance(a, b) < jump ? share : 0.0;",
    "  vec3 p = mix(a, b, m);",
    "  bool hidden = now.w <= 0.0 || (cutOn > 0.5 && dot(plane.xyz, p) + plane.w < 0.0);",
    "  float s = mode < 0.5 ? mix(now.w, next.w, m) : (radius - radiusRange.x) / radiusRange.y;",
    "  float x = clamp(s, 0.0, 0.9999) * 5.0; int k = int(x);",
    "  colour = mode > 1.5 ? vec3(0.82, 0.73, 0.57) : mix(ramp[k], ramp[k + 1], x - float(k));",
    "  centre = (modelViewMatrix * vec4(p, 1.0)).xyz; r = radius; at = position.xy;",
    "  gl_Position = hidden ? vec4(2.0, 2.0, 2.0, 1.0) : projectionMatrix * vec4(centre + vec3(at * r, 0.0), 1.0);",
    "}"].join("\n");
  var fragmentShader = [
    "uniform mat4 projectionMatrix; varying vec2 at; varying vec3 centre; varying float r; varying vec3 colour;",
    "void main() {",
    "  float d = dot(at, at); if (d > 1.0) discard;",
    "  vec3 n = vec3(at, sqrt(1.0 - d));",
    "#if defined(GL_EXT_frag_depth) || __VERSION__ >= 300",
    "  vec4 clip = projectionMatrix * vec4(centre + n * r, 1.0);",
    "  gl_FragDepthEXT = 0.5 * clip.z / clip.w + 0.5;",
    "#endif",
    "  float light = 0.66 + 0.46 * max(0.0, dot(n, normalize(vec3(-0.4, 0.6, 0.7))));",
    "  gl_FragColor = vec4(colour * light * mix(0.6, 1.0, smoothstep(0.0, 0.5, n.z)), 1.0);",
    "}"].join("\n");
  var now = null, next = null, grains = new THREE.InstancedBufferGeometry();
  if (data.spheres > 0) {
    now = column(0);
    next = column(Math.min(1, last));
    grains.setAttribute("position", new THREE.BufferAttribute(new Float32Array([-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, -1, 0, 1, 1, 0, -1, 1, 0]), 3));
    grains.setAttribute("now", now.attribute);
    grains.setAttribute("next", next.attribute);
    grains.setAttribute("radius", new THREE.InstancedBufferAttribute(radii, 1));
    grains.maxInstancedCount = data.spheres;
    var material = new THREE.ShaderMaterial({ uniforms: uniforms, vertexShader: vertexShader, fragmentShader: fragmentShader, extensions: { fragDepth: true } });
    var cloud = new THREE.Mesh(grains, material);
    cloud.frustumCulled = false;
    scene.add(cloud);
  }

  // ---- time ------------------------------------------------------------------------------------------------------
  var first = frames[0].time, span = Math.max(frames[last].time - first, 1e-12);
  var state = { time: first, playing: false, cut: "all", smooth: data.everyFrame || span / Math.max(last, 1) <= 0.1, dirty: true };
  var qa = new THREE.Quaternion(), qb = new THREE.Quaternion(), pa = new THREE.Vector3(), pb = new THREE.Vector3();

  function goTo(time) {
    var k = 0;
    while (k < last && frames[k + 1].time <= time + 1e-12) ++k;
    var to = Math.min(k + 1, last), share = state.smooth && to > k ? Math.min(1, (time - frames[k].time) / (frames[to].time - frames[k].time)) : 0;
    if (now) {
      if (next.frame === k && now.frame !== k) { var swap = now; now = next; next = swap; grains.setAttribute("now", now.attribute); grains.setAttribute("next", next.attribute); }
      load(now, k);
      load(next, to);
    }
    uniforms.share.value = share;
    parts.forEach(function (part, i) {
      var a = frames[k].poses[i], b = frames[to].poses[i];
      part.group.visible = part.shown && !!a;
      if (!a) return;
      if (!b) b = a;
      qa.set(a[0], a[1], a[2], a[3]).slerp(qb.set(b[0], b[1], b[2], b[3]), share);
      part.group.quaternion.copy(qa);
      part.group.position.copy(pa.set(a[4], a[5], a[6]).lerp(pb.set(b[4], b[5], b[6]), share));
    });
    var event = "";
    data.events.forEach(function (e) { if (e.time <= time + 1e-12) event = e.name; });
    var shown = state.smooth ? time : frames[k].time;
    clock.innerHTML = "t = " + shown.toFixed(span < 1 ? 4 : span < 100 ? 3 : 1) + " s<small></small>";
    clock.lastChild.textContent = event ? "after: " + event : "";
    if (!state.playing || totalTriangles < 150000) drawOutline();
    state.dirty = true;
    return event;
  }

  // ---- view ------------------------------------------------------------------------------------------------------
  var bounds = new THREE.Box3();
  if (data.spheres > 0) bounds.set(lo.clone().addScalar(-greatest), hi.clone().addScalar(greatest));
  goTo(first);
  frames.forEach(function (frame) {
    frame.poses.forEach(function (p, i) {
      if (!p || frame !== frames[0] && frame !== frames[last]) return;
      var box = new THREE.Box3().setFromBufferAttribute(new THREE.BufferAttribute(parts[i].vertices, 3));
      box.applyMatrix4(new THREE.Matrix4().compose(new THREE.Vector3(p[4], p[5], p[6]), new THREE.Quaternion(p[0], p[1], p[2], p[3]), new THREE.Vector3(1, 1, 1)));
      bounds.union(box);
    });
  });
  var middle = bounds.getCenter(new THREE.Vector3()), extent = bounds.getSize(new THREE.Vector3());
  function along(v) { return Math.abs(extent.dot(v)); }

  var views = {
    front: vDepth.clone().negate(), side: vRight.clone(), top: vUp.clone().addScaledVector(vDepth, -0.001),
    oblique: vDepth.clone().negate().addScaledVector(vRight, 0.45).addScaledVector(vUp, 0.35),
    still: vDepth.clone().negate().addScaledVector(vRight, 0.22).addScaledVector(vUp, 0.14)
  };
  function look(cam, name, aspect) {
    var from = views[name].clone().normalize();
    var tall = name === "top" ? along(vDepth) : along(vUp) * 0.97 + (name === "oblique" ? 0.3 * along(vDepth) : 0.1 * along(vDepth));
    var wide = name === "side" ? along(vDepth) : along(vRight) + (name === "oblique" ? 0.3 * along(vDepth) : 0);
    var deep = name === "top" ? along(vUp) : Math.max(along(vDepth), along(vRight));
    var away = 1.06 * Math.max(tall, wide / aspect) / 2 / Math.tan(cam.fov * Math.PI / 360) + deep / 2;
    cam.position.copy(middle).addScaledVector(from, away);
    cam.near = away / 100;
    cam.far = away * 20;
    cam.aspect = aspect;
    cam.updateProjectionMatrix();
    cam.lookAt(middle);
  }
  function setCut() {
    var angle = +element("cut-angle").value * Math.PI / 180;
    cut.normal.copy(vDepth).applyAxisAngle(vUp, angle);
    // With the cut switched off the plane is moved out of the way.
    cut.constant = state.cut === "none" ? 1e6 : -cut.normal.dot(middle) - 1e-7;
    uniforms.plane.value.set(cut.normal.x, cut.normal.y, cut.normal.z, cut.constant);
    uniforms.cutOn.value = state.cut === "all" ? 1 : 0;
  }
  function paint(cam) {
    sun.position.copy(cam.position).addScaledVector(vUp, 0.6 * cam.position.distanceTo(middle)).addScaledVector(vRight, -0.4 * cam.position.distanceTo(middle));
    renderer.render(scene, cam);
  }

  function takeStills() {
    var host = element("stills"), cam = new THREE.PerspectiveCamera(24, 1, 0.01, 100), taken = {};
    cam.up.copy(vUp);
    // Tall apparatus get tall pictures, within reason.
    var tall = along(vUp) / Math.max(along(vRight) + 0.3 * along(vDepth), 1e-9), width = tall > 1.4 ? 330 : 420;
    var height = Math.round(width * Math.max(0.7, Math.min(2, tall)));
    renderer.setPixelRatio(2);
    renderer.setSize(width, height, false);
    look(cam, "still", width / height);
    [0, 1 / 3, 2 / 3, 1].forEach(function (share) {
      var k = Math.round(share * last);
      if (taken[k]) return;
      taken[k] = true;
      var event = goTo(frames[k].time), figure = document.createElement("figure"), image = document.createElement("img"), caption = document.createElement("figcaption");
      paint(cam);
      image.src = canvas.toDataURL("image/png");
      image.alt = "The apparatus cut open at " + short(frames[k].time) + " s, grains coloured by speed";
      caption.textContent = "t = " + short(frames[k].time) + " s" + (event ? ", after: " + event : "");
      figure.appendChild(image);
      figure.appendChild(caption);
      host.appendChild(figure);
    });
  }

  // ---- controls --------------------------------------------------------------------------------------------------
  setCut();
  takeStills();
  renderer.setPixelRatio(Math.min(2, window.devicePixelRatio || 1));
  var controls = new THREE.OrbitControls(camera, canvas);
  controls.enableDamping = false;
  controls.enableKeys = false;
  controls.addEventListener("change", function () { state.dirty = true; });
  function view(name) {
    look(camera, name, stage.clientWidth / stage.clientHeight);
    controls.target.copy(middle);
    controls.update();
    state.dirty = true;
  }
  function fit() {
    renderer.setSize(stage.clientWidth, stage.clientHeight, false);
    camera.aspect = stage.clientWidth / stage.clientHeight;
    camera.updateProjectionMatrix();
    state.dirty = true;
  }
  fit();
  view("oblique");
  window.addEventListener("resize", fit);

  var slider = element("slider"), rate = element("rate"), play = element("play");
  function place() { slider.value = Math.round(1000 * (state.time - first) / span); }
  function setPlaying(on) { state.playing = on; play.innerHTML = on ? "&#10074;&#10074;" : "&#9654;"; }
  // About ten seconds for the whole run, as near as the choices come.
  Array.prototype.forEach.call(rate.options, function (option) {
    if (Math.abs(Math.log(+option.value * 10 / span)) < Math.abs(Math.log(+rate.value * 10 / span))) rate.value = option.value;
  });
  play.addEventListener("click", function () {
    if (!state.playing && state.time >= first + span) state.time = first;
    setPlaying(!state.playing);
  });
  slider.addEventListener("input", function () { setPlaying(false); state.time = first + span * slider.value / 1000; goTo(state.time); });
  element("cut").value = state.cut;
  element("cut").addEventListener("change", function () { state.cut = this.value; setCut(); goTo(state.time); });
  element("cut-angle").addEventListener("input", function () { setCut(); goTo(state.time); });
  element("smooth").checked = state.smooth;
  element("smooth").addEventListener("change", function () { state.smooth = this.checked; goTo(state.time); });
  element("opacity").addEventListener("input", function () {
    var opacity = this.value / 100;
    parts.forEach(function (part) {
      part.skin.opacity = opacity;
      part.skin.transparent = opacity < 1;
      part.skin.depthWrite = opacity === 1;
      part.skin.needsUpdate = true;
      part.group.children[0].visible = opacity > 0;
      if (part.group.children[1]) part.group.children[1].material.opacity = 0.15 + 0.4 * opacity;
    });
    state.dirty = true;
  });
  element("colour").addEventListener("change", function () { uniforms.mode.value = { speed: 0, radius: 1, none: 2 }[this.value]; scale(); state.dirty = true; });
  Array.prototype.forEach.call(document.querySelectorAll("#views button"), function (button) {
    button.addEventListener("click", function () { view(button.getAttribute("data-view")); });
  });
  parts.forEach(function (part) {
    var chip = document.createElement("button");
    chip.type = "button";
    chip.textContent = part.name;
    chip.title = "show or hide";
    chip.addEventListener("click", function () { part.shown = !part.shown; chip.className = part.shown ? "" : "off"; goTo(state.time); });
    element("parts").appendChild(chip);
  });
  function scale() {
    var mode = uniforms.mode.value, host = element("scale");
    if (mode === 2) { host.innerHTML = ""; return; }
    // Speeds go with their square root, so the middle of the bar is a quarter of the highest.
    var texts = mode === 0 ? ["0", short(data.highestSpeed / 4), short(data.highestSpeed) + " m/s"]
      : [short(smallest * 1e3), short((smallest + greatest) * 500), short(greatest * 1e3) + " mm"];
    host.innerHTML = "<div class=\"speed-bar\"><i style=\"background:linear-gradient(90deg," +
      ramp.map(function (c) { return "rgb(" + c.join(",") + ")"; }).join(",") + ")\"></i><span>" + texts.join("</span><span>") + "</span></div>";
  }
  scale();

  state.time = frames[last].time;
  goTo(state.time);
  place();
  var before = 0;
  function tick(stamp) {
    if (state.playing) {
      state.time += Math.min(0.1, (stamp - before) / 1000) * rate.value;
      if (state.time > first + span) state.time = first;
      goTo(state.time);
      place();
    }
    before = stamp;
    if (state.dirty) { state.dirty = false; paint(camera); }
    requestAnimationFrame(tick);
  }
  requestAnimationFrame(tick);
}());
