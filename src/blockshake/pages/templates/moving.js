// Blocks of a sample in parallel projection against the measured markers: to play, to turn, and to choose the sample, the
// time and the magnification of. Displacements are multiplied point by point, so that blocks and markers compare.
function showMoving(place, { step, frames, magnification, bodies, samples, measured }) {
  const form = document.createElement("form");
  form.className = "controls";
  form.innerHTML = `<button type="button" name="play">Play</button>
    <label>Sample <select name="sample"></select></label>
    <label>Time <input name="frame" type="range" min="0" max="${frames - 1}" value="0"> <output name="clock"></output></label>
    <label>Magnification <input name="factor" type="range" min="1" max="50" value="${magnification}"> <output name="times"></output></label>
    <label>Turn <input name="turn" type="range" min="-90" max="90" value="35"></label>`;
  const { play, sample, frame, clock, factor, times, turn } = form.elements;
  samples.forEach((one, row) => sample.add(new Option(one.label, row)));
  const canvas = document.createElement("canvas"), pen = canvas.getContext("2d");
  canvas.setAttribute("role", "img");
  canvas.setAttribute("aria-label", "blocks of the chosen sample at the chosen time, and markers");
  place.append(form, canvas);

  const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
  const minus = (a, b) => a.map((one, axis) => one - b[axis]);
  const unpacked = ({ unit, data }) => {
    const bytes = new DataView(Uint8Array.from(atob(data), (one) => one.charCodeAt(0)).buffer);
    return (row) => [0, 2, 4].map((at) => bytes.getInt16(6 * row + at, true)).map((one) => (one === -32768 ? NaN : unit * one));
  };
  const motions = samples.map((one) => ({ shift: unpacked(one.shift), turn: unpacked(one.turn) }));
  const markers = (measured ? measured.arms : []).map((arm, row) => ({ arm, row, body: measured.bodies[row] }));
  const read = measured && unpacked(measured.shift);

  // where points of a body, given as seen from its mass centre, are at a frame
  function mover(at, body) {
    const { shift, turn } = motions[sample.value], row = at * bodies.length + body;
    const moved = shift(row), rotation = turn(row), angle = Math.hypot(...rotation);
    const axis = rotation.map((one) => one / (angle || 1)), sine = Math.sin(angle), rest = 1 - Math.cos(angle);
    return (arm) => {
      const once = cross(axis, arm), twice = cross(axis, once);
      return arm.map((one, k) => bodies[body].place[k] + one + factor.value * (moved[k] + sine * once[k] + rest * twice[k]));
    };
  }
  const pointsAt = (at) => bodies.map(({ arms }, body) => arms.map(mover(at, body)));

  // directions to the right, up and towards the eye
  function axes() {
    const [about, above] = [turn.value, 20].map((degrees) => (degrees * Math.PI) / 180);
    const right = [Math.cos(about), Math.sin(about), 0];
    const towards = [Math.sin(about) * Math.cos(above), -Math.cos(about) * Math.cos(above), Math.sin(above)];
    return [right, cross(towards, right), towards];
  }

  // bodies in an order in which none hides one after it: of two, the axis along which they part most tells the nearer
  function farthestFirst(points, towards) {
    const low = points.map((own) => [0, 1, 2].map((axis) => Math.min(...own.map((one) => one[axis]))));
    const high = points.map((own) => [0, 1, 2].map((axis) => Math.max(...own.map((one) => one[axis]))));
    const nearer = (a, b) => {
      const gaps = [0, 1, 2].flatMap((axis) => [
        { gap: low[a][axis] - high[b][axis], side: towards[axis] }, { gap: low[b][axis] - high[a][axis], side: -towards[axis] },
      ]);
      return gaps.reduce((best, one) => (one.gap > best.gap ? one : best)).side > 1e-6;
    };
    const left = points.map((own, body) => body), order = [];
    while (left.length) {
      const next = left.find((body) => !left.some((other) => other !== body && nearer(body, other))) ?? left[0];
      left.splice(left.indexOf(next), 1);
      order.push(next);
    }
    return order;
  }

  // the room that the motion takes: the picture stands still while the blocks move
  let room;
  function measure() {
    const [right, up] = axes(), low = [Infinity, Infinity], high = [-Infinity, -Infinity];
    for (let at = 0; at < frames; at += 5) {
      for (const one of pointsAt(at).flat()) {
        [dot(one, right), dot(one, up)].forEach((seen, k) => {
          low[k] = Math.min(low[k], seen);
          high[k] = Math.max(high[k], seen);
        });
      }
    }
    room = { low, high };
  }

  function disc([x, y], radius, color, filled) {
    pen.beginPath();
    pen.arc(x, y, radius, 0, 7);
    pen.lineWidth = 1.6;
    pen.fillStyle = pen.strokeStyle = color;
    if (filled) pen.fill();
    else pen.stroke();
  }

  function draw() {
    clock.value = `${(step * frame.value).toFixed(2)} s`;
    times.value = `\u00d7 ${factor.value}`;
    const width = canvas.clientWidth, height = canvas.clientHeight, fine = window.devicePixelRatio;
    canvas.width = width * fine;
    canvas.height = height * fine;
    pen.scale(fine, fine);
    const sizes = minus(room.high, room.low), scale = Math.min((width - 40) / sizes[0], (height - 80) / sizes[1]);
    const [right, up, towards] = axes(), middle = (room.low[0] + room.high[0]) / 2;
    const seen = (one) => [width / 2 + scale * (dot(one, right) - middle), height - 30 - scale * (dot(one, up) - room.low[1])];
    const points = pointsAt(+frame.value), light = [-0.35, 0.45, 0.82];
    pen.lineJoin = "round";
    for (const body of farthestFirst(points, towards)) {
      const own = points[body];
      const faces = bodies[body].faces.map((face) => {
        const normal = cross(minus(own[face[1]], own[face[0]]), minus(own[face[2]], own[face[0]])), size = Math.hypot(...normal);
        const across = axes().map((axis) => dot(axis, normal) / size);
        return { face, depth: dot(own[face[0]], towards), facing: across[2], bright: 0.62 + 0.38 * Math.max(0, dot(across, light)) };
      });
      for (const { face, bright } of faces.filter((one) => one.facing > 1e-6).sort((a, b) => a.depth - b.depth)) {
        pen.beginPath();
        face.forEach((corner) => pen.lineTo(...seen(own[corner])));
        pen.closePath();
        pen.fillStyle = `rgb(${bodies[body].color.map((one) => Math.round(255 * bright * one))})`;
        pen.strokeStyle = "#555";
        pen.lineWidth = 0.7;
        pen.fill();
        pen.stroke();
      }
      for (const { arm, row } of markers.filter((one) => one.body === body && dot(one.arm, towards) > 0)) {
        disc(seen(mover(+frame.value, body)(arm)), 4, "#0072b2", false);
        const shift = read(+frame.value * markers.length + row);
        if (!shift.includes(NaN)) disc(seen(arm.map((one, k) => bodies[body].place[k] + one + factor.value * shift[k])), 2.4, "#cc3311", true);
      }
    }
    pen.font = "12px system-ui, sans-serif";
    pen.fillStyle = "#000";
    pen.fillRect(16, height - 14, scale, 2);
    pen.fillText("1 m", 20 + scale, height - 9);
    if (!measured) return;
    disc([18, 18], 2.4, "#cc3311", true);
    disc([18, 36], 4, "#0072b2", false);
    pen.fillStyle = "#000";
    pen.fillText(`markers, ${measured.label}`, 28, 22);
    pen.fillText("the same markers of the sample", 28, 40);
  }

  let begun = null; // when time 0 was played
  function pause() {
    begun = null;
    play.textContent = "Play";
  }
  function run(now) {
    if (begun === null) return;
    frame.value = Math.floor((now - begun) / 1000 / step) % frames;
    draw();
    requestAnimationFrame(run);
  }
  play.addEventListener("click", () => {
    if (begun !== null) return pause();
    begun = performance.now() - 1000 * step * (frame.value % (frames - 1));
    play.textContent = "Pause";
    requestAnimationFrame(run);
  });
  form.addEventListener("submit", (event) => event.preventDefault());
  frame.addEventListener("input", () => { pause(); draw(); });
  for (const one of [sample, factor, turn]) one.addEventListener("input", () => { measure(); draw(); });
  measure();
  new ResizeObserver(draw).observe(canvas);
}
