"use strict";
// Draws a fabric from tiles and the places where they stand (see scene.py): WebGL2, instanced, no library.
//
//   const view = fabricView(canvas);      null where the browser has no WebGL2
//   view.show(scene);                     numbers as in scene.py
//   view.set({cells: [2, 2], hidden: ["weft_1"], cut: {axis: "x", place: 3.0}, contact: true});
//   view.picture()                        a PNG as a data URL
//
// Drag turns, shift and drag moves, the wheel zooms; so do the arrow keys, with shift, and + and -.
const fabricView = (() => {
  const VERTEX = `#version 300 es
    layout(location = 0) in vec3 point; layout(location = 1) in vec4 normal; layout(location = 2) in vec3 place;
    uniform mat4 view; uniform vec3 middle, extent; uniform vec2 cell;
    out vec3 here, outwards; out float touching;
    void main() {
      here = middle + extent * point + place + vec3(cell, 0.0);
      outwards = normal.xyz; touching = normal.w;
      gl_Position = view * vec4(here, 1.0);
    }`;
  const FRAGMENT = `#version 300 es
    precision highp float;
    in vec3 here, outwards; in float touching;
    uniform vec3 colour, light; uniform vec4 cut; uniform bool contact;
    out vec4 shade;
    void main() {
      if (dot(cut.xyz, here) > cut.w) discard;
      if (!gl_FrontFacing) { shade = vec4(0.72 * colour, 1.0); return; }  // the inside, seen through a cut
      vec3 own = contact && touching > 0.99 ? vec3(0.75, 0.15, 0.2) : colour;
      shade = vec4(own * (0.42 + 0.58 * max(dot(normalize(outwards), light), 0.0)), 1.0);
    }`;

  function program(gl) {
    const made = gl.createProgram();
    for (const [kind, text] of [[gl.VERTEX_SHADER, VERTEX], [gl.FRAGMENT_SHADER, FRAGMENT]]) {
      const shader = gl.createShader(kind);
      gl.shaderSource(shader, text);
      gl.compileShader(shader);
      gl.attachShader(made, shader);
    }
    gl.linkProgram(made);
    if (!gl.getProgramParameter(made, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(made));
    gl.useProgram(made);
    const place = name => gl.getUniformLocation(made, name);
    return Object.fromEntries(["view", "middle", "extent", "cell", "colour", "light", "cut", "contact"]
      .map(name => [name, place(name)]));
  }

  const bytes = text => Uint8Array.from(atob(text), letter => letter.charCodeAt(0)).buffer;
  const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];

  function rendererName() {
    const probe = document.createElement("canvas").getContext("webgl2");
    if (!probe) return "";
    const known = probe.getExtension("WEBGL_debug_renderer_info");
    const name = known ? probe.getParameter(known.UNMASKED_RENDERER_WEBGL) : "unknown";
    probe.getExtension("WEBGL_lose_context")?.loseContext();
    return name;
  }

  return function fabricView(canvas) {
    const renderer = rendererName();
    const software = /swiftshader|llvmpipe|software/i.test(renderer);  // then every sample costs
    const gl = canvas.getContext("webgl2", {antialias: !software});
    if (!gl) return null;
    const uniform = program(gl);
    gl.enable(gl.DEPTH_TEST);
    gl.clearColor(1, 1, 1, 1);

    const camera = {turn: -0.7, tilt: 0.75, zoom: 0, shift: [0, 0]};
    const options = {cells: [1, 1], hidden: [], cut: null, contact: false};
    let scene = null, groups = [], waiting = 0;
    const view = {renderer, software, draws: 0, drawn: 0, camera};

    function buffer(target, data, old) {
      const made = old || gl.createBuffer();
      gl.bindBuffer(target, made);
      gl.bufferData(target, data, gl.DYNAMIC_DRAW);
      return made;
    }

    view.show = next => {
      scene = next;
      groups = scene.groups.map((group, number) => {
        const old = groups[number] || {};
        gl.bindVertexArray(null);
        const triangles = new Uint16Array(bytes(group.triangles));
        return {
          ...group,
          count: triangles.length,
          places: new Float32Array(bytes(group.places)),
          pointBuffer: buffer(gl.ARRAY_BUFFER, bytes(group.points), old.pointBuffer),
          normalBuffer: buffer(gl.ARRAY_BUFFER, bytes(group.normals), old.normalBuffer),
          triangleBuffer: buffer(gl.ELEMENT_ARRAY_BUFFER, triangles, old.triangleBuffer),
          placeBuffer: old.placeBuffer,
        };
      });
      stand();
      draw();  // at once: before the page around it is laid out again
    };

    view.set = changes => { Object.assign(options, changes); stand(); };

    function stand() {  // where every tile stands, tile by tile, without the yarns that are hidden
      for (const group of groups) {
        const hidden = new Set(options.hidden), sorted = [];
        group.runs = [];
        for (let tile = 0; tile < group.tiles; tile++) {
          const first = sorted.length / 3;
          for (let k = 0; k < group.tile.length; k++)
            if (group.tile[k] === tile && !hidden.has(`${group.direction}_${group.yarn[k] + 1}`))
              sorted.push(...group.places.subarray(3 * k, 3 * k + 3));
          group.runs.push([first, sorted.length / 3 - first]);
        }
        group.placeBuffer = buffer(gl.ARRAY_BUFFER, new Float32Array(sorted), group.placeBuffer);
      }
      view.redraw();
    }

    view.redraw = () => { waiting = waiting || requestAnimationFrame(draw); };

    function axes() {
      const [ct, st] = [Math.cos(camera.turn), Math.sin(camera.turn)];
      const [cp, sp] = [Math.cos(camera.tilt), Math.sin(camera.tilt)];
      return {right: [ct, st, 0], up: [-st * sp, ct * sp, cp], towards: [st * cp, -ct * cp, sp]};
    }

    function draw() {
      if (waiting) cancelAnimationFrame(waiting);
      waiting = 0;
      if (!scene) return;
      const width = Math.max(1, Math.round(canvas.clientWidth * devicePixelRatio));
      const height = Math.max(1, Math.round(canvas.clientHeight * devicePixelRatio));
      if (canvas.width !== width || canvas.height !== height) [canvas.width, canvas.height] = [width, height];
      gl.viewport(0, 0, width, height);
      gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);

      const [nx, ny] = options.cells, [px, py] = scene.period, {right, up, towards} = axes();
      const centre = [nx * px / 2, ny * py / 2, 0], reach = Math.hypot(nx * px, ny * py, scene.thickness) / 2;
      const [broad, tall] = [Math.max(1, width / height), Math.max(1, height / width)];
      const fits = axis => (Math.abs(axis[0]) * nx * px + Math.abs(axis[1]) * ny * py + scene.thickness) / 2;
      camera.zoom ||= 0.94 * reach / Math.max(fits(up) / tall, fits(right) / broad);  // all of it, at first
      const size = reach / camera.zoom, wide = size * broad, high = size * tall, deep = 2 * reach;
      const row = (axis, scale, shift) => [...axis.map(part => part / scale), -dot(axis, centre) / scale + shift];
      const rows = [row(right, wide, camera.shift[0]), row(up, high, camera.shift[1]),
        row(towards.map(part => -part), deep, 0), [0, 0, 0, 1]];
      gl.uniformMatrix4fv(uniform.view, false, [0, 1, 2, 3].flatMap(column => rows.map(each => each[column])));
      const light = [0, 1, 2].map(k => towards[k] + 0.45 * up[k] + 0.25 * right[k]), norm = Math.hypot(...light);
      gl.uniform3fv(uniform.light, light.map(part => part / norm));
      const cut = options.cut;
      gl.uniform4fv(uniform.cut, cut ? [+(cut.axis === "x"), +(cut.axis === "y"), 0, cut.place] : [0, 0, 0, 1]);
      gl.uniform1i(uniform.contact, options.contact ? 1 : 0);

      for (const group of groups) {
        gl.uniform3fv(uniform.colour, group.colour);
        gl.uniform3fv(uniform.middle, group.middle);
        gl.uniform3fv(uniform.extent, group.extent);
        gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, group.triangleBuffer);
        group.runs.forEach(([first, instances], tile) => {
          if (!instances) return;
          attribute(0, group.pointBuffer, 3, gl.SHORT, 8, tile * group.size * 8);
          attribute(1, group.normalBuffer, 4, gl.BYTE, 4, tile * group.size * 4);
          attribute(2, group.placeBuffer, 3, gl.FLOAT, 12, first * 12, 1);
          for (let i = 0; i < nx; i++) for (let j = 0; j < ny; j++) {
            gl.uniform2f(uniform.cell, i * px, j * py);
            gl.drawElementsInstanced(gl.TRIANGLES, group.count, gl.UNSIGNED_SHORT, 0, instances);
          }
        });
      }
      view.draws += 1;
      view.drawn = performance.now();
      if (view.painted) {  // reading a pixel back waits for all of them
        gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4));
        view.painted(performance.now());
      }
    }

    function attribute(place, data, size, kind, stride, offset, divisor = 0) {
      gl.bindBuffer(gl.ARRAY_BUFFER, data);
      gl.enableVertexAttribArray(place);
      gl.vertexAttribPointer(place, size, kind, kind !== gl.FLOAT, stride, offset);
      gl.vertexAttribDivisor(place, divisor);
    }

    view.picture = () => { draw(); return canvas.toDataURL("image/png"); };

    function turn(dx, dy, moves) {
      if (moves) {
        camera.shift[0] += 2 * dx / canvas.clientWidth;
        camera.shift[1] -= 2 * dy / canvas.clientHeight;
      } else {
        camera.turn -= 0.01 * dx;
        camera.tilt = Math.min(Math.PI / 2, Math.max(-Math.PI / 2, camera.tilt + 0.01 * dy));
      }
      view.redraw();
    }
    const zoom = factor => { camera.zoom = Math.min(50, Math.max(0.2, camera.zoom * factor)); view.redraw(); };

    canvas.addEventListener("pointerdown", event => canvas.setPointerCapture(event.pointerId));
    canvas.addEventListener("pointermove", event => {
      if (event.buttons) turn(event.movementX, event.movementY, event.shiftKey || event.buttons === 2);
    });
    canvas.addEventListener("contextmenu", event => event.preventDefault());
    canvas.addEventListener("wheel", event => { event.preventDefault(); zoom(Math.exp(-0.001 * event.deltaY)); },
      {passive: false});
    canvas.addEventListener("keydown", event => {
      const step = {ArrowLeft: [-12, 0], ArrowRight: [12, 0], ArrowUp: [0, -12], ArrowDown: [0, 12]}[event.key];
      if (step) turn(...step, event.shiftKey);
      else if (event.key === "+" || event.key === "=") zoom(1.15);
      else if (event.key === "-") zoom(1 / 1.15);
      else return;
      event.preventDefault();
    });
    new ResizeObserver(() => view.redraw()).observe(canvas);
    return view;
  };
})();
