"""Made-up findings of a diagnosis: decision, forces, histories, sensors, gain."""

import numpy as np
import xarray as xr

from blockshake.diagnosis.answer.decision import Decision
from blockshake.diagnosis.verdict.verdict import Contrast, Gain
from blockshake.effects.registry import EFFECTS
from blockshake.parity.finding import Finding
from blockshake.parity.parity import Parity
from blockshake.statistics.intervals import share_interval
from blockshake.statistics.resampling import resampled_weights
from blockshake.study.extension.changes import quantities

OPEN = ("alkion-100", "alkion-250", "basso-200")
SEALED = ("alkion-300", "basso-250")
KINDS = ("none", "named", "ambiguous", "combination", "unknown")
MODELS = ("ls-dem", "nscd-rigid")
PUSH = {"starts": {"alkion-250": 2.2, "basso-200": 2.7}}


def gain_finding():
    """A marker that reads 3 % too much."""
    return Finding("sensor-gain", ("block-2-face",), "gain", np.array([0.03]), np.array([[1e-6]]), 2e-4, OPEN)


def cause(name, place, places, sizes, odds=0.0, when=None):
    """A cause as in ``decision.json``; ``sizes``: (estimate, unit) by parameter, intervals a tenth to either side."""
    parameters = {}
    for key, (value, unit) in sizes.items():
        lower, upper = sorted((0.9 * value, 1.1 * value))
        parameters[key] = {"estimate": value, "lower": lower, "upper": upper, "unit": unit}
    members = [
        {key: value * (1.0 + 0.02 * number) for key, (value, _) in sizes.items()} for number in range(-3, 4)
    ]
    return {
        "name": name, "place": place, "places": places, "gain": 60.0 - odds, "odds": odds, "parameters": parameters,
        "members": members, "when": when or {},
    }  # fmt: skip


ECCENTRIC = cause("eccentricity", {"body": "block-2"}, ["block-2"], {"offset": (0.05, "m")})
PITCH = cause("table-pitch", {}, ["all"], {"coefficient": (5e-4, "rad s2/m"), "frequency": (11.0, "Hz")})
WEAK = cause("weak-joint", {"joint": ["slab", "block-1"]}, ["slab-block-1"], {"factor": (0.41, "1")})
RATE = cause("rate-weakening-friction", {}, ["all"], {"drop": (0.61, "1"), "scale": (0.012, "m/s")}, 1.5)
TOP = {"body": "block-2", "height": 0.42}
PUSHED = cause("push", TOP, ["block-2@0.42", "block-1@0"], {"force": (-2e3, "N")}, when=PUSH)


def part(readings, *causes):
    """A part of the readings with its causes, among rivals that are far less likely."""
    of_joints = {"changed-edge": 12.0, "eccentricity": 55.0}
    others = {"table-pitch": 40.0} if readings.startswith("rotation") else of_joints
    odds = {**others, **{one["name"]: one["odds"] for one in causes}}
    gains = {key: 60.0 - value for key, value in odds.items()}
    return {"readings": readings, "causes": causes, "odds": odds, "gains": gains}


PARTS = {
    "none": [],
    "named": [part("joints", ECCENTRIC)],
    "ambiguous": [part("joints", WEAK, RATE)],
    "combination": [part("rotation of the slab", PITCH), part("joints", ECCENTRIC)],
    "unknown": [part("joints", PUSHED)],
}


def _history(quantity, unit, sizes, **changed):
    sizes = [{"estimate": one, "lower": one - 0.01, "upper": one + 0.01, "unit": unit} for one in sizes]
    values = {
        "parameter": "inset",
        "place": {},
        "tests": OPEN[1:],
        "sizes": sizes,
        "gain": -1.5,
        "changes": False,
    }
    return {"quantity": quantity, **values, **changed}


WORN = _history("edges", "m", (0.01, 0.05), place={"joint": ["slab", "block-1"]}, gain=30.0, changes=True)
SOUND = _history("friction", "1", (0.01, 0.02), parameter="change")


def made_up_decision(kind):
    """A decision of a kind."""
    return Decision.model_validate({
        "decision": kind,
        "parts": PARTS[kind],
        "probabilities": {name: 0.0 for name, effect in EFFECTS.items() if effect.acts != "observation"},
        "limits": {
            "eccentricity": {"block-1": 0.021, "block-2": 0.019},
            "weak-joint": {"slab-block-1": 0.66},
            "stopper-contact": {"block-1@0": 4e5, "block-1@0.42": 2e4},
            "table-pitch": {"all": 5e-5},
        },
        "excluded_above": {"table-pitch": 5e-5, "eccentricity": 0.021},
        "p": 1.0 if kind == "none" else 1e-12,
        "where": "no departure larger than chance" if kind == "none" else "block-2 in basso-200 at 2.70 s: -2.1 kN",
        "tests": OPEN,
        "silent": OPEN[:1],
        "n_rows": 672,
        "cannot_see": ["the rotation of block-4, which has one marker"],
        "histories": [WORN, SOUND] if kind == "unknown" else [SOUND],
    })  # fmt: skip


def departures(kind, bodies):
    """Forces on blocks and motion of the slab, as `departures` and `slab_departures` have them."""
    time = np.concatenate([np.arange(2.0, 3.0, 0.02), np.arange(4.0, 6.0, 0.02)])
    tests, count = OPEN[1:], len(bodies)
    noise = np.random.default_rng(1).normal(size=(len(tests) * len(time), count)) * 300.0
    explained = np.tile(np.where(time > 2.5, -2e3, 0.0), len(tests))[:, None] / np.arange(1, count + 1)
    explained = explained if kind not in ("none",) else np.zeros_like(explained)
    along, slab = np.tile(time, len(tests)), np.arange(0.0, 6.0, 0.05)
    turn = np.tile(5e-4 * np.sin(6.0 * slab), len(OPEN))
    made = turn if kind == "combination" else 0.0 * turn
    values = {"measured": explained + noise, "deviation": np.full_like(noise, 300.0), "explained": explained}
    turns, lifts = (made, "rad"), (0.0 * turn, "m")
    moves = {"turn": turns, "turn_explained": turns, "lift": lifts, "lift_explained": lifts}
    return xr.Dataset(
        {
            **{name: (("instant", "body"), one, {"units": "N"}) for name, one in values.items()},
            **{name: ("reading", one, {"units": unit}) for name, (one, unit) in moves.items()},
        },
        {
            "test": ("instant", np.repeat(tests, len(time))), "time": ("instant", along), "body": list(bodies),
            "slab_test": ("reading", np.repeat(OPEN, len(slab))), "slab_time": ("reading", np.tile(slab, len(OPEN))),
        },
    )  # fmt: skip


def histories(tests, joints, top, kinds=None):
    """Bands of ensembles with measured curves, by kind where there are several."""
    time = np.arange(0.0, 6.0, 0.02)
    cells = [("rotation", joint, "rad") for joint in joints] + [("slip", joint, "m") for joint in joints]
    cells.append(("drift", top, "m"))
    sway = 0.02 * np.sin(5.0 * time)[:, None] * np.linspace(0.2, 1.0, len(cells))
    measured = np.broadcast_to(1.3 * sway, (len(tests), *sway.shape))
    band = np.stack([0.8 * sway, sway, 1.2 * sway])
    band = np.broadcast_to(band, (len(tests), *band.shape))
    dims = ("test", "quantile", "time", "cell")
    if kinds:
        factors = 1.0 + 0.3 * (np.array(kinds) == "extended")
        band, dims = factors[:, None, None, None, None] * band, ("kind", *dims)
    quantity, where, unit = zip(*cells, strict=True)
    found = xr.Dataset(
        {
            "band": (dims, band),
            "measured": (("test", "time", "cell"), measured),
            "horizon": (("test", "cell"), np.full((len(tests), len(cells)), 4.0), {"units": "s"}),
        },
        {
            "test": list(tests), "time": time, "quantile": [0.05, 0.5, 0.95],
            "cell": [f"{a} {b}" for a, b, _ in cells],
            "quantity": ("cell", list(quantity)), "where": ("cell", list(where)), "unit": ("cell", list(unit)),
        },
    )  # fmt: skip
    return found.assign_coords(kind=list(kinds)) if kinds else found


def misfit(joints, top):
    """Misfit of the nominal simulation, as `misfit` has it."""
    found = histories(OPEN, joints, top)
    shape = (found.sizes["test"], found.sizes["cell"])
    score = 1e-3 * (1.0 + np.arange(np.prod(shape)).reshape(shape))
    return found.assign(
        score=(("test", "cell"), score),
        usual=(("test", "cell"), np.full(shape, 2e-3)),
        chance=(("test", "cell"), np.full(shape, 0.04)),
        worst_time=(("test", "cell"), np.full(shape, 3.1)),
        p=0.04,
    ).assign_attrs(where=f"drift of {top} in {OPEN[2]}")


def responses(joints, top):
    """Gain on the responses of sealed tests, as `response_gain` has it."""
    kinds = ["nominal", "recalibrated", "extended", "placebo", "discrepancy"]
    found = histories(SEALED, joints, top, kinds)
    drift = np.random.default_rng(1).lognormal(np.log(0.02), 0.1, 24)
    sides = [(factor * drift, 0.1 * factor * drift, drift < 0.0) for factor in (1.0, 1.3)]
    effect = quantities(sides, resampled_weights(24, np.random.default_rng(2))).rename(quantity="response")
    effect = effect.assign(paired=24, largest=("response", [0.0262, 0.0262, 0.0026, np.nan, np.nan]))
    score = np.array([0.9, 0.8, 0.3, 0.8, 0.7])
    return found.merge(xr.concat([effect, effect], dim=xr.Variable("test", list(SEALED)))).assign(
        score=("kind", score),
        floor=0.2,
    )


def gain(estimate=0.8):
    """The same gain against every rival."""
    contrast = Contrast(estimate=estimate, lower=estimate - 0.1, upper=estimate + 0.1)
    return Gain(recalibrated=contrast, nominal=contrast, discrepancy=contrast)


def parity(structure, findings):
    """Sensors' checks of one body's markers, the other's too few."""
    markers = {marker.name: {"noise": 1e-4, "misfit": 1e-4} for marker in structure.file.markers}
    markers[structure.file.markers[-1].name] = {"noise": None, "misfit": None}
    told, untold = {"gain": 2e-3, "gain_error": 1e-3}, {"gain": None, "gain_error": None}
    return Parity.from_json({
        "findings": [finding.as_json() for finding in findings],
        "sensors": {},
        "markers": markers,
        "clock": {name: {"lag": 3e-5, "lag_error": 1e-4} for name in OPEN},
        "channels": {"block-1-acc-x": told, "block-1-acc-z": untold},
        "transducers": {"wire-1": told, "wire-2": untold},
        "looked_at": 214,
        "falls": {},
        "gaps": {},
    })  # fmt: skip


def track_record():
    """A track record with a goal that is met and one that is missed, and a share without a goal."""

    def share(meaning, hits, n, goal, side):
        lower, upper = share_interval(hits, n)
        bounds = {"lower": lower, "upper": upper}
        return {"meaning": meaning, "hits": hits, "n": n, "goal": goal, "side": side, **bounds}

    empty = {"medians": {}, "confusion": [], "cases": []}
    origin = {"date": "2026-11-20", "commit": "0123456789ab", "machine": "made up", "seeds": "none"}

    def shares(alarms, covered):
        return {
            "false_alarms": share("clean campaigns called an effect", alarms, 30, 0.05, "at most"),
            "truth_in_set_seen": share("truth named or in the set", covered, 6, 0.88, "at least"),
            "other": share("a share that has no goal", 1, 2, None, "at least"),
        }

    return {
        **origin,
        **empty,
        "version": 2,
        "procedure": "ba9876543210",
        "part": "1/4",
        "shares": shares(1, 5),
        "laboratories": {"home": shares(0, 6), "mujoco": shares(1, 4)},
    }
