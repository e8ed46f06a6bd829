"""Programs that `scale` measures, each in a process of its own: an hour of motion, and an ensemble of 10,000 draws."""

import sys
import tempfile
import time

import numpy as np

from blockshake.diagnosis.nominal import ensemble
from blockshake.diagnosis.nominal.histories import read_histories
from blockshake.diagnosis.nominal.nominal_model import draw_nominal
from blockshake.diagnosis.nominal.planned_test import PlannedTest
from blockshake.diagnosis.nominal.simulated_test import simulated_test
from blockshake.dynamics.load_motion import load_motion
from blockshake.dynamics.motion import ground_motion
from blockshake.files import write_dataset
from blockshake.geometry.structure import load_structure
from blockshake.measurement.campaigns.campaign import Sensors
from blockshake.simulation.simulate import simulate_to_file
from blockshake.store import load_made

_RATE = 200.0  # Hz, of the rows of the hour's motion


def simulate_hours(path, hours):
    """Configuration 1 under its motion again and again, to a run file."""
    motion = load_motion("basso-tirreno")
    times = np.arange(round(3600.0 * hours * _RATE) + 1) / _RATE
    moved = motion.evaluate(times % motion.duration, derivative=2)[:, 0]
    simulate_to_file(
        path, "configuration-1", ground_motion("hour", times, {"x": moved}, "acceleration"), "nscd-rigid"
    )


def hold_ensemble(draws, duration):
    """Gather, write and read an ensemble of so many draws; each is the first one, simulated, with other noise."""
    structure, model = load_structure("configuration-1"), "nscd-rigid"
    motion, markers = load_motion("basso-tirreno", 2.0), tuple(one.name for one in structure.file.markers)
    planned = PlannedTest(structure, motion, duration, Sensors(), markers)
    simulated = simulated_test(planned, draw_nominal(structure, model, 0))
    status = simulated.attrs["status"]
    first = read_histories(simulated, structure, planned.sensors).assign_attrs(status=status)
    generator = np.random.default_rng(0)

    def drawn(*_):
        histories = first.copy(deep=True)
        histories["slip"] *= 1.0 + 0.1 * generator.normal(size=histories["slip"].shape)
        return histories

    ensemble.simulated_histories = drawn  # all but the simulation of each draw is what is measured
    members = ensemble.nominal_members("test", planned, model, draws - 1, 0)
    began = time.process_time()
    found = ensemble.simulate_members(members, None)
    with tempfile.TemporaryDirectory() as folder:
        write_dataset(f"{folder}/runs.nc", found)
        gathered = time.process_time()
        load_made(f"{folder}/runs.nc")
    sys.stdout.write(f"{gathered - began} {time.process_time() - gathered}\n")


if __name__ == "__main__":
    what, *given = sys.argv[1:]
    if what == "hours":
        simulate_hours(given[0], float(given[1]))
    else:
        hold_ensemble(int(given[0]), float(given[1]))
