"""Records as an archive publishes them: filtered with pads, stripped of these, straightened, printed with 7 digits."""

import sys
from pathlib import Path

import numpy as np
import pytest

from blockshake.dynamics.baseline import fast_length, high_pass
from blockshake.dynamics.intensity import motion_figures
from blockshake.dynamics.load_motion import load_motion
from blockshake.dynamics.motion import ground_motion

sys.path.insert(0, str(Path(__file__).parent))
from made_records import write_at2

COUNT = 40


def straightened(acceleration, step):
    """Less the second derivative of a polynomial through the displacement.

    Ancheta et al. (2013), PEER NGA-West2 database: degree 6, without its first two terms.
    """
    time = step * np.arange(len(acceleration))
    moved = ground_motion("m", time, {"x": acceleration}, "acceleration").evaluate(time)[:, 0]
    x, powers = time / time[-1], np.arange(2, 7)
    factors = np.linalg.lstsq(x[:, None] ** powers, moved, rcond=None)[0]
    return acceleration - x[:, None] ** (powers - 2) @ (powers * (powers - 1) * factors) / time[-1] ** 2


def published(generator):
    """Acceleration and its time step: noise under a window with a point source's spectrum, processed as above."""
    step, corner = generator.choice([0.005, 0.01]), generator.choice([0.04, 0.06, 0.1, 0.15, 0.2])
    lasts, onset = generator.uniform(3.0, 15.0), generator.uniform(2.0, 10.0)
    length = onset + max(2.5 * lasts, 3.0 / corner) + generator.uniform(0.0, 20.0)
    time = np.arange(0.0, length, step)
    since = np.clip((time - onset) / lasts, 0.0, None)
    noise = np.fft.rfft(generator.normal(size=len(time)) * since * np.exp(-2.5 * since), 2 * len(time))
    frequency = np.fft.rfftfreq(2 * len(time), step)
    shape = frequency**2 / (1.0 + (frequency / generator.uniform(0.1, 0.5)) ** 2) * np.exp(-0.1 * frequency)
    acceleration = np.fft.irfft(noise * shape)[: len(time)]
    acceleration *= generator.uniform(0.5, 6.0) / np.abs(acceleration).max()
    order = int(generator.choice([2, 4]))
    padded = fast_length(len(time) + 2 * int(1.5 * order / corner / step))
    return straightened(high_pass(acceleration, step, corner, order, padded)[: len(time)], step), step


@pytest.fixture(scope="module")
def records(tmp_path_factory):
    """By record, as read by default and as a correction leaves it: words, and peaks over those as published."""
    generator, folder, rows = np.random.default_rng(1), tmp_path_factory.mktemp("records"), []
    for number in range(COUNT):
        path = write_at2(folder / f"{number}.AT2", *published(generator))
        motions = [load_motion(path, baseline=baseline) for baseline in ("none", "auto", 0.1)]
        peaks = [motion_figures(motion)["peak_displacement"] for motion in motions]
        rows.append((motions[1].attributes["baseline"], peaks[1] / peaks[0], peaks[2] / peaks[0]))
    return rows


def test_archives_records_come_out_as_published(records):
    kept = [ratio for words, ratio, _ in records if words.startswith("as published")]
    assert len(kept) >= 0.95 * COUNT
    assert set(kept) == {1.0}
    # beyond rounding, as the pads are gone: named with the drift
    assert sum("of its peak displacement" in words for words, *_ in records) > 0.5 * COUNT


def test_a_correction_of_all_would_change_them(records):
    changes = [abs(ratio - 1.0) for *_, ratio in records]
    assert np.quantile(changes, 0.75) > 0.1
