"""A campaign with its diagnosis whose results are made up: right in form, never simulated."""

from pathlib import Path

import numpy as np
import xarray as xr

from blockshake.diagnosis.candidates import candidates
from blockshake.diagnosis.conclusion import conclude
from blockshake.diagnosis.consequence import consequence
from blockshake.diagnosis.finding import Finding
from blockshake.diagnosis.frozen import freeze
from blockshake.diagnosis.gain import gain_of_verdict, gain_on
from blockshake.diagnosis.licence import Answers, Case, Licence, Median, Row, Share, write_licence
from blockshake.diagnosis.misfit import misfit, where
from blockshake.diagnosis.reading import HISTORIES
from blockshake.diagnosis.sealed_test import SealedTest
from blockshake.diagnosis.verdict import Verdict, write_verdict
from blockshake.effects.registry import EFFECTS
from blockshake.files import write_dataset, write_json, write_text
from blockshake.geometry.structure import load_structure

STRUCTURE = "configuration-1"
OPEN = ("alkion-100", "alkion-250", "basso-200")
SEALED = ("alkion-300", "basso-250")
MODELS = ("ls-dem", "nscd-rigid")
CAUSES = {
    "none": [],
    "named": ["table-pitch"],
    "ambiguous": ["weak-joint", "rate-weakening-friction"],
    "combination": ["table-pitch", "eccentricity"],
    "unknown": [],
}
_TIME = np.arange(151) / 25.0
_DRAWS = 10
_PEAKS = ("top.displacement.peak+", "top.displacement.peak-")


def gain_finding():
    """A marker that reads 3 % too much."""
    return Finding("sensor-gain", ("block-2-face",), "gain", np.array([0.03]), np.array([[1e-6]]), 2e-4, OPEN)


class FakeDiagnosis:
    """Writes a campaign of virtual tests and the results of its diagnosis.

    ``extended`` is whether the sealed tests were opened; ``findings`` are sensor faults; ``gaining`` whether the
    extended model scores better than its rivals.
    """

    def __init__(self, folder, decision, extended=True, findings=(), effort="standard", gaining=True):
        self.folder, self.effort = Path(folder), effort
        self.campaign, self.results = self.folder / "campaign", self.folder / "results"
        self.licence = self.folder / "hidden-effects.json"
        self.structure = load_structure(STRUCTURE)
        self.tests = {name: 0.5 + 0.5 * place for place, name in enumerate(OPEN + SEALED)}
        self._write_campaign()
        readings = xr.concat(
            [self.reading(strength, shift=0.35) for name, strength in self.tests.items() if name in OPEN], dim="test"
        ).assign_coords(test=list(OPEN))  # fmt: skip
        write_dataset(self.results / "measured.nc", readings)
        ensembles = {
            name: [self.members(self.tests[name], 1.0, model)[list(HISTORIES)] for model in MODELS] for name in OPEN
        }  # fmt: skip
        found = misfit(readings, ensembles)
        write_dataset(self.results / "misfit.nc", found)
        write_json(self.results / "parity.json", parity(self.structure, findings))
        self.decision = made_up_decision(decision, self.structure)
        write_json(self.results / "decision.json", self.decision)
        freeze(self.results / "frozen.json", self.results / "decision.json", OPEN)
        best = self.decision["candidates"][0]
        write_dataset(self.results / "evidence.nc", evidence(best, readings))
        gained = bool(self.decision["causes"]) and extended
        of_verdict, caveats = None, [] if extended else ["no sealed test: no gain was measured"]
        gain = consequences = xr.Dataset()
        if gained:
            gain = gain_on(sealed_tests(0.9 if gaining else 0.0))
            of_verdict, caveats = gain_of_verdict(gain)
            consequences = self._consequences()
        write_dataset(self.results / "gain.nc", gain)
        write_dataset(self.results / "consequences.nc", consequences)
        summary = {"gain": of_verdict and of_verdict.model_dump(), "caveats": caveats, "runs": 1260}
        write_json(self.results / "gain.json", summary)
        self.verdict = conclude(self.decision, findings, where(found), 1260, caveats, effort, of_verdict)
        assert isinstance(self.verdict, Verdict)
        write_verdict(self.results / "verdict.json", self.verdict)

    def arguments(self):
        """What the report is made from."""
        return self.campaign, self.results, self.effort, self.licence

    def _write_campaign(self):
        lines = [f"name: made-up\nstructure: {STRUCTURE}\ntests:"]
        markers = [marker.name for marker in self.structure.file.markers]
        displacement = np.zeros((len(_TIME), len(markers), 3))
        displacement[..., 0] = 0.02 * np.sin(3.0 * _TIME)[:, None]
        readings = {"marker_displacement": (("time", "marker", "axis"), displacement, {"units": "m"})}
        coords = {"time": _TIME, "marker": markers, "axis": ["x", "y", "z"]}
        for name in self.tests:
            role = "sealed" if name in SEALED else "fit"
            lines.append(f"  - {{name: {name}, file: {name}.nc, motion: alkion, scale: 1.0, role: {role}}}")
            if role == "fit":
                write_dataset(self.campaign / f"{name}.nc", xr.Dataset(readings, coords, {"synthetic": 1}))
            else:
                write_text(self.campaign / f"{name}.nc", "nobody may open this\n")
        write_text(self.campaign / "campaign.yaml", "\n".join(lines) + "\n")

    def reading(self, strength, shift=0.0, seed=0):
        """What is read off a test: joints and blocks that sway, the more the higher; ``shift`` adds to one side."""
        generator = np.random.default_rng([seed, round(1e6 * strength)])
        joints = [f"{lower}-{upper}" for lower, upper in self.pairs]
        envelope = np.minimum(_TIME / 2.0, 1.0) * np.exp(-np.maximum(_TIME - 4.0, 0.0))
        sway = strength * envelope * (np.sin(8.0 * _TIME) + shift * np.maximum(np.sin(8.0 * _TIME), 0.0))
        shape = (len(_TIME), len(joints))
        share = np.arange(1, len(joints) + 1) / len(joints)
        bodies = list(self.structure.body_names)
        drift = 0.05 * sway[:, None] * np.arange(len(bodies)) / (len(bodies) - 1)
        curves = {
            "slip": 3e-3 * sway[:, None] * share + 1e-4 * generator.normal(size=shape),
            "rotation": 8e-3 * sway[:, None] * share + 1e-4 * generator.normal(size=shape),
            "opening": 2e-3 * np.abs(sway)[:, None] * share + 1e-4 * generator.normal(size=shape),
        }
        phase = np.where(_TIME < 0.5, 0, np.where(_TIME < 4.5, 1, 2)).astype(np.int8)
        return xr.Dataset(
            {
                **{name: (("time", "joint"), values.astype(np.float32)) for name, values in curves.items()},
                "drift": (("time", "body"), drift.astype(np.float32)),
                "acceleration": ("time", (strength * envelope * np.cos(8.0 * _TIME)).astype(np.float32)),
                "phase": ("time", phase),
                "value": ("feature", np.array([drift.max(), drift.min()])),
                "censored": ("feature", np.zeros(2, dtype=bool)),
            },
            {
                "time": _TIME, "joint": joints, "body": bodies, "feature": list(_PEAKS),
                "unit": ("feature", ["m", "m"]), "height": ("body", self.structure.position[:, 2]),
            },
        )  # fmt: skip

    @property
    def pairs(self):
        """Bodies of each joint, the lower first."""
        return list(zip(self.structure.body_names[:-1], self.structure.body_names[1:], strict=True))

    def members(self, strength, factor, model):
        """Readings of a solver's members, which scatter by 15 %."""
        spread = 1.0 + 0.15 * np.random.default_rng(list(model.encode())).normal(size=_DRAWS)
        runs = [self.reading(strength * factor * one, seed=number) for number, one in enumerate(spread)]
        return xr.concat(
            [run.drop_vars(["phase", "acceleration"]) for run in runs], dim="draw", data_vars="all", coords="minimal"
        ).assign_coords(draw=np.arange(_DRAWS))  # fmt: skip

    def _consequences(self):
        parts = []
        factors = {"nominal": 0.9, "recalibrated": 1.0, "extended": 1.3}
        for name in SEALED:
            measured = self.reading(self.tests[name], shift=0.35)
            runs = {
                kind: {model: self.members(self.tests[name], factor, model) for model in MODELS}
                for kind, factor in factors.items()
            }
            history = [
                xr.concat([one["drift"] for one in own.values()], dim="draw").quantile(
                    (0.05, 0.5, 0.95), dim="draw"
                )
                for own in runs.values()
            ]
            part = consequence(measured, {
                kind: {model: one.rename(draw="run") for model, one in own.items()} for kind, own in runs.items()
            })  # fmt: skip
            parts.append(
                part.assign(
                    drift_history=xr.concat(history, dim="kind").assign_coords(kind=list(factors)),
                    drift_measured=measured["drift"],
                )
            )
        return xr.concat(parts, dim="test", join="outer").assign_coords(test=list(SEALED))


def made_up_decision(kind, structure):
    """A decision as `decision_as_json` writes it, with every physical effect among its candidates."""
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
    return {
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
    }


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
        {"candidate": best["key"], "size": best["size"], "model": best["model"]},
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
            kind: {model: share * truth + generator.normal(size=(_DRAWS, len(names))) for model in MODELS}
            for kind, share in centre.items()
        }
        tests.append(SealedTest(name, names, truth, members))
    return tests


def parity(structure, findings):
    """Sensors' checks of one body's markers, the other's too few."""
    markers = {marker.name: {"noise": 1e-4, "misfit": 1e-4} for marker in structure.file.markers}
    markers[structure.file.markers[-1].name] = {"noise": None, "misfit": None}
    return {
        "findings": [finding.as_json() for finding in findings],
        "markers": markers,
        "clock": {name: {"lag": 3e-5, "lag_error": 1e-4} for name in OPEN},
        "channels": {},
        "looked_at": 214,
    }


def licence():
    """A licence whose answers are many enough for an interval, with a goal missed."""
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
                cases.append(Case(name=f"case-{seed}", seed=seed, truth=truth, size=size, answer=answer))
    return Licence(
        date="2026-11-20", commit="0123456789ab", machine="two cores", effort="standard", seeds="fedcba987654",
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


def write_made_up_licence(path):
    """Write `licence` to a file."""
    write_licence(path, licence())


def write_horizon(path):
    """How long each open test can be predicted, by both solvers."""
    horizon = [[3.0, 3.5], [2.0, 2.5], [5.0, 6.0]]
    write_dataset(
        path,
        xr.Dataset({"horizon": (("test", "model"), horizon)}, {"test": list(OPEN), "model": list(MODELS)}),
    )
