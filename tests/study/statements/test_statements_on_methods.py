from dataclasses import replace

import numpy as np

from blockshake.study.statements import inputs, solvers
from blockshake.study.statements.statement import PaperVerdict, against_tests

MET, NOT_MET, UNJUDGED = PaperVerdict.MET, PaperVerdict.NOT_MET, PaperVerdict.UNJUDGED


def test_a_step_is_judged_against_the_limit_of_stability(content):
    assert solvers.stable_step(content).verdict == UNJUDGED
    for limit, verdict in ((1e-4, MET), (1e-5, NOT_MET)):
        for case in content.cases.values():
            samples = case.responses["ls-dem"].samples
            samples["numerics_stable_time_step"] = ("sample", np.full(samples.sizes["sample"], limit))
        assert solvers.stable_step(content).verdict == verdict


def test_steps_at_the_iteration_limit_are_counted(content):
    found = solvers.converged(content)
    assert found.verdict == NOT_MET
    assert "before the tolerance of 1e-08" in found.words
    for case in content.cases.values():
        case.responses["nscd-rigid"].samples["numerics_capped_steps"][:] = 0
    found = solvers.converged(content)
    assert found.verdict == MET
    assert "3.50e-06" in found.words


def test_samples_that_never_ended_tell_nothing_of_convergence(content):
    for case in content.cases.values():
        case.responses["nscd-rigid"].samples["numerics_steps"][:] = np.nan
    found = solvers.converged(content)
    assert found.verdict == UNJUDGED
    assert "no sample has figures of its steps" in found.words


def test_energy_residual_tells_what_is_conserved(content):
    found = solvers.conserves(content)
    assert found.verdict == NOT_MET
    assert "failures: 1 of 16 samples" in found.words
    for case in content.cases.values():
        case.responses["nscd-rigid"].samples["status"][:] = "completed"
    assert solvers.conserves(content).verdict == MET
    content.cases["configuration-1"].responses["nscd-rigid"].samples["energy_residual"][0] = 0.2
    found = solvers.conserves(content)
    assert found.verdict == NOT_MET
    assert "misses 0.200 of the energy" in found.words


def test_cost_of_a_step(content):
    found = solvers.dear_steps(content)
    assert found.verdict == MET
    assert "configuration-1 20 times a step and 1 times a simulated second" in found.words
    content.study["models"]["nscd-rigid"]["time_step"] = 1e-6
    assert solvers.dear_steps(content).verdict == NOT_MET


def test_a_synthetic_test_judges_nothing_of_the_specimens(real):
    assert inputs.along_one_axis(real).verdict == MET
    moved = real.cases["configuration-4"].base["displacement"]
    moved.loc[{"channel": "y"}] = 0.5 * moved.sel(channel="x")
    assert inputs.along_one_axis(real).verdict == NOT_MET
    real.cases["configuration-4"].base.attrs["unread"] = ["y"]
    assert inputs.along_one_axis(real).verdict == UNJUDGED
    cases = [replace(case, synthetic=True) for case in real.cases.values()]
    for holds, side in ((True, "they bear"), (False, "they do not bear")):
        found = against_tests(cases, holds, "So much.")
        assert found.verdict == UNJUDGED
        assert side in found.words
        assert found.words.endswith("So much.")


def test_the_strongest_test_is_that_of_the_campaign(content, tmp_path):
    assert inputs.strongest_tests(content).verdict == MET
    (tmp_path / "virtual.nc").touch()
    (tmp_path / "campaign.yaml").write_text(
        "name: other\nstructure: configuration-1\ntests:\n"
        "  - {name: virtual, file: virtual.nc, motion: basso-tirreno, scale: 2.0, role: fit}\n"
        "  - {name: strong, file: virtual.nc, motion: own/alkion.yaml, scale: -3.0, role: sealed}\n"
    )
    case = content.cases["configuration-1"]
    case.settings["measured"] = {"campaign": str(tmp_path), "test": "virtual"}
    del content.cases["configuration-4"]
    found = inputs.strongest_tests(content)
    assert found.verdict == NOT_MET
    assert "strong (sealed)" in found.words
    assert "of its open tests virtual with 2.47 m/s2" in found.words
