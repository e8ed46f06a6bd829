"""Programs that `scale` measures, each in a process of its own: an hour of motion, and a library of 10,000 draws."""

import sys
import tempfile
import time
from collections import namedtuple

import numpy as np

from blockshake.diagnosis.features.reading import read_off
from blockshake.diagnosis.inference.library_scores import load_tables, score_library
from blockshake.diagnosis.libraries import library as libraries
from blockshake.diagnosis.libraries.candidates import candidates
from blockshake.diagnosis.libraries.designed_test import PlannedTest, simulated_test
from blockshake.diagnosis.libraries.null_model import draw_nominal
from blockshake.dynamics.load_motion import load_motion
from blockshake.dynamics.motion import ground_motion
from blockshake.effects.registry import EFFECTS
from blockshake.files import write_dataset
from blockshake.geometry.structure import load_structure
from blockshake.measurement.campaigns.campaign import Sensors
from blockshake.simulation.simulate import simulate_to_file

_RATE = 200.0  # Hz, of the rows of the hour's motion
_KEPT = namedtuple("_KEPT", "reading how")


def simulate_hours(path, hours):
    """Configuration 1 under its motion again and again, to a run file."""
    motion = load_motion("basso-tirreno")
    times = np.arange(round(3600.0 * hours * _RATE) + 1) / _RATE
    moved = motion.evaluate(times % motion.duration, derivative=2)[:, 0]
    simulate_to_file(
        path, "configuration-1", ground_motion("hour", times, {"x": moved}, "acceleration"), "nscd-rigid"
    )


def hold_library(draws, duration):
    """Gather, write, read and score a library of so many draws; each is the first one, simulated, with other noise."""
    structure, model = load_structure("configuration-1"), "nscd-rigid"
    motion, markers = load_motion("basso-tirreno", 2.0), tuple(one.name for one in structure.file.markers)
    planned = PlannedTest(structure, motion, duration, Sensors(), markers, ())
    simulated, status = simulated_test(planned, draw_nominal(structure, model, 0))
    first = {
        laws: read_off(simulated, structure, planned.sensors, laws=laws).assign(status=status)
        for laws in (True, False)
    }
    generator = np.random.default_rng(1)

    def drawn(planned, draw, effects, store, source, histories):
        reading = first[histories].copy(deep=True)
        reading["value"] *= 1.0 + 0.1 * generator.normal(size=reading["value"].shape)
        return _KEPT(reading, "kept")

    libraries.kept_reading = drawn  # all but the simulation of each draw is what is measured
    tried = candidates(structure)
    began = time.process_time()
    found = libraries.library(planned, model, tried, draws - 2 * len(tried), 2, "", "", lambda line: None)
    with tempfile.TemporaryDirectory() as folder:
        write_dataset(f"{folder}/features.nc", found.features)
        write_dataset(f"{folder}/histories.nc", found.histories)
        gathered = time.process_time()
        library, _ = score_library(load_tables([f"{folder}/features.nc"]), list(EFFECTS))
        library.score([library.tamed[0][model]["nominal"][0]])
    sys.stdout.write(f"{gathered - began} {time.process_time() - gathered}\n")


if __name__ == "__main__":
    what, *given = sys.argv[1:]
    if what == "hours":
        simulate_hours(given[0], float(given[1]))
    else:
        hold_library(int(given[0]), float(given[1]))
