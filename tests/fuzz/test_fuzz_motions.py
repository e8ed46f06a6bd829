"""Motion files of every format with mutations are read or refused in one line."""

import numpy as np
import pytest
import yaml
from contract import run_command, scratch
from hypothesis import given
from hypothesis import strategies as st
from mutations import FEW, MANY, mutated_bytes, mutated_mappings, mutated_texts, mutations

pytestmark = pytest.mark.slow  # a limit of CPU time, which kernels that are compiled first would break

ROWS = 60
_VALUES = np.round(np.sin(np.arange(ROWS) / 5.0) * np.hanning(ROWS), 5)
CSV = "time_s,acceleration_x,acceleration_z,pitch_y\n" + "".join(
    f"{row / 100},{value},{value / 2},0.001\n" for row, value in enumerate(_VALUES)
)
DYNA = (
    "EVENT_NAME: SYNTHETIC\nEVENT_DATE_YYYYMMDD: 20200101\nMAGNITUDE_W: 6.0\nNETWORK: XX\nSTATION_CODE: NONE\n"
    f"SAMPLING_INTERVAL_S: 0.010000\nNDATA: {ROWS}\nUNITS: cm/s^2\nHEADER_FORMAT: DYNA 1.2\n"
    "DATA_TYPE: ACCELERATION\n" + "".join(f"{value:.6f}\n" for value in _VALUES)
)
AT2 = (
    "PEER NGA STRONG MOTION DATABASE RECORD\nSynthetic, 1/1/2020, Nowhere, 0\nACCELERATION TIME SERIES IN UNITS OF G\n"
    f"NPTS=  {ROWS}, DT=   .0100 SEC\n"
    + "\n".join(" ".join(f"{value:.7E}" for value in _VALUES[row : row + 5]) for row in range(0, ROWS, 5))
)
_HEADER = [0.0] * 40
_HEADER[33] = 10.0
COSMOS = (
    "Corrected acceleration (Format v01.20 with 1 text lines)\nSynthetic\n"
    "    5 Integer-header values follow on     1 lines, Format= (10I8)\n"
    + "".join(f"{value:8d}" for value in range(5))
    + "\n   40 Real-header values follow on      5 lines, Format= (8F10.3)\n"
    + "\n".join("".join(f"{value:10.3f}" for value in _HEADER[row : row + 8]) for row in range(0, 40, 8))
    + f"\n   {ROWS} acceleration pts, approx    1 secs, units=cm/sec2 (04), Format=(8F10.5)\n"
    + "\n".join("".join(f"{value:10.5f}" for value in _VALUES[row : row + 8]) for row in range(0, ROWS, 8))
    + "\nEnd-of-data for chan  1\n"
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
GOOD = {"m.csv": CSV, "m.asc": DYNA, "m.at2": AT2, "m.v2": COSMOS, "m.yaml": yaml.safe_dump(SYNTHETIC)}


def checked(name, content):
    """Exit code of the check of a motion file."""
    with scratch() as folder:
        with open(f"{folder}/{name}", "wb") as file:
            file.write(content)
        return run_command(["check", name], folder)[0]


def converted(content):
    """Exit code of the conversion of a table."""
    with scratch() as folder:
        with open(f"{folder}/t.txt", "wb") as file:
            file.write(content)
        return run_command(
            ["convert-motion", "t.txt", "--time", "Zeit", "--column", "x=Weg", "--unit", "mm", "--decimal", ",",
             "--output", "o.csv"], folder,
        )[0]  # fmt: skip


def damaged(name):
    """Mutations of the text of a good motion, and of its bytes."""
    text = GOOD[name]
    if name == "m.yaml":
        return st.one_of(
            mutated_mappings(SYNTHETIC).map(
                lambda mapping: yaml.safe_dump(mapping, allow_unicode=True).encode()
            ),
            mutated_texts(text).map(lambda changed: changed.encode("utf-8", "surrogatepass")),
        )
    return st.one_of(
        mutated_texts(text).map(lambda changed: changed.encode("utf-8", "surrogatepass")),
        mutated_bytes(text.encode()),
    )


@pytest.mark.parametrize("name", GOOD)
def test_good_motions_are_read(name):
    assert checked(name, GOOD[name].encode()) == 0


def test_good_table_is_read():
    assert converted(TABLE.encode()) == 0


@pytest.mark.parametrize("name", GOOD)
@mutations(FEW)
@given(st.data())
def test_mutated_motions(name, data):
    checked(name, data.draw(damaged(name)))


@mutations(FEW)
@given(
    st.one_of(
        mutated_texts(TABLE).map(lambda text: text.encode("utf-8", "surrogatepass")),
        mutated_bytes(TABLE.encode()),
    )
)
def test_mutated_tables(content):
    converted(content)


@pytest.mark.slow
@pytest.mark.parametrize("name", GOOD)
@mutations(MANY)
@given(st.data())
def test_many_mutated_motions(name, data):
    checked(name, data.draw(damaged(name)))


@pytest.mark.slow
@mutations(MANY)
@given(
    st.one_of(
        mutated_texts(TABLE).map(lambda text: text.encode("utf-8", "surrogatepass")),
        mutated_bytes(TABLE.encode()),
    )
)
def test_many_mutated_tables(content):
    converted(content)
