from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from blockshake.files import shipped
from blockshake.geometry.structure import load_structure
from blockshake.report.study.statements import ls_dem, nscd, specimens
from blockshake.report.study.statements.statement import Verdict, against_tests
from blockshake.simulation.models import MODELS

MET, NOT_MET, UNJUDGED = Verdict.MET, Verdict.NOT_MET, Verdict.UNJUDGED


@pytest.mark.parametrize(
    ("judge", "model", "values", "verdict", "said"),
    [
        (ls_dem.level_set, "ls-dem", {}, NOT_MET, "by its formula"),
        (ls_dem.level_set, "ls-dem", {"ls_dem.level_set": "grid"}, MET, "0.02 m"),
        (
            ls_dem.level_set, "ls-dem", {"ls_dem.level_set": "grid", "ls_dem.grid_spacing": 0.01}, NOT_MET,
            "0.01 m",
        ),
        (ls_dem.node_spacing, "ls-dem", {}, MET, "0.2 m"),
        (ls_dem.node_spacing, "ls-dem", {"ls_dem.node_spacing": 0.4}, NOT_MET, "0.4 m"),
        (ls_dem.normal_law, "ls-dem", {}, NOT_MET, "0 times where it outweighs"),
        (ls_dem.normal_law, "ls-dem", {"ls_dem.pulling": True}, MET, "1 times where it outweighs"),
        (ls_dem.damping, "ls-dem", {}, NOT_MET, "0.215 for C_res 0.5"),
        (ls_dem.damping, "ls-dem", {"ls_dem.damping": "node"}, NOT_MET, "each node, with the reduced mass"),
        (ls_dem.shear_law, "ls-dem", {}, MET, "1 times beyond it"),
        (ls_dem.shear_law, "ls-dem", {"ls_dem.shear_damping_ratio": 0.3}, NOT_MET, "0.3"),
        (nscd.shrunk, "nscd-rigid", {"nscd.shrink": 0.02}, UNJUDGED, "0.02"),
    ],
)  # fmt: skip
def test_settings_of_the_study_decide(content, parameters, judge, model, values, verdict, said):
    parameters(model, **values)
    found = judge(content)
    assert found.verdict == verdict
    assert said in found.words


@pytest.mark.parametrize("ratio", [0.1, 0.2155, 0.6])
def test_rebound_without_pull_is_that_of_the_equation_of_motion(ratio):
    done = solve_ivp(
        lambda time, state: [state[1], -state[0] - 2.0 * ratio * state[1]],
        (0.0, 10.0), [0.0, -1.0], events=lambda time, state: state[0] + 2.0 * ratio * state[1], rtol=1e-10, atol=1e-12,
    )  # fmt: skip
    # the force is that of a spring and a dashpot; the first zero after the start ends the contact
    assert ls_dem.rebound_without_pull(ratio) == pytest.approx(done.y_events[0][0][1], rel=1e-6)


def test_a_step_is_judged_against_the_limit_of_stability(content):
    assert ls_dem.stable_step(content).verdict == UNJUDGED
    for limit, verdict in ((1e-4, MET), (1e-5, NOT_MET)):
        for case in content.cases.values():
            samples = case.responses["ls-dem"].samples
            samples["numerics_stable_time_step"] = ("sample", np.full(samples.sizes["sample"], limit))
        assert ls_dem.stable_step(content).verdict == verdict


def test_a_time_step_is_that_of_the_study(content):
    assert ls_dem.time_step(content, "ls-dem", 1e-5).verdict == NOT_MET
    found = ls_dem.time_step(content, "nscd-rigid", 1e-3)
    assert found.verdict == MET
    assert "0.001 s" in found.words


def test_steps_at_the_iteration_limit_are_counted(content):
    found = nscd.converged(content)
    assert found.verdict == NOT_MET
    assert "before the tolerance of 1e-08" in found.words
    for case in content.cases.values():
        case.responses["nscd-rigid"].samples["numerics_capped_steps"][:] = 0
    found = nscd.converged(content)
    assert found.verdict == MET
    assert "3.50e-06" in found.words


def test_samples_that_never_ended_tell_nothing_of_convergence(content):
    for case in content.cases.values():
        case.responses["nscd-rigid"].samples["numerics_steps"][:] = np.nan
    found = nscd.converged(content)
    assert found.verdict == UNJUDGED
    assert "no sample has figures of its steps" in found.words


def test_energy_residual_tells_what_is_conserved(content):
    found = nscd.conserves(content)
    assert found.verdict == NOT_MET
    assert "failures: 1 of 16 samples" in found.words
    for case in content.cases.values():
        case.responses["nscd-rigid"].samples["status"][:] = "completed"
    assert nscd.conserves(content).verdict == MET
    content.cases["configuration-1"].responses["nscd-rigid"].samples["energy_residual"][0] = 0.2
    found = nscd.conserves(content)
    assert found.verdict == NOT_MET
    assert "misses 0.200 of the energy" in found.words


def test_mesh_is_judged_where_blocks_deform(content):
    assert nscd.mesh_size(content).verdict == UNJUDGED
    for size, verdict in ((0.2, MET), (0.4, NOT_MET)):
        content.study["models"]["nscd-elastic"] = {"parameters": {"nscd_deformable.mesh_size": size}}
        assert nscd.mesh_size(content).verdict == verdict


def test_restitution_of_rigid_contacts(content):
    assert nscd.no_restitution(content).verdict == MET
    case = content.cases["configuration-1"]
    content.cases["configuration-1"] = replace(
        case, structure=case.structure.with_parameters({"nscd_restitution": 0.3})
    )
    assert nscd.no_restitution(content).verdict == NOT_MET


def test_steepness_is_that_of_the_laws(content, monkeypatch):
    assert nscd.steepness(content).verdict == UNJUDGED
    for case in content.cases.values():
        samples = case.responses["nscd-rigid"].samples
        samples["numerics_max_penetration"] = ("sample", np.full(samples.sizes["sample"], 1e-3))
    found = nscd.steepness(content)
    assert found.verdict == MET
    assert "2 of LS-DEM, 0 of rigid NSCD" in found.words
    # configuration 1: three blocks of 7364 kg on a flat of 0.76 m x 2.36 m with 18 GN/m3
    assert f"{1e6 * 3 * 7364 * 9.81 / (1.8e10 * 0.76 * 2.36):.2f} to" in found.words
    monkeypatch.setitem(MODELS, "nscd-rigid", replace(MODELS["nscd-rigid"], calibrated=("normal_stiffness",)))
    assert nscd.steepness(content).verdict == NOT_MET


def test_the_models_say_what_they_have_no_use_for(content, monkeypatch):
    assert nscd.no_modulus(content).verdict == MET
    monkeypatch.setitem(MODELS, "nscd-rigid", replace(MODELS["nscd-rigid"], without_effect=()))
    assert nscd.no_modulus(content).verdict == NOT_MET


def test_cost_of_a_step(content):
    found = nscd.dear_steps(content)
    assert found.verdict == MET
    assert "configuration-1 20 times a step and 1 times a simulated second" in found.words
    content.study["models"]["nscd-rigid"]["time_step"] = 1e-6
    assert nscd.dear_steps(content).verdict == NOT_MET


@pytest.mark.parametrize(
    "judge", [ls_dem.level_set, ls_dem.stable_step, nscd.steepness, nscd.no_modulus, nscd.dear_steps]
)
def test_a_model_that_is_not_there_is_named(content, judge):
    del content.study["models"]["ls-dem"]
    found = judge(content)
    assert found.verdict == UNJUDGED
    assert "no LS-DEM" in found.words


def test_blocks_are_alike_only_with_the_chamfer_of_the_paper(content, tmp_path):
    assert specimens.alike_blocks(content).verdict == MET
    text = shipped("structures", "configuration-1").read_text()
    (tmp_path / "other.yaml").write_text(text.replace("chamfer: 0.02", "chamfer: 0.03"))
    case = content.cases["configuration-1"]
    content.cases["configuration-1"] = replace(case, structure=load_structure(tmp_path / "other.yaml"))
    found = specimens.alike_blocks(content)
    assert found.verdict == NOT_MET
    assert "0.02, 0.03 m" in found.words


def test_heights_are_those_of_the_structure_files(content, monkeypatch):
    assert specimens.heights(content).verdict == MET
    found = specimens.tallest(content)
    assert found.verdict == NOT_MET
    assert "7.40 m, 0.20 m off" in found.words
    monkeypatch.setattr(specimens, "TALLEST", 7.4)
    assert specimens.tallest(content).verdict == MET
    monkeypatch.setitem(specimens.HEIGHTS, "configuration-2", 6.6)
    assert specimens.heights(content).verdict == NOT_MET


def test_a_synthetic_test_judges_nothing_of_the_specimens(real):
    assert specimens.along_one_axis(real).verdict == MET
    moved = real.cases["configuration-4"].base["displacement"]
    moved.loc[{"channel": "y"}] = 0.5 * moved.sel(channel="x")
    assert specimens.along_one_axis(real).verdict == NOT_MET
    real.cases["configuration-4"].base.attrs["unread"] = ["y"]
    assert specimens.along_one_axis(real).verdict == UNJUDGED
    cases = [replace(case, synthetic=True) for case in real.cases.values()]
    for holds, side in ((True, "they bear"), (False, "they do not bear")):
        found = against_tests(cases, holds, "So much.")
        assert found.verdict == UNJUDGED
        assert side in found.words
        assert found.words.endswith("So much.")


def test_motions_are_judged_by_their_peaks(content):
    found = specimens.peaks(content)
    assert found.verdict == UNJUDGED
    assert "Synthetic, and scaled to those peaks: " in found.words
    assert specimens.records(content).verdict == UNJUDGED
    for name in specimens.PEAKS:
        content.motions[name].attrs["synthetic"] = 0
    assert specimens.peaks(content).verdict == NOT_MET
    for name, peak in specimens.PEAKS.items():
        content.motions[name].attrs["peak_acceleration"] = peak
    assert specimens.peaks(content).verdict == MET
    del content.motions["alkion"]
    assert specimens.peaks(content).verdict == UNJUDGED


def test_ladder_and_levels_are_those_of_the_paper(content, tmp_path):
    found = specimens.ladder(content)
    assert found.verdict == UNJUDGED
    assert "do not bear the statement out" in found.words
    assert "configuration-4 at 2, NSCD rigid: 20.0 %" in found.words  # 1 of the 5 that count
    assert "at a drift of 0.4 m" in found.words
    assert "Tests of configuration-1 by basso-tirreno: 2." in found.words
    (tmp_path / "virtual.nc").touch()
    tests = "".join(
        f"  - {{name: t{level:03.0f}, file: virtual.nc, motion: alkion, scale: {level / 100}, role: fit}}\n"
        for level in (50, 75, 100)
    )
    (tmp_path / "campaign.yaml").write_text(f"name: other\nstructure: configuration-1\ntests:\n{tests}")
    for case in content.cases.values():
        case.settings["measured"] = {"campaign": str(tmp_path), "test": "t050"}
    assert "they bear the statement out" in specimens.ladder(content).words
    for name, case in content.cases.items():
        content.cases[name] = replace(case, synthetic=False)
    assert specimens.ladder(content).verdict == MET
    content.study["ladder"]["largest_drift"] = None
    assert "at a drift of half a block's smaller width" in specimens.ladder(content).words
    for increment, verdict in ((0.2, MET), (0.5, NOT_MET)):
        content.study["ladder"]["increment"] = increment
        assert specimens.ladder(content).verdict == verdict


def test_walls_blocks_and_beams_are_those_of_the_paper(content, monkeypatch):
    found = specimens.make_up(content)
    assert found.verdict == MET
    assert "configuration-4 2, 9 and 4" in found.words
    monkeypatch.setitem(specimens.MAKE_UP, "configuration-3", (2, 8, 0))
    assert specimens.make_up(content).verdict == NOT_MET


def test_four_points_of_an_overlap_are_kept(content, monkeypatch):
    found = nscd.four_points(content)
    assert found.verdict == MET
    assert "with 8 corners the rule of choice keeps 4" in found.words
    monkeypatch.setattr(nscd, "choose_four_into", lambda *given: 5)
    assert nscd.four_points(content).verdict == NOT_MET


def test_a_shear_spring_that_takes_up_the_normal_motion_breaks_the_equation(content, monkeypatch):
    monkeypatch.setattr(ls_dem, "trial_stretch", lambda *given: (given[3], given[4], given[5], 0.0, 0.0))
    found = ls_dem.shear_law(content)
    assert found.verdict == NOT_MET


def test_low_tests_and_the_strongest_are_those_of_the_campaign(content, tmp_path):
    found = specimens.low_tests(content)
    assert found.verdict == UNJUDGED
    assert "do not bear the statement out" in found.words
    assert specimens.strongest_tests(content).verdict == MET
    (tmp_path / "virtual.nc").touch()
    (tmp_path / "campaign.yaml").write_text(
        "name: other\nstructure: configuration-1\ntests:\n"
        "  - {name: virtual, file: virtual.nc, motion: basso-tirreno, scale: 2.0, role: fit}\n"
        "  - {name: low, file: virtual.nc, motion: sine, scale: 1.0, role: fit}\n"
        "  - {name: strong, file: virtual.nc, motion: own/alkion.yaml, scale: -3.0, role: sealed}\n"
    )
    case = content.cases["configuration-1"]
    case.settings["measured"] = {"campaign": str(tmp_path), "test": "virtual"}
    del content.cases["configuration-4"]
    found = specimens.low_tests(content)
    assert found.verdict == UNJUDGED
    assert "configuration-1 1. No study reads" in found.words
    found = specimens.strongest_tests(content)
    assert found.verdict == NOT_MET
    assert "strong (sealed)" in found.words
    assert "of its open tests virtual with 2.47 m/s2" in found.words
    assert "by own/alkion.yaml: 3." in specimens.ladder(content).words


def test_sensors_are_counted(content, monkeypatch):
    found = specimens.instruments(content)
    assert found.verdict == NOT_MET
    assert "displacement transducers 0 of 4, markers" in found.words
    monkeypatch.setattr(specimens, "INSTRUMENTS", {"accelerometers": 4, "markers": 4})
    assert specimens.instruments(content).verdict == MET
    assert specimens.rates(content).verdict == MET
    content.study["output_rate"] = 100.0
    assert specimens.rates(content).verdict == NOT_MET


def test_input_is_measured_or_commanded(content):
    found = specimens.measured_input(content)
    assert found.verdict == MET
    assert "drawn anew for each sample" in found.words
    content.cases["configuration-4"].settings["input"] = "commanded"
    found = specimens.measured_input(content)
    assert found.verdict == NOT_MET
    assert "configuration-4 by the commanded motion" in found.words


def test_stoppers_are_counted_and_not_judged(content):
    assert specimens.stoppers(content) == (UNJUDGED, specimens.stoppers(content).words)
    assert "0 stoppers" in specimens.stoppers(content).words
