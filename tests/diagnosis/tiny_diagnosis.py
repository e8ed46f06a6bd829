"""The simulating steps of a diagnosis of the tiny campaign, in their order, after a decision made by hand."""

from contextlib import contextmanager
from types import SimpleNamespace

import pytest
from tiny_campaign import prescribed_run

from blockshake.diagnosis import steps
from blockshake.diagnosis.answer.decision import freeze
from blockshake.diagnosis.nominal import plan, simulated_test
from blockshake.files import write_dataset, write_json, write_text
from blockshake.geometry.structure import load_structure
from blockshake.measurement.campaigns.campaign import load_test
from blockshake.parity.parity import check_parity
from blockshake.store import Store

TINY = plan.Effort(tests=2, draws=10, members=6, twins=2, outcomes=2, clean=0)
SOLVERS = ("ls-dem", "nscd-rigid")


@contextmanager
def a_formula():
    """The tiny effort, and a solver that is a formula."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setitem(plan.EFFORTS, "tiny", TINY)
        patch.setattr(simulated_test, "simulate", prescribed_run)
        yield


def simulate_open_tests(folder, campaign):
    """Parity and nominal ensembles of a campaign, as files."""
    planned = plan.plan_diagnosis(campaign, "tiny")
    files = SimpleNamespace(parity=str(folder / "parity.json"), ensembles=[])
    tests = {name: load_test(planned.campaign, name) for name in planned.open}
    parity = check_parity(tests, load_structure(planned.campaign.structure), planned.campaign.sensors)
    write_json(files.parity, parity.as_json())
    for number in range(len(planned.tests)):
        for solver in SOLVERS:
            files.ensembles.append(str(folder / f"{number}-{solver}.nc"))
            runs = steps.simulate_nominal(campaign, "tiny", number, solver, Store(folder / "store", "source"))
            write_dataset(files.ensembles[-1], runs)
    return files


def gain_of(folder, campaign, files, decision):
    """Extended runs and gain of a `Decision`, as from the steps."""
    decided = folder / "decision.json"
    write_text(decided, decision.model_dump_json())
    freeze(folder / "frozen.json", decided, decision.tests)
    of_decision = {"decision": str(decided), "frozen": str(folder / "frozen.json"), "parity": files.parity}
    extended = []
    for number, solver in enumerate(SOLVERS):
        own = SimpleNamespace(**of_decision, ensembles=files.ensembles[number :: len(SOLVERS)])
        runs = steps.extend_model(campaign, "tiny", solver, own, Store(folder / "store", "source"))
        extended.append(str(folder / f"extended-{solver}.nc"))
        write_dataset(extended[-1], runs)
    every = SimpleNamespace(**of_decision, ensembles=files.ensembles, extended=extended)
    return steps.measure_gain(campaign, "tiny", every)
