"""Motion files of every format with mutations are refused in one line, or give the values that they state."""

import csv
import sys
from pathlib import Path

import numpy as np
import pytest
import yaml
from contract import run_command, scratch
from hypothesis import given
from hypothesis import strategies as st
from mutations import FEW, MANY, mutated_bytes, mutated_mappings, mutated_texts, mutations
from stated_values import stated_columns

from blockshake.cli import main

sys.path.insert(0, str(Path(__file__).parents[1] / "dynamics" / "records"))
from record_files import KNET_SCALE, at2, cosmos, csmip, dyna, knet, series, smc

ROWS = 100
_VALUES = np.round(np.sin(np.arange(ROWS) / 5.0) * np.hanning(ROWS), 5)
CSV = "time_s,acceleration_x,acceleration_z,pitch_y\n" + "".join(
    f"{row / 100},{value},{value / 2},0.001\n" for row, value in enumerate(_VALUES)
)
SYNTHETIC = {
    "name": "made", "synthetic": True, "description": "noise", "seed": 1, "time_step": 0.01, "duration": 4.0,
    "peak_acceleration": 2.0, "high_pass_frequency": 0.5,
    "source": {"moment_magnitude": 6.0, "epicentral_distance": 2e4, "stress_drop": 5e6, "shear_wave_velocity": 3e3,
               "kappa": 0.03},
    "envelope": {"significant_duration": 2.0, "peak": 0.3, "level": 0.05},
    "target_spectrum": [{"period": 0.1, "acceleration": 3.0}, {"period": 0.3, "acceleration": 5.0},
                        {"period": 2.0, "acceleration": 0.5}],
}  # fmt: skip
TABLE = "Zeit;Weg\n" + "".join(
    f"{row / 100:.2f};{value:.5f}\n".replace(".", ",") for row, value in enumerate(_VALUES)
)
_CM = series(300)[200:]
GOOD = {
    "m.csv": CSV, "m.asc": dyna(_CM), "m.at2": at2(_CM / 1000.0), "m.v2c": cosmos(_CM), "m.v2": csmip(_CM),
    "m.ew": knet(np.round(_CM / KNET_SCALE).astype(int) - 18000), "m.smc": smc(_CM), "t.txt": TABLE,
}  # fmt: skip
OPTIONS = {"t.txt": ["--time", "Zeit", "--column", "x=Weg", "--unit", "mm", "--decimal", ","]}
FAST = 25  # mutations of a kind in `make test`


def converted(folder, name):
    """The command that reads a file as it is."""
    return [
        "convert-motion",
        f"{folder}{name}",
        *OPTIONS.get(name, ()),
        "--baseline",
        "none",
        "--output",
        f"{folder}o.csv",
    ]


def holds(folder, name, content):
    """The file that the command wrote has the values that the content states."""
    with open(f"{folder}o.csv", newline="") as file:
        rows = list(csv.reader(file))
    read = dict(zip(rows[0], np.array(rows[1:], dtype=float).T, strict=True))
    time, stated = stated_columns(name, content)
    np.testing.assert_allclose(read.pop("time_s"), time, rtol=1e-9, atol=1e-12)
    for column, values in stated.items():
        # the last row is rebuilt from a cubic; columns at rest are left out
        written = read.pop(column, np.zeros(len(values)))
        np.testing.assert_allclose(written, values, rtol=1e-9, atol=1e-9 * np.abs(values).max())
    assert not any(values.any() for values in read.values())


def damaged(name):
    """Mutations of the text of a good motion, and of its bytes."""
    return st.one_of(
        mutated_texts(GOOD[name]).map(lambda changed: changed.encode("utf-8", "surrogatepass")),
        mutated_bytes(GOOD[name].encode()),
    )


@pytest.mark.parametrize("name", GOOD)
def test_good_motions_give_what_they_state(name, tmp_path):
    (tmp_path / name).write_text(GOOD[name])
    assert main(converted(f"{tmp_path}/", name)) == 0
    holds(f"{tmp_path}/", name, GOOD[name].encode())


@pytest.mark.parametrize("name", GOOD)
@mutations(FAST)
@given(st.data())
def test_mutated_motions_give_what_they_state_or_are_refused(name, data):
    content = data.draw(damaged(name))
    with scratch() as folder:
        Path(folder, name).write_bytes(content)
        if main(converted(f"{folder}/", name)) == 0:
            holds(f"{folder}/", name, content)


def under_watch(name, content):
    """The same under the contract of all readers: one line, soon, in little memory, in one folder."""
    with scratch() as folder:
        Path(folder, name).write_bytes(content)
        if run_command(converted("", name), folder)[0] == 0:
            holds(f"{folder}/", name, content)


# slow: a limit of CPU time, which kernels that are compiled first would break
@pytest.mark.slow
@pytest.mark.parametrize("name", GOOD)
@mutations(MANY)
@given(st.data())
def test_many_mutated_motions(name, data):
    under_watch(name, data.draw(damaged(name)))


def checked_synthetic(content):
    """Exit code of the check of a synthetic motion's file."""
    with scratch() as folder:
        Path(folder, "m.yaml").write_bytes(content)
        return run_command(["check", "m.yaml"], folder)[0]


DAMAGED_SYNTHETIC = st.one_of(
    mutated_mappings(SYNTHETIC).map(lambda mapping: yaml.safe_dump(mapping, allow_unicode=True).encode()),
    mutated_texts(yaml.safe_dump(SYNTHETIC)).map(lambda changed: changed.encode("utf-8", "surrogatepass")),
)


@pytest.mark.slow
def test_a_good_synthetic_motion_is_read():
    assert checked_synthetic(yaml.safe_dump(SYNTHETIC).encode()) == 0


@pytest.mark.slow
@mutations(FEW)
@given(DAMAGED_SYNTHETIC)
def test_mutated_synthetic_motions(content):
    checked_synthetic(content)


@pytest.mark.slow
@mutations(MANY)
@given(DAMAGED_SYNTHETIC)
def test_many_mutated_synthetic_motions(content):
    checked_synthetic(content)
