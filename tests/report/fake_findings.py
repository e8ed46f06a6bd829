"""Made-up findings of a diagnosis: decision, features, sealed tests, sensors, track record."""

import numpy as np
import xarray as xr

from blockshake.diagnosis.gain.sealed_prediction import SealedTest
from blockshake.diagnosis.inference.decision import Decision
from blockshake.diagnosis.libraries.candidates import candidates
from blockshake.diagnosis.verdict.track_record import (
    Answers,
    JudgedCase,
    Median,
    Row,
    Share,
    TrackRecord,
    write_track_record,
)
from blockshake.effects.registry import EFFECTS
from blockshake.files import write_dataset
from blockshake.parity.finding import Finding
from blockshake.parity.parity import Parity

OPEN = ("alkion-100", "alkion-250", "basso-200")
SEALED = ("alkion-300", "basso-250")
MODELS = ("ls-dem", "nscd-rigid")
DRAWS = 10
CAUSES = {
    "none": [],
    "named": ["table-pitch"],
    "ambiguous": ["weak-joint", "rate-weakening-friction"],
    "combination": ["table-pitch", "eccentricity"],
    "unknown": [],
}


def gain_finding():
    """A marker that reads 3 % too much."""
    return Finding("sensor-gain", ("block-2-face",), "gain", np.array([0.03]), np.array([[1e-6]]), 2e-4, OPEN)


def made_up_decision(kind, structure):
    """A decision with every physical effect among its candidates."""
    keys = {}
    for candidate in candidates(structure):
        keys.setdefault(candidate.effect, []).append(candidate)
    causes = CAUSES[kind]
    order = [*causes, *(effect for effect in keys if effect not in causes)]
    rows, sizes = [], np.linspace(-2.0, 2.0, 41)
    for place, effect in enumerate(order):
        for number, candidate in enumerate(keys[effect]):
            ratio = (2.0 if kind == "none" else 60.0) - 7.0 * place - number
            estimates = [0.8 + 0.1 * test for test in range(len(OPEN))]
            rows.append({
                "key": candidate.key, "effect": effect, "log_ratio": ratio,
                "by_model": {MODELS[0]: ratio + 1.0, MODELS[1]: ratio - 2.0}, "size": 0.9, "sizes": sizes.tolist(),
                "weights": np.exp(-0.5 * ((sizes - 0.9) / 0.2) ** 2).tolist(), "model": MODELS[0], "distance": 1.1,
                "by_test": [{"estimate": one, "lower": one - 0.3, "upper": one + 0.4} for one in estimates],
            })  # fmt: skip
    rows.sort(key=lambda row: -row["log_ratio"])
    by_key = {candidate.key: candidate for group in keys.values() for candidate in group}
    best = {effect: group[0].key for effect, group in keys.items()}
    others = [] if kind == "none" else [effect for effect in order if effect not in causes]
    return Decision.model_validate({
        "decision": kind,
        "causes": causes,
        "places": {effect: best[effect] for effect in order},
        "sizes": dict.fromkeys(causes, 0.9),
        "p_none": 0.43 if kind == "none" else 0.012,
        "probabilities": {effect: 0.6 if effect in causes else 0.04 for effect in order},
        "adequacy": dict.fromkeys(order, 0.31),
        "constancy": dict.fromkeys(order, 0.41),
        "placebo": 6.5,
        "struck_out": {
            effect: ["another effect explains more", "its best fit leaves too much"] for effect in others
        },
        "solver_dependent": [],
        "shown_above": {effect: None if effect == "joint-compliance" else 0.45 for effect in order},
        "nominal_distance": 2.3,
        "parameters": {effect: _estimates(effect) for effect in causes[: 1 if kind == "combination" else 2]},
        "location": {effect: by_key[best[effect]].place for effect in causes},
        "candidates": rows,
    })  # fmt: skip


def _estimates(effect):
    first, *others = EFFECTS[effect].parameters
    step = first.visible - first.null
    values = sorted(first.null + size * step for size in (0.7, 0.9, 1.1))
    found = {
        first.name: {
            "lower": values[0],
            "estimate": values[1],
            "upper": values[2],
            "unit": first.unit,
            "informed": True,
        }
    }
    for item in others:
        found[item.name] = {
            "lower": item.lower, "estimate": 0.5 * (item.lower + item.upper), "upper": item.upper, "unit": item.unit,
            "informed": False,
        }  # fmt: skip
    return found


def evidence(best, readings):
    """Twelve features, the first explained best."""
    names = [
        f"joint{1 + place % 3}.rotation.{what}"
        for place in range(4)
        for what in ("onset+", "peak+", "residual")
    ]
    nominal = np.linspace(9.0, 1.0, len(names)) * np.where(np.arange(len(names)) % 2, 1.0, -1.0)
    rows = {
        "weight": nominal**2 - 0.04 * nominal**2,
        "nominal": nominal,
        "extended": 0.2 * nominal,
        "value": 0.01 * nominal,
    }
    return xr.Dataset(
        {name: ("row", values) for name, values in rows.items()},
        {
            "unit": ("row", ["rad"] * len(names)), "test": ("row", [OPEN[place % 3] for place in range(len(names))]),
            "feature": ("row", names),
        },
        {"candidate": best.key, "size": best.size, "model": best.model},
    )  # fmt: skip


def sealed_tests(nearer):
    """Sealed tests that the extended ensemble predicts better by a share of what the nominal one misses."""
    names = [f"{family}.{what}" for family in ("joint1", "joint2", "base", "top") for what in "abc"]
    tests = []
    for place, name in enumerate(SEALED):
        generator = np.random.default_rng(place)
        truth = 6.0 * generator.normal(size=len(names))
        centre = {"nominal": 0.0, "recalibrated": 0.1, "extended": nearer, "discrepancy": 0.3}
        members = {
            kind: {model: share * truth + generator.normal(size=(DRAWS, len(names))) for model in MODELS}
            for kind, share in centre.items()
        }
        tests.append(SealedTest(name, names, truth, members))
    return tests


def informed():
    """Information of the open tests on three nominal parameters, one of them a parameter of one solver alone."""
    names = ["friction.concrete.concrete", "materials.concrete.youngs_modulus", "ls_dem.node_spacing"]
    prior = np.array([[0.6, 40e9, 0.15], [0.75, 45e9, 0.2], [0.9, 50e9, 0.3]])
    only = np.array([[True, True, True], [True, True, False]])
    return xr.Dataset(
        {
            "prior": (("model", "quantile", "parameter"), np.where(only[:, None], prior, np.nan)),
            "posterior": (("model", "quantile", "parameter"), np.where(only[:, None], 0.9 * prior, np.nan)),
            "narrowing": (("model", "parameter"), np.where(only, 0.5, np.nan)),
            "skill": (("model", "parameter"), np.where(only, 0.4, np.nan)),
            "informed": (("model", "parameter"), only & [True, False, True]),
        },
        {"model": list(MODELS), "parameter": names, "quantile": [0.05, 0.5, 0.95]},
    )


def parity(structure, findings):
    """Sensors' checks of one body's markers, the other's too few."""
    markers = {marker.name: {"noise": 1e-4, "misfit": 1e-4} for marker in structure.file.markers}
    markers[structure.file.markers[-1].name] = {"noise": None, "misfit": None}
    return Parity.from_json({
        "findings": [finding.as_json() for finding in findings],
        "markers": markers,
        "clock": {name: {"lag": 3e-5, "lag_error": 1e-4} for name in OPEN},
        "channels": {},
        "transducers": {"wire-1": {"gain": 2e-3, "gain_error": 1e-3}, "wire-2": {"gain": None, "gain_error": None}},
        "looked_at": 214,
        "falls": {},
        "gaps": {},
    })  # fmt: skip


def track_record():
    """A track record whose answers are many enough for an interval, with a goal missed."""
    cases, seed = [], 0
    rows = []
    for truth, size, answers in (
        ("none", None, {"none": 59, "wrong": 1}),
        ("table-pitch", "large", {"right": 2, "set_with": 1}),
        ("weak-joint", "small", {"none": 1, "set_with": 1, "unknown": 1}),
    ):
        rows.append(Row(truth=truth, size=size, answers=Answers(**answers)))
        for answer, count in answers.items():
            for _ in range(count):
                seed += 1
                cases.append(
                    JudgedCase(
                        name=f"case-{seed}",
                        seed=seed,
                        structure="two-blocks",
                        truth=truth,
                        size=size,
                        answer=answer,
                    )
                )
    return TrackRecord(
        date="2026-11-20", commit="0123456789ab", procedure="ba9876543210", machine="two cores",
        efforts={"two-blocks": "standard"}, seeds="fedcba987654",
        shares={
            "false-alarm": Share(
                meaning="clean campaigns called an effect", hits=1, n=60, lower=0.0004, upper=0.0894, goal=0.05,
                side="at most",
            ),
            "covered": Share(
                meaning="truth named or in the set", hits=4, n=6, lower=0.2228, upper=0.9567, goal=0.88
            ),
        },
        medians={"gain": Median(meaning="sealed gain when named right", n=2, estimate=0.7, goal=0.6)},
        confusion=tuple(rows), cases=tuple(cases),
    )  # fmt: skip


def write_made_up_track_record(path):
    """Write `track_record` to a file."""
    write_track_record(path, track_record())


def write_horizons(folder):
    """How long each open test can be predicted, by both solvers, a file each."""
    paths = [folder / f"{name}-predictability.nc" for name in OPEN]
    for path, horizon in zip(paths, ([3.0, 3.5], [2.0, 2.5], [5.0, 6.0]), strict=True):
        write_dataset(path, xr.Dataset({"horizon": ("model", horizon)}, {"model": list(MODELS)}))
    return paths


def made_up_forces(tests, bodies):
    """Joint forces of tests, as `measured_forces` has them."""
    time = np.arange(0.0, 4.0, 0.01)
    shape = len(tests), len(time)
    swing = 0.39 * np.sign(np.sin(2.0 * np.pi * time))
    joints = [f"{lower}-{upper}" for lower, upper in zip(["slab", *bodies], bodies, strict=False)]

    def along(values, names):
        return (("test", "time", "joint" if names is joints else "body"), np.broadcast_to(
            np.asarray(values, dtype=np.float32)[None, :, None], (*shape, len(names))
        ).copy())  # fmt: skip

    columns = {
        "lever": swing, "lever_error": np.full(len(time), 3e-3), "normal": np.full(len(time), 2e5),
        "shear": 1e4 * swing, "side": np.sign(swing), "rotation": 0.01 * swing, "slip_rate": 0.05 * swing,
        "work": 200.0 * time,
    }  # fmt: skip
    return xr.Dataset(
        {
            "read": (("test", "time"), np.ones(shape, np.int8)),
            **{name: along(values, joints) for name, values in columns.items()},
            "unexplained": along(-2e3 * (time > 2.0), bodies),
            "told": (
                ("test", "joint", "law", "time"),
                np.ones((len(tests), len(joints), 3, len(time)), np.int8),
            ),
            "table_rotation": (("test", "time"), np.broadcast_to(1e-5 * swing, shape)),
            "table_acceleration": (("test", "time"), np.broadcast_to(2.0 * swing, shape)),
            "table_moment": (("test", "time"), np.broadcast_to(1e4 * np.cos(time), shape)),
            "half_width": ("joint", np.full(len(joints), 0.38)),
            "coefficient": ("joint", np.full(len(joints), 0.75)),
        },
        {
            "test": list(tests),
            "time": time,
            "joint": joints,
            "body": list(bodies),
            "law": ["lever", "friction", "closed"],
        },
        {"outside": "null", "weight": 7.2e4},
    )
