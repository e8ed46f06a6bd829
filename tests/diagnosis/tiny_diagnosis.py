"""All steps of a diagnosis of the tiny campaign, in their order."""

from contextlib import contextmanager
from types import SimpleNamespace

import pytest
from tiny_campaign import prescribed_run

from blockshake.diagnosis import steps
from blockshake.diagnosis.inference.calibration import write_cases
from blockshake.diagnosis.inference.decision import write_result
from blockshake.diagnosis.libraries import candidates, designed_test, efforts, plan
from blockshake.diagnosis.misfit import predictability
from blockshake.diagnosis.verdict.frozen import freeze
from blockshake.files import write_dataset, write_json

TINY = efforts.Effort(runs=1000, tests=2, nominal_draws=10, own_draws=2, further_draws=2, members=2, twins=2)
SOLVERS = ("ls-dem", "nscd-rigid")


def silent(line):
    """No progress."""


@contextmanager
def two_effects_and_a_formula():
    """The tiny effort, two candidates, and a solver that is a formula."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setitem(efforts.EFFORTS, "tiny", TINY)
        patch.setattr(designed_test, "simulate", prescribed_run)
        patch.setattr(predictability, "simulate", prescribed_run)
        everywhere = candidates.candidates
        patch.setattr(
            plan,
            "candidates",
            lambda built: [
                one for one in everywhere(built) if one.effect in ("table-pitch", "vertical-motion")
            ],
        )
        yield


def diagnose(folder, campaign):
    effects, config = plan.considered(), {"diagnosed": [campaign], "diagnosis_effort": "tiny"}
    made_by = folder / "store", "source", silent
    shared = "shared"
    path = {
        name: str(folder / f"{name}.json")
        for name in ("parity", "decision", "frozen", "size", "frozen-size", "cases")
    } | {name: str(folder / f"{name}.nc") for name in ("readings", "forces", "misfit")}
    measured = steps.read_measured(campaign, "tiny", [])
    write_dataset(path["readings"], measured.readings)
    write_dataset(path["forces"], measured.forces)
    write_json(path["parity"], measured.parity.as_json())
    planned = plan.plan_diagnosis(campaign, "tiny")
    names = [planned.library(test, shared) for test in planned.tests]
    libraries, histories, further = [], [], []
    for name in names:
        for solver in SOLVERS:
            features, moved = steps.simulate_library(name, solver, config, shared, *made_by)
            for kind, files, dataset in (("", libraries, features), ("-histories", histories, moved)):
                files.append(str(folder / f"{name}-{solver}{kind}.nc"))
                write_dataset(files[-1], dataset)
    write_cases(path["cases"], steps.calibrate_decision(libraries, effects, *made_by))
    files = SimpleNamespace(
        readings=path["readings"], forces=path["forces"], libraries=libraries, histories=histories,
        calibration=path["cases"],
        parity=path["parity"], decision=path["decision"], frozen=path["frozen"], misfit=path["misfit"],
    )  # fmt: skip
    decided = steps.decide(campaign, effects, files)
    write_result(files.decision, decided.decision)
    write_dataset(files.misfit, decided.misfit)
    freeze(files.frozen, files.decision, decided.tests)
    for name in names:
        for solver in SOLVERS:
            features = steps.simulate_cause(
                name, solver, decided.decision.first_key, TINY.further_draws, config, shared, *made_by
            )
            further.append(str(folder / f"{name}-{solver}-further.nc"))
            write_dataset(further[-1], features)
    files.further = further
    sized = steps.size_cause(files, effects)
    write_result(path["size"], sized.size)
    freeze(path["frozen-size"], path["size"], sized.tests)
    extended = [str(folder / f"extended-{solver}.nc") for solver in SOLVERS]
    files.posterior = path["size"], path["frozen-size"]
    for solver, file in zip(SOLVERS, extended, strict=True):
        write_dataset(file, steps.extend_model(campaign, "tiny", solver, files, effects, *made_by))
    files.extended = extended
    gained = steps.measure_gain(campaign, files)
    files.gain = str(folder / "gain.json"), str(folder / "gain.nc")
    write_result(files.gain[0], gained.summary)
    write_dataset(files.gain[1], gained.scores)
    return SimpleNamespace(
        campaign=campaign, files=files, measured=measured, decided=decided, sized=sized, gained=gained,
        verdict=steps.conclude(campaign, "tiny", files),
        horizon=steps.predict_twins(names[0], histories[:2], config, shared, silent),
    )  # fmt: skip
