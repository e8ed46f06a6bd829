"""Print and files of ``blockshake modes``, for records of a chain whose modes are known."""

import json

import numpy as np
import pytest
import yaml
from shear_chain import FINE, answer, exact, reading, stiffness, system, white

from blockshake.cli import main
from blockshake.files import write_dataset

NOISE, DURATION, DRIVE = 1e-6, 30.0, 4.0  # m, s, Hz
SIGMAS = 3.5 / 1.96  # half-widths of an interval of 95 %: one figure of six would miss in 300 seeds


@pytest.fixture(scope="module")
def chain():
    K = stiffness([6000.0, 6000.0])
    return system(np.ones(2), K, 0.5 * np.eye(2) + 2e-4 * K)


@pytest.fixture(scope="module")
def campaign(tmp_path_factory, make_mapping, chain):
    folder = tmp_path_factory.mktemp("campaign")
    bodies = [
        {"name": f"mass-{i}", "shape": "block", "position": [0.0, 0.0, 0.8 + 1.6 * i]} for i in range(2)
    ]
    places = {"slab-face": "slab", "mass-0": "mass-0", "mass-1": "mass-1"}
    markers = [{"name": name, "body": body, "position": [0.4, 0.0, 0.0]} for name, body in places.items()]
    (folder / "structure.yaml").write_text(yaml.safe_dump(make_mapping(bodies, markers=markers)))
    acceleration, displacement = white(3, DURATION, 1.0, lowest=2.0)
    noise = reading(displacement, answer(*chain, acceleration), NOISE, 3)
    omega, time = 2.0 * np.pi * DRIVE, np.arange(round(DURATION * FINE)) / FINE
    base = 2e-3 * np.sin(omega * time)
    sine = reading(base, answer(*chain, -(omega**2) * base), NOISE, 4)
    tests = []
    for name, test, role in (("noise", noise, "fit"), ("sine", sine, "fit"), ("kept", noise, "sealed")):
        write_dataset(folder / f"{name}.nc", test)
        tests.append(
            {"name": name, "file": f"{name}.nc", "motion": f"{name}.csv", "scale": 1.0, "role": role}
        )
    content = {
        "name": "chain", "structure": "structure.yaml", "tests": tests,
        "sensors": {"marker_noise": NOISE, "accelerometer_noise": 0.02},
    }  # fmt: skip
    (folder / "campaign.yaml").write_text(yaml.safe_dump(content))
    return folder


@pytest.fixture(scope="module")
def written(campaign):
    output = campaign / "modes.json"
    assert main(["modes", str(campaign), "--output", str(output)]) == 0
    return {test["test"]: test for test in json.loads(output.read_text())["tests"]}


def _within(quantity, true):
    lower, upper = quantity["interval"]
    assert abs(quantity["value"] - true) < SIGMAS * 0.5 * (upper - lower)


def test_the_modes_of_white_noise_are_the_eigenvalues_of_the_chain(written, chain):
    assert written["noise"]["excitation"] == "broad band"
    frequency, damping, _ = exact(chain[0])
    assert len(written["noise"]["modes"]) == len(frequency)
    for mode, true_frequency, true_damping in zip(written["noise"]["modes"], frequency, damping, strict=True):
        _within(mode["frequency"], true_frequency)
        _within(mode["damping_ratio"], true_damping)
        assert (mode["frequency"]["unit"], mode["damping_ratio"]["unit"]) == ("Hz", "1")


def test_the_answer_to_a_sine_is_the_frequency_response_of_the_chain(written, chain):
    A, B = chain
    omega = 2.0 * np.pi * DRIVE
    # of a base acceleration -omega^2 sin: absolute over the base's displacement
    relative = np.linalg.solve(1j * omega * np.eye(4) - A, B)[:2, 0] * -(omega**2)
    assert written["sine"]["excitation"] == "sine"
    assert written["sine"]["frequency"]["value"] == pytest.approx(DRIVE, rel=1e-4)
    assert written["sine"]["marker"] == "mass-1"
    _within(written["sine"]["answer"], abs(1.0 + relative[1]))
    _within(written["sine"]["phase"], np.angle(1.0 + relative[1]))


def test_a_sealed_test_is_not_read(written):
    assert "kept" not in written


def test_a_test_file_takes_its_structure_from_the_option(campaign, capsys):
    file, structure = str(campaign / "noise.nc"), str(campaign / "structure.yaml")
    assert main(["modes", file, "--structure", structure]) == 0
    header, *rows = capsys.readouterr().out.splitlines()
    assert "frequency [Hz]" in header
    assert all(row.startswith("noise  broad band") for row in rows)
    assert main(["modes", file]) == 2
    assert "--structure: expected the structure of" in capsys.readouterr().err
    assert main(["modes", str(campaign / "none.nc")]) == 2
