"""A test in MuJoCo's laboratory: a structure, its true parameters and what is hidden, as plain numbers; and readings.

The task that the peers' program is given, and exact readings from its answer. Causes act in forms of this
laboratory's own: parameters and places are those of the registry and of `outside_forces`.
"""

import json
import os
import subprocess
import tempfile
from pathlib import Path

import numpy as np
import scipy
import xarray as xr
from case_plan import DURATION
from case_truth import follow, scattered_blocks, true_places, true_table
from outside_forces import OUTSIDE, acting_mass
from scipy.interpolate import CubicSpline

from blockshake.dynamics.load_motion import load_motion
from blockshake.effects.places import joints
from blockshake.geometry.rotations import rotation_matrices

PYTHON = Path(__file__).parents[1] / ".venv-peers" / "bin" / "python"
PROGRAM = Path(__file__).with_name("mujoco_laboratory.py")
TIME_STEP, EVERY = 2e-4, 5  # as the program has them
MARKER_RATE, CHANNEL_RATE = 200.0, 512.0  # Hz
_PITCH_DAMPING = 0.3  # of critical
_CUTOFF = 50.0  # Hz, of the accelerometers' low-pass
_BED_DAMPING = 0.05  # of critical, of a slab on its bed
_FRICTION_LAW = {
    "asymmetry": 0.0, "rate_drop": 0.0, "rate_scale": 0.01, "slip_drop": 0.0, "slip_scale": 0.01,
}  # fmt: skip
_PUSH_RAMP = 0.25  # s
_SURVEY = 1e-4  # m and rad
_MOST_TILT = 0.4  # rad: a block that tilts farther falls


def truth(structure, seed):
    """Truth of a case next to its causes: the scatter of its blocks and joints, and the table."""
    friction, density = scattered_blocks(structure, seed)
    return {"model": "mujoco", "friction": friction, "density": density, "table": true_table(seed)}


def tests(structure, plan, causes, true, seed, most_tilt):
    """Exact readings of every test of a plan, the scale of its motion and the run's facts, as by `own_laboratory`."""
    task = describe(structure, true["friction"], true["density"])
    motions = [follow(load_motion(motion, scale), true["table"]) for motion, scale, _ in plan]
    for number, motion in enumerate(motions):
        places = dict(zip(structure.body_names, true_places(structure, seed, number), strict=True))
        task["tests"].append(describe_test(task, motion, DURATION, places, min(most_tilt, _MOST_TILT)))
    for cause in causes:
        hide(task, cause, structure, motions)
    answer = run_laboratory(task)
    for number, (_, scale, _) in enumerate(plan):
        run = ExactRun(structure, task, number, answer)
        facts = {"status": "completed", "end_time": DURATION, "tilt": run.tilt, "deepest": run.deepest}
        test = exact_test(run, *_faults(causes))
        _survey(
            test, structure, true_places(structure, seed, number), np.random.default_rng([seed, 3, number])
        )
        yield test, round(scale * run.factor, 9), facts


def _faults(causes):
    """Lag of the markers' clock, and by marker drift of the zero and offset from the stated place."""
    lag, creep, offset = 0.0, {}, {}
    for cause in causes:
        values, place = cause["values"], cause["place"]
        if cause["name"] == "clock-lag":
            lag = values["lag"]
        elif cause["name"] == "sensor-drift":
            creep[place["marker"]] = np.array([values["rate"], 0.0, 0.0])
        elif cause["name"] == "marker-offset":
            offset[place["marker"]] = np.array([0.0, 0.0, values["height"]])
    return lag, creep, offset


def _survey(test, structure, places, generator):
    """Add where a survey finds the blocks, within 0.1 mm and 0.1 mrad."""
    found = places + np.where(structure.driven[:, None], 0.0, generator.normal(0.0, _SURVEY, places.shape))
    zero = np.zeros(len(places))
    test.coords["body"] = structure.body_names
    test["initial_offset"] = (("body", "axis"), np.stack([found[:, 0], found[:, 1], zero], 1), {"units": "m"})
    test["initial_rotation"] = (("body", "axis"), np.stack([zero, zero, found[:, 2]], 1), {"units": "rad"})


def is_there():
    """Whether the peers' environment has MuJoCo."""
    return (
        PYTHON.exists()
        and not subprocess.run([PYTHON, "-c", "import mujoco"], capture_output=True, check=False).returncode
    )


def run_laboratory(task):
    """Answer of MuJoCo's laboratory to a task: arrays by name, as its program describes them."""
    one_thread = {**os.environ, "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
    with tempfile.TemporaryDirectory() as folder:
        asked, answer = Path(folder) / "task.json", Path(folder) / "answer.npz"
        asked.write_text(json.dumps(task, default=np.ndarray.tolist))
        run = subprocess.run(
            [PYTHON, PROGRAM, asked, answer], capture_output=True, text=True, env=one_thread, check=False
        )
        if run.returncode != 0:
            raise RuntimeError(f"MuJoCo's laboratory failed: {run.stdout[-500:]}{run.stderr[-1500:]}")
        with np.load(answer) as arrays:
            return {name: arrays[name] for name in arrays.files}


def describe(structure, friction, density):
    """A structure of boxes as the laboratory takes it.

    Parameters
    ----------
    structure : Structure
        Boxes that stand upright, the first of them the slab.
    friction : dict of str to float
        Factor on the coefficient of a joint, by its upper and lower body's names, joined by a slash.
    density : dict of str to float
        Factor on the density of a body, by name.
    """
    file = structure.file

    def body_of(body):
        shape = file.shapes[body.shape]
        own = body.density or file.materials[body.material].density
        return {
            "name": body.name, "box": list(shape.box), "chamfer": shape.chamfer or 0.0,
            "position": [float(value) for value in body.position], "density": own * density.get(body.name, 1.0),
            "mass_offset": list(body.mass_offset),
        }  # fmt: skip

    slab, *blocks = (body_of(body) for body in sorted(file.bodies, key=lambda body: not body.driven))
    found = [place["joint"] for place in joints(structure)]
    names = structure.body_names
    return {
        "slab": slab | {"compliance": 0.0, "damping": 0.0},
        "bodies": blocks,
        "joints": [
            {
                "lower": lower, "upper": upper, "compliance": 0.0, "damping_ratio": 1.0, "law": None,
                "friction": float(structure.friction[names.index(lower), names.index(upper)])
                * friction.get(f"{upper}/{lower}", 1.0),
            }
            for lower, upper in found
        ],
        "sensors": [
            {"body": sensor.body, "position": [float(value) for value in sensor.position]}
            for sensor in file.accelerometers
        ],
        "tests": [],
    }  # fmt: skip


def describe_test(task, motion, duration, places, most_tilt):
    """A test of a task: the motion at the laboratory's steps, the blocks' poses at the start.

    Parameters
    ----------
    task : dict
    motion : GroundMotion
        The table.
    duration : float
        [s]
    places : dict of str to float64 array, shape (3,)
        Where blocks stand off the structure file, along x and y [m], turned about z [rad].
    most_tilt : float
        Largest tilt of a block [rad]; the laboratory makes the motion smaller until it holds.
    """
    time = TIME_STEP * np.arange(round(duration / TIME_STEP) + 1)
    speed = motion.evaluate(time, derivative=1)
    kept = motion.evaluate(time[::EVERY]) - motion.evaluate(time[:1])
    gain = np.diff(speed, axis=0) / TIME_STEP
    poses = []
    for body in task["bodies"]:
        x, y, turn = places.get(body["name"], np.zeros(3))
        at = np.array(body["position"]) + np.array([x, y, 0.0])
        poses.append([*at.tolist(), float(np.cos(0.5 * turn)), 0.0, 0.0, float(np.sin(0.5 * turn))])
    return {
        "poses": poses, "most_tilt": most_tilt, "forces": [], "at_once": False,
        "chamfers": {body["name"]: body["chamfer"] for body in task["bodies"]},
        "motion": {
            "x": gain[:, 0], "z": gain[:, 2], "pitch": np.zeros(len(gain)), "moved_x": kept[:, 0],
            "moved_z": kept[:, 2],
        },
    }  # fmt: skip


def hide(task, cause, structure, motions):
    """Put a cause into a task, in place; faults of markers act on the readings alone.

    Parameters
    ----------
    task : dict
    cause : dict
        As of `case_truth.true_causes`.
    structure : Structure
    motions : list of GroundMotion
        The tests.
    """
    name, values, place = cause["name"], cause["values"], cause["place"]
    if name in OUTSIDE:
        _HIDE_OUTSIDE[name](task, cause, structure)
    elif name in _HIDE:
        _HIDE[name](task, values, place)
    elif name in _MOVE:
        for test, motion in zip(task["tests"], motions, strict=True):
            _MOVE[name](test["motion"], values, motion)


def _table_pitch(motion, values, commanded):
    """The table's pitch is an oscillator of 30 % of critical damping that the acceleration drives."""
    omega = 2.0 * np.pi * values["frequency"]
    time = TIME_STEP * np.arange(len(motion["x"]))
    system = ([omega**2], [1.0, 2.0 * _PITCH_DAMPING * omega, omega**2])
    motion["pitch"] = values["coefficient"] * scipy.signal.lsim(system, motion["x"], time)[1]


def _vertical_motion(motion, values, commanded):
    """A share of the horizontal motion, later, from the start of the shaking on."""
    time = TIME_STEP * np.arange(len(motion["x"]) + 1) - values["delay"]
    speed = commanded.evaluate(time, derivative=1)[:, 0]
    place = commanded.evaluate(time[::EVERY])[:, 0]
    motion["z"] = values["ratio"] * np.diff(speed) / TIME_STEP
    motion["moved_z"] = values["ratio"] * (place - place[0])


def _stopper(task, values, place):
    body = _body(task, place["body"])
    side = 1.0 if place["axis"] == "+x" else -1.0
    at = [0.5 * side * body["box"][0], 0.0, 0.5 * body["box"][2]]
    stop = [side, values["gap"], values["stiffness"]]
    for test in task["tests"]:
        test["forces"].append(_force(place["body"], at, stops=[stop]))


def _restitution(task, values, place):
    """Underdamped contact: an impact keeps ``exp(-pi z / sqrt(1 - z^2))`` of its speed."""
    lost = -np.log(max(values["increase"], 1e-3))
    for joint in task["joints"]:
        joint["damping_ratio"] = float(lost / np.hypot(np.pi, lost))


def _bearing(task, values, place):
    for test in task["tests"]:
        for name in test["chamfers"]:
            test["chamfers"][name] += values["inset"]


def _eccentricity(task, values, place):
    _body(task, place["body"])["mass_offset"][0] += values["offset"]


def _mass(task, values, place):
    _body(task, place["body"])["density"] *= 1.0 + values["excess"]


def _weak_joint(task, values, place):
    for joint in task["joints"]:
        if {joint["lower"], joint["upper"]} == set(place["joint"]):
            joint["friction"] *= values["factor"]


def _friction_law(task, **law):
    for joint in task["joints"]:
        joint["law"] = _FRICTION_LAW | law


def _soft_joint(task, values, place):
    for joint in task["joints"]:
        if {joint["lower"], joint["upper"]} == set(place["joint"]):
            joint["compliance"] = values["compliance"]


def _soft_base(task, values, place):
    """The slab turns about its bottom on a spring and a dashpot."""
    heights = np.array([body["position"][2] for body in task["bodies"]])
    masses = np.array([np.prod(body["box"]) * body["density"] for body in task["bodies"]])
    inertia = float((masses * heights**2).sum())
    task["slab"]["compliance"] = values["compliance"]
    task["slab"]["damping"] = 2.0 * _BED_DAMPING * float(np.sqrt(inertia / values["compliance"]))


def _push(task, cause, structure):
    own = cause["values"]
    most = own["side"] * own["share"] * acting_mass(structure, cause) * 9.81
    for test, start in zip(task["tests"], cause["start"], strict=True):
        if start is not None:
            history = {"times": [start, start + _PUSH_RAMP], "values": [0.0, most]}
            test["forces"].append(_force(cause["place"]["body"], _at(own), **history))


def _blow(task, cause, structure):
    """Half a sine wave whose impulse changes the mass's speed by what is requested."""
    own = cause["values"]
    phase = np.linspace(0.0, 1.0, 21)
    peak = own["side"] * own["speed"] * acting_mass(structure, cause) * np.pi / (2.0 * own["length"])
    for test, start in zip(task["tests"], cause["start"], strict=True):
        if start is not None:
            history = {
                "times": (start + own["length"] * phase).tolist(),
                "values": (peak * np.sin(np.pi * phase)).tolist(),
            }
            test["forces"].append(_force(cause["place"]["body"], _at(own), **history))


def _steady(task, cause, **force):
    for test in task["tests"]:
        test["forces"].append(_force(cause["place"]["body"], _at(cause["values"]), **force))


def _rope(task, cause, structure):
    _steady(task, cause, stiffness=cause["values"]["stiffness"] * acting_mass(structure, cause))


def _drag(task, cause, structure):
    _steady(task, cause, damping=cause["values"]["damping"] * acting_mass(structure, cause))


def _brake(task, cause, structure):
    _steady(task, cause, dry=cause["values"]["share"] * acting_mass(structure, cause) * 9.81)


def _spring_once(task, cause, structure):
    own, body = cause["values"], _body(task, cause["place"]["body"])
    at = [0.5 * own["side"] * body["box"][0], 0.0, own["height"]]
    for test, start in zip(task["tests"], cause["start"], strict=True):
        if start is not None:
            stop = [own["side"], own["gap"], own["stiffness"]]
            test["forces"].append(_force(body["name"], at, stops=[stop]))


def _loose_weight(task, cause, structure):
    own, body = cause["values"], _body(task, cause["place"]["body"])
    length, depth, height = body["box"]
    edge = min(0.25 * length, 0.2)
    mass = own["share"] * structure.mass[structure.body_names.index(body["name"])]
    at = np.array(body["position"]) + np.array([0.0, 0.0, 0.5 * (height + edge)])
    on = next(joint for joint in task["joints"] if joint["upper"] == body["name"])
    weight = {
        "name": "loose-weight", "box": [2.0 * edge, 0.5 * depth, edge], "chamfer": 0.0, "position": at.tolist(),
        "density": float(mass / (edge * edge * depth)), "mass_offset": [0.0, 0.0, 0.0],
    }  # fmt: skip
    task["bodies"].append(weight)
    task["joints"].append(
        on | {"lower": body["name"], "upper": weight["name"], "friction": own["grip"] * on["friction"]}
    )
    for test in task["tests"]:
        x, y, z, *turn = test["poses"][task["bodies"].index(body)]
        test["poses"].append([x, y, z + 0.5 * (height + edge), *turn])
        test["chamfers"][weight["name"]] = 0.0


def _broken_edge(task, cause, structure):
    at = _body(task, cause["place"]["body"])["position"]
    row = [b["name"] for b in task["bodies"] if (b["position"][0], b["position"][2]) == (at[0], at[2])]
    for test, start in zip(task["tests"], cause["start"], strict=True):
        if start is not None:
            for name in row:
                test["chamfers"][name] += cause["values"]["depth"]


def _body(task, name):
    return next(body for body in task["bodies"] if body["name"] == name)


def _at(values):
    return [0.0, 0.0, values["height"]]


def _force(body, position, **parts):
    """A force along x on a point of a body, of these parts and no others."""
    none = {"times": [], "values": [], "stiffness": 0.0, "damping": 0.0, "dry": 0.0, "stops": []}
    return {"body": body, "position": position, **none, **parts}


_MOVE = {"table-pitch": _table_pitch, "vertical-motion": _vertical_motion}
_HIDE = {
    "stopper-contact": _stopper,
    "impact-restitution": _restitution,
    "reduced-bearing": _bearing,
    "eccentricity": _eccentricity,
    "block-mass": _mass,
    "weak-joint": _weak_joint,
    "rate-weakening-friction": lambda task, values, place: _friction_law(
        task, rate_drop=values["drop"], rate_scale=values["scale"]
    ),
    "slip-weakening-friction": lambda task, values, place: _friction_law(
        task, slip_drop=values["drop"], slip_scale=values["scale"]
    ),
    "friction-asymmetry": lambda task, values, place: _friction_law(task, asymmetry=values["asymmetry"]),
    "joint-compliance": _soft_joint,
    "base-compliance": _soft_base,
}
_HIDE_OUTSIDE = {
    "outside-push": _push,
    "outside-blow": _blow,
    "outside-rope": _rope,
    "outside-drag": _drag,
    "outside-dry-drag": _brake,
    "outside-spring-once": _spring_once,
    "outside-weight": _loose_weight,
    "outside-edge": _broken_edge,
}


class ExactRun:
    """Readings of ideal sensors of a test: markers at any time of the test, channels at `CHANNEL_RATE`."""

    def __init__(self, structure, task, number, answer):
        poses = answer[f"{number}-pose"]
        self.factor, self.tilt, self.deepest = (
            float(answer[f"{number}-{name}"]) for name in ("factor", "tilt", "deepest")
        )
        self.structure = structure
        names = [task["slab"]["name"], *(body["name"] for body in task["bodies"])]
        order = [names.index(name) for name in structure.body_names]
        self.middle, self.turn = poses[:, order, :3], rotation_matrices(poses[:, order, 3:])
        self.time = TIME_STEP * EVERY * np.arange(len(poses))
        self.forces = answer[f"{number}-force"]

    def markers(self, offset):
        """Places of all markers, a cubic spline in time; ``offset`` by marker [m], in its body's frame."""
        bodies = self.structure.carriers(self.structure.file.markers)
        arms = np.array([
            np.array(marker.position) + offset.get(marker.name, 0.0) for marker in self.structure.file.markers
        ])  # fmt: skip
        places = self.middle[:, bodies] + np.einsum("tmij,mj->tmi", self.turn[:, bodies], arms)
        return CubicSpline(self.time, places)

    def channels(self):
        """Times [s] and readings of the accelerometers, low-passed at 50 Hz without lag."""
        ends = TIME_STEP * (np.arange(len(self.forces)) + 0.5)
        low = scipy.signal.butter(4, _CUTOFF, fs=1.0 / TIME_STEP, output="sos")
        smooth = scipy.signal.sosfiltfilt(low, self.forces, axis=0)
        sensors = self.structure.file.accelerometers
        time = np.arange(int(self.time[-1] * CHANNEL_RATE) + 1) / CHANNEL_RATE
        columns = [smooth[:, i, "xyz".index(axis)] for i, item in enumerate(sensors) for axis in item.axes]
        return time, np.stack([np.interp(time, ends, column) for column in columns], axis=1)


def exact_test(run, lag, creep, offset):
    """A test's readings without noise, as in a campaign's test file.

    Parameters
    ----------
    run : ExactRun
    lag : float
        The markers' clock [s].
    creep, offset : dict of str to array, shape (3,)
        By marker: drift of its zero [m/s], and where it sits off its stated place [m].
    """
    structure = run.structure
    names = [marker.name for marker in structure.file.markers]
    time = np.arange(round(run.time[-1] * MARKER_RATE) + 1) / MARKER_RATE
    places = run.markers(offset)
    first = places(0.0)
    displacement = places(np.clip(time - lag, 0.0, run.time[-1])) - first
    for name, rate in creep.items():
        displacement[:, names.index(name)] += time[:, None] * rate
    clock, channels = run.channels()
    carriers = [f"{item.name}-{axis}" for item in structure.file.accelerometers for axis in item.axes]
    return xr.Dataset(
        {
            "marker_displacement": (("time", "marker", "axis"), displacement, {"units": "m"}),
            "marker_initial_position": (("marker", "axis"), first, {"units": "m"}),
            "accelerometer": (("time_acc", "channel"), channels, {"units": "m s-2"}),
        },
        {
            "time": ("time", time, {"units": "s"}), "marker": names, "axis": list("xyz"),
            "time_acc": ("time_acc", clock, {"units": "s"}), "channel": carriers,
        },
        {"Conventions": "CF-1.11", "title": "test by MuJoCo: synthetic, not measured", "synthetic": 1},
    )  # fmt: skip
