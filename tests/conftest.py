import copy
import os
import signal
import subprocess
import sys

# before NumPy is loaded: threads of linear algebra beyond the cores wait for each other most of the time
os.environ |= dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), "1")

import numpy as np
import pytest

from blockshake.dynamics.system import Status, Trajectory
from blockshake.files import write_dataset
from blockshake.geometry.structure import build_structure
from blockshake.simulation.run_dataset import run_dataset
from blockshake.solvers.ls_dem.driver import simulate_ls_dem
from blockshake.solvers.ls_dem.parameters import LsDemParameters

# models that share kernels, the longest first; each row is compiled by a process of its own
COMPILED = (("ls-dem",), ("nscd-rigid", "nscd-elastic", "nscd-viscoelastic"))
COMPILE = (
    "import sys, blockshake.simulation.simulate as s; [s.compile_kernels(model) for model in sys.argv[1:]]"
)
# files that take long: a parallel run begins with them, so that no worker is left with one at the end
LONG = (
    "test_pages_that_run.py", "test_workflow.py", "test_parity.py", "test_causes_are_found.py",
    "test_metamorphic.py", "test_report.py",
    "test_resume.py", "test_steps.py", "test_plan_campaign.py", "test_clocks.py", "test_flights.py",
    "test_answers.py", "test_sampled_shapes.py", "test_failures.py", "test_measured_flights.py",
)  # fmt: skip
# files that start Snakemake, processes of their own, a browser or an installation: `make test-workflow`
OF_WORKFLOW = (
    "test_workflow.py",
    "test_failures.py",
    "test_comments_of_users.py",
    "test_pages_that_run.py",
    "test_wheel.py",
    "test_caches.py",
    "test_container.py",
    "test_names.py",
    "test_page_in_a_browser.py",
)
SHAPES = {
    "slab": {"box": [3.0, 3.0, 0.2]},
    "block": {"box": [0.8, 2.4, 1.6], "chamfer": 0.02},
    "sharp": {"box": [0.8, 2.4, 1.6]},
    "cube": {"box": [1.0, 1.0, 1.0]},
}
SLAB = {"name": "slab", "shape": "slab", "position": [0.0, 0.0, -0.1], "driven": True}


def pytest_sessionstart(session):
    """Compile the models before the workers of a parallel run start, which would each compile the same kernels."""
    if getattr(session.config.option, "numprocesses", None) and not hasattr(session.config, "workerinput"):
        processes = [subprocess.Popen([sys.executable, "-c", COMPILE, *models]) for models in COMPILED]
        assert [process.wait() for process in processes] == [0, 0]


@pytest.hookimpl(tryfirst=True)  # before tests are chosen by their marks
def pytest_collection_modifyitems(items):
    """Mark the files of `OF_WORKFLOW`, and let the files of `LONG` come first, in their order."""
    for item in items:
        if item.path.name in OF_WORKFLOW:
            item.add_marker(pytest.mark.workflow)
    place = {name: number for number, name in enumerate(LONG)}
    items.sort(key=lambda item: place.get(item.path.name, len(LONG)))


@pytest.fixture(scope="session")
def make_mapping():
    """Mapping of a structure file: bodies of a stone on a driven slab whose top is at z = 0; friction may be laws."""

    def make(bodies, *, friction=0.5, slab=True, shapes=None, **keys):
        mapping = {
            "name": "test",
            "materials": {"stone": {"density": 2400.0, "youngs_modulus": 3.45e10, "poisson_ratio": 0.2}},
            "shapes": {**SHAPES, **(shapes or {})},
            "bodies": [{"material": "stone", **body} for body in ([SLAB] if slab else []) + list(bodies)],
            "friction": friction
            if isinstance(friction, list)
            else [{"pair": ["stone", "stone"], "coefficient": friction}],
            **keys,
        }
        return copy.deepcopy(mapping)

    return make


@pytest.fixture(scope="session")
def make_structure(make_mapping):
    """Structure of `make_mapping`'s mapping; meshes are in a folder."""

    def make(bodies, *, folder=".", **keys):
        return build_structure(make_mapping(bodies, **keys), "test.yaml", folder)

    return make


@pytest.fixture
def heeded_interrupts():
    """Interrupts raise, also where the tests run in a shell's background and would ignore them."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


@pytest.fixture(scope="session")
def run_ls_dem():
    """LS-DEM run recorded at a uniform rate; keys are ``ls_dem`` parameters."""

    def run(structure, duration, *, motion=None, time_step=5e-5, rate=200, **parameters):
        times = np.arange(round(duration * rate) + 1) / rate
        return simulate_ls_dem(structure, motion, LsDemParameters(**parameters), times, time_step)

    return run


@pytest.fixture(scope="session")
def leaning_run(make_structure):
    """A run made by hand, and its structure: on a slab that moves at 0.1 m/s, the upper of two blocks tips slowly.

    The upper block turns at 0.05 rad/s about the edge of its face at x = 0.38 m. Forces and energy are made up.
    """
    lower = {"name": "lower", "shape": "block", "position": [0.0, 0.0, 0.8]}
    upper = {"name": "upper", "shape": "block", "position": [0.0, 0.0, 2.4]}
    markers = [{"name": "top", "body": "upper", "position": [0.0, -1.2, 0.8]}]
    structure = make_structure([lower, upper], markers=markers)
    time = np.arange(41) / 40.0
    angle, zero = 0.05 * time, np.zeros_like(time)
    position = np.tile(structure.position, (len(time), 1, 1))
    position[:, 2, 0] += 0.38 - 0.38 * np.cos(angle) + 0.8 * np.sin(angle)
    position[:, 2, 2] += 0.38 * np.sin(angle) + 0.8 * np.cos(angle) - 0.8
    position[..., 0] += 0.1 * time[:, None]
    orientation = np.tile(structure.orientation, (len(time), 1, 1))
    orientation[:, 2] = np.stack([np.cos(angle / 2), zero, np.sin(angle / 2), zero], axis=1)
    turning = np.zeros_like(position)
    turning[:, 2, 1] = 0.05
    force = np.zeros((len(time), 2, 3))
    force[:, 0], force[:, 1] = [3e3, -4e3, 2e4], [0.0, 0.0, 100.0]
    energy = np.zeros((len(time), 7))
    energy[:, 0], energy[:, 1] = 5.0 * time**2, 1000.0 + 10.0 * time
    energy[:, 3], energy[:, 6] = time, 5.0 * time**2 + 11.5 * time
    trajectory = Trajectory(
        time, position, orientation, np.gradient(position, time, axis=0), turning, energy,
        np.array([[0, 1], [1, 2]]), force, Status.COMPLETED, "", 1.0, {},
    )  # fmt: skip
    run = run_dataset(structure, trajectory, (position[:1], orientation[:1]))
    run.attrs = {
        "structure_file": structure.file.model_dump_json(), "structure": "test", "motion": "push", "motion_scale": 0.5,
        "motion_synthetic": 1, "model": "ls-dem", "status": "completed", "reason": "", "energy_residual": 0.043,
    }  # fmt: skip
    return run, structure


@pytest.fixture(scope="session")
def leaning_file(leaning_run, tmp_path_factory):
    """The file of `leaning_run`."""
    path = tmp_path_factory.mktemp("leaning") / "run.nc"
    write_dataset(path, leaning_run[0])
    return path


@pytest.fixture(scope="session")
def three():
    """Three blocks with a marker off the line of the others on each body."""
    from synthetic_campaigns import structure_of_three

    return structure_of_three()


@pytest.fixture(scope="session")
def clean_tests(three):
    """Faultless sensors: coloured noise, gaps, outliers, offsets, markers within 1 mm."""
    from synthetic_campaigns import make_tests

    return make_tests(
        three, 1, mounting=1e-3, marker_dropouts=0.01, accelerometer_offset=0.05, outliers=0.002
    )
