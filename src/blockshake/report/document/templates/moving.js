// Blocks of a sample in space beside the measured markers: to play, to turn, and to choose sample, time and
// magnification from. Displacements are multiplied point by point, so that blocks and markers stay comparable.
function showMoving(place, { step, frames, magnification, bodies, samples, measured }) {
  const own = document.createElement("form");
  own.className = "controls";
  own.innerHTML = `<button type="button" name="play">Play</button>
    <label>Sample <select name="sample"></select></label>
    <label>Time <input name="frame" type="range" min="0" max="${frames - 1}" value="0"> <output name="clock"></output></label>
    <label>Magnification <input name="factor" type="range" min="1" max="50" value="${magnification}"> <output name="times"></output></label>`;
  const { play, sample, frame, clock, factor, times } = own.elements;
  own.addEventListener("submit", (event) => event.preventDefault());
  samples.forEach((one, row) => sample.add(new Option(one.label, row)));
  const picture = document.createElement("div");
  place.append(own, picture);

  const unpacked = ({ unit, data }) => ({ unit, whole: new Int16Array(Uint8Array.from(atob(data), (one) => one.charCodeAt(0)).buffer) });
  const motions = samples.map(({ shift, turn }) => ({ shift: unpacked(shift), turn: unpacked(turn) }));
  const markers = measured ? { ...measured, shift: unpacked(measured.shift) } : { bodies: [], arms: [], shift: { unit: 1, whole: [] } };
  const vector = ({ unit, whole }, row) => [0, 1, 2].map((axis) => (whole[3 * row + axis] === -32768 ? null : unit * whole[3 * row + axis]));
  const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];

  // a function that moves points of a body, given from its mass centre
  function mover(motion, at, body, times) {
    const shift = vector(motion.shift, at * bodies.length + body), turn = vector(motion.turn, at * bodies.length + body);
    const angle = Math.hypot(...turn), axis = turn.map((one) => one / (angle || 1));
    const sine = Math.sin(angle), rest = 1 - Math.cos(angle);
    return (arm) => {
      const once = cross(axis, arm), twice = cross(axis, once);
      return arm.map((one, k) => bodies[body].place[k] + one + times * (shift[k] + sine * once[k] + rest * twice[k]));
    };
  }

  // points of blocks, edges, markers of the sample and measured markers, each as lists x, y and z
  function points(motion, at, times) {
    const moved = bodies.map((body, row) => body.arms.map(mover(motion, at, row, times)));
    const edges = bodies.flatMap((body, row) => body.edges.flatMap(([a, b]) => [moved[row][a], moved[row][b], [null, null, null]]));
    const simulated = markers.arms.map((arm, row) => mover(motion, at, markers.bodies[row], times)(arm));
    const read = markers.arms.map((arm, row) => {
      const shift = vector(markers.shift, at * markers.arms.length + row), { place } = bodies[markers.bodies[row]];
      return shift.includes(null) ? shift : arm.map((one, k) => place[k] + one + times * shift[k]);
    });
    return [moved.flat(), edges, simulated, read].map((list) => [0, 1, 2].map((axis) => list.map((one) => one[axis])));
  }

  // the room that the motion takes, so that the picture stands still
  function ranges() {
    const low = [1e9, 1e9, 1e9], high = [-1e9, -1e9, -1e9];
    for (let at = 0; at < frames; at += 4) {
      for (const lists of points(motions[sample.value], at, +factor.value)) {
        lists.forEach((list, axis) => { for (const one of list) if (one !== null) {
          low[axis] = Math.min(low[axis], one); high[axis] = Math.max(high[axis], one);
        } });
      }
    }
    return low.map((one, axis) => [one, high[axis]]);
  }

  let first = 0;
  const starts = bodies.map((body) => (first += body.arms.length) - body.arms.length);
  const corners = [0, 1, 2].map((corner) => bodies.flatMap((body, row) => body.triangles.map((one) => one[corner] + starts[row])));
  const at = (lists) => ({ x: lists[0], y: lists[1], z: lists[2] });
  const [solid, edges, simulated, read] = points(motions[0], 0, 1);
  const data = [
    { type: "mesh3d", ...at(solid), i: corners[0], j: corners[1], k: corners[2], flatshading: true, hoverinfo: "skip",
      facecolor: bodies.flatMap((body) => body.triangles.map(() => body.color)),
      lighting: { ambient: 0.75, diffuse: 0.5, specular: 0.0 }, lightposition: { x: -1e4, y: -2e4, z: 3e4 } },
    { type: "scatter3d", mode: "lines", ...at(edges), line: { color: "#555", width: 2 }, hoverinfo: "skip", showlegend: false },
    { type: "scatter3d", mode: "markers", ...at(simulated), name: "the same markers of the sample", hoverinfo: "skip",
      marker: { size: 5, symbol: "circle-open", color: "#0072b2", line: { width: 2, color: "#0072b2" } } },
    { type: "scatter3d", mode: "markers", ...at(read), name: measured ? `markers, ${measured.label}` : "", hoverinfo: "skip",
      marker: { size: 4, color: "#cc3311" } },
  ].slice(0, measured ? 4 : 2);
  const bare = (text) => ({ title: { text }, showspikes: false, showbackground: false, nticks: 5 });
  const layout = {
    height: 520, margin: { l: 0, r: 0, t: 0, b: 0 }, uirevision: "kept", font: { size: 11 },
    legend: { x: 0, y: 1, bgcolor: "rgba(255,255,255,0.7)" },
    scene: { aspectmode: "data", xaxis: bare("x [m]"), yaxis: bare("y [m]"), zaxis: bare("z [m]"),
      camera: { projection: { type: "orthographic" }, eye: { x: 1.1, y: -1.6, z: 0.6 } } },
  };
  const made = Plotly.newPlot(picture, data, layout, { responsive: true, displaylogo: false, modeBarButtons: [["resetCameraDefault3d", "toImage"]] });

  const draw = (room = {}) => {
    clock.value = `${(step * frame.value).toFixed(2)} s`;
    times.value = `${factor.value} times`;
    const lists = points(motions[sample.value], +frame.value, +factor.value).slice(0, data.length);
    const along = (axis) => lists.map((list) => list[axis]);
    return Plotly.update(picture, { x: along(0), y: along(1), z: along(2) }, room);
  };
  const drawAnew = () => {
    const [x, y, z] = ranges();
    return draw({ "scene.xaxis.range": x, "scene.yaxis.range": y, "scene.zaxis.range": z });
  };
  let since = null; // when time 0 was played
  const run = async (now) => {
    if (since === null) return;
    const shown = Math.floor((now - since) / 1000 / step);
    if (shown >= frames) since = now;
    frame.value = shown % frames;
    await draw();
    requestAnimationFrame(run);
  };
  const pause = () => { since = null; play.textContent = "Play"; };
  play.addEventListener("click", () => {
    if (since !== null) return pause();
    since = performance.now() - 1000 * step * (+frame.value % (frames - 1));
    play.textContent = "Pause";
    requestAnimationFrame(run);
  });
  frame.addEventListener("input", () => { pause(); draw(); });
  for (const one of [sample, factor]) one.addEventListener("change", drawAnew);
  factor.addEventListener("input", () => { times.value = `${factor.value} times`; });
  return made.then(drawAnew);
}
