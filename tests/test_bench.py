"""The bench's smallest run; what it measures is the machine's, so that only its shape is tested here."""

import itertools
import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

BENCH = Path(__file__).parents[1] / "bench"


@pytest.fixture(autouse=True)
def _bench_importable(monkeypatch):
    monkeypatch.syspath_prepend(str(BENCH))


@pytest.fixture(scope="module")
def result(tmp_path_factory):
    output = tmp_path_factory.mktemp("bench") / "bench.json"
    command = [sys.executable, BENCH / "bench.py", "--quick", "--output", output]
    table = subprocess.run(command, check=True, capture_output=True, text=True).stdout
    return {**json.loads(output.read_text()), "table": table}


@pytest.mark.slow
def test_the_smallest_run_reports_every_part(result):
    assert set(result) == {
        "machine", "versions", "force_evaluation", "arithmetic", "simulated_second", "walls", "nscd_step",
        "nscd_walls", "still_stack", "table",
    }  # fmt: skip
    assert set(result["machine"]) == {"processor", "instruction_set", "cores", "system", "clock_ghz"}
    assert {"python", "numba", "llvmlite", "numpy", "blockshake", "kernel_source_digest"} <= set(
        result["versions"]
    )
    assert set(result["walls"]) == {
        "sizes", "spread_by_block", "spread_by_joint", "exponent", "memory_kib_per_block"
    }  # fmt: skip
    assert set(result["nscd_walls"]) == {"sizes", "exponent"}
    for heading in (
        "node evaluation",
        "core's peak",
        "simulated second",
        "Bonded walls",
        "Nonsmooth",
        "At rest",
    ):
        assert heading in result["table"]


@pytest.mark.slow
def test_the_smallest_works_of_scale_report_every_part(tmp_path):
    command = [sys.executable, BENCH / "scale.py", "--quick", "--output", tmp_path / "scale.json"]
    table = subprocess.run(command, check=True, capture_output=True, text=True).stdout
    found = json.loads((tmp_path / "scale.json").read_text())
    assert set(found) == {"samples", "hours", "blocks", "draws"}
    for rows in found.values():
        assert all(
            np.isfinite(figure) and figure > 0.0 for _, name, figure, _ in rows if "beside" not in name
        )
    for work in ("40 samples", "h of motion", "10 blocks", "200 draws"):
        assert work in table


def test_spread_gives_the_median_and_the_quartiles():
    from measuring import spread

    # five values in order: the third, and the second and fourth
    assert spread([5.0, 1.0, 9.0, 3.0, 7.0]) == {
        "median": 5.0, "lower_quartile": 3.0, "upper_quartile": 7.0, "repeats": 5
    }  # fmt: skip


def test_set_up_goes_out_of_the_difference_of_two_runs(monkeypatch):
    import measuring

    # a clock that a run moves on by 10 s of set-up and 2 s a step
    now = [0.0]
    monkeypatch.setattr(measuring.time, "process_time", lambda: now[0])

    def run(steps):
        now[0] += 10.0 + 2.0 * steps

    assert measuring.seconds_between(run, 1, 4, repeats=3).tolist() == [6.0, 6.0, 6.0]


def test_operations_are_counted_as_the_processor_does_them():
    from arithmetic import operations

    from blockshake.solvers.ls_dem.contact.packets import LANES

    counted = operations(
        [
            ("vmovupd", "(%rax), %zmm1"),  # no arithmetic
            ("vmulpd", "%zmm1, %zmm2, %zmm3"),  # 8
            ("vfmadd231pd", "%ymm1, %ymm2, %ymm3"),  # twice 4
            ("vsqrtpd", "%xmm1, %xmm2"),  # 2
            ("vaddsd", "%xmm1, %xmm2, %xmm3"),  # 1, not packed
            ("vcmpltpd", "%zmm1, %zmm2, %k1"),  # a comparison
            ("vmaxpd", "(%rcx), %zmm2, %zmm3"),  # 8
        ]
    )
    assert counted == {
        "operations_per_node": 27 / LANES, "packed_share": 26 / 27, "vector_bits": 512, "gathers": False
    }  # fmt: skip


def test_the_motion_is_the_sine_it_says():
    from motions import harmonic

    motion = harmonic(1.0)
    # u = A (cos wt - 1): at rest at 0, 1.5 m/s2 forward at half a period, back at the start after one;
    # a cubic spline's second derivative errs by w^2 h^2 / 12, 3e-6 of the amplitude at rows 1 ms apart
    assert motion.evaluate(np.array([0.0, 1.0]))[:, 0] == pytest.approx([0.0, 0.0], abs=1e-9)
    assert motion.evaluate(np.array([0.5]), derivative=2)[0, 0] == pytest.approx(1.5, rel=1e-5)


@pytest.mark.slow
def test_the_contact_kernel_is_vectorised(result):
    # scalar code would have no packed share; sums over the lanes are the few scalar operations left
    loops = [loop for loop in result["arithmetic"]["loops"] if not loop["gathers"]]
    assert loops
    assert min(loop["packed_share"] for loop in loops) > 0.8
    assert 0.0 < result["arithmetic"]["share_of_peak"] < 1.0


@pytest.mark.slow
def test_the_contact_kernel_has_no_more_operations_than_were_accepted(result):
    """Counted in its machine code, not timed: `make bench ARGUMENTS=--accept` accepts others."""
    import accepted

    before = accepted.accepted_operations(result["machine"]["instruction_set"])
    if before is None:
        pytest.skip(f"no bench was accepted on {result['machine']['instruction_set']}")
    assert accepted.total_operations(result["arithmetic"]) <= accepted.LARGEST_LOSS * before


@pytest.mark.parametrize("n_blocks", [10, 30, 100, 300, 1000, 2000])
def test_walls_have_the_blocks_asked_for_in_half_bond(n_blocks):
    import walls

    bodies = walls.wall_mapping(n_blocks)["bodies"]
    assert sum(not body["driven"] for body in bodies) == n_blocks
    courses = {}
    for body in bodies:
        courses.setdefault(round(body["position"][2], 6), []).append(body)
    ends = [
        np.cumsum([{"whole": 2, "half": 1}[body["shape"]] for body in course]) for course in courses.values()
    ]
    # every vertical joint of a course lies over the middle of a whole block of the course below
    for below, above in itertools.pairwise(ends):
        assert below[-1] == above[-1]
        assert not set(below[:-1]) & set(above[:-1])


@pytest.mark.parametrize("peer", ["lmgc90", "mujoco"])
def test_a_comparison_with_a_peer_skips_where_there_is_none(tmp_path, peer):
    # the program's own folder, copied: with it there is no environment of the peers
    for program in BENCH.glob("*.py"):
        (tmp_path / "bench").mkdir(exist_ok=True)
        (tmp_path / "bench" / program.name).write_text(program.read_text())
    output = tmp_path / "result.json"
    command = [sys.executable, tmp_path / "bench" / f"compare_{peer}.py", "--output", output]
    run = subprocess.run(command, capture_output=True, text=True)
    assert (run.returncode, run.stderr) == (0, "")
    assert run.stdout.startswith("skipped: ")
    assert "make peers" in run.stdout
    assert not output.exists()


def test_the_law_s_residual_of_a_peer_is_what_our_steps_end_by():
    from residuals import law_residual

    from blockshake.geometry.structure import build_structure

    mapping = {
        "name": "cube",
        "materials": {"stone": {"density": 1000.0, "youngs_modulus": 3.45e10, "poisson_ratio": 0.2}},
        "shapes": {"slab": {"box": [3.0, 3.0, 0.2]}, "cube": {"box": [1.0, 1.0, 1.0]}},
        "bodies": [
            {"name": "slab", "shape": "slab", "material": "stone", "position": [0, 0, -0.1], "driven": True},
            {"name": "cube", "shape": "cube", "material": "stone", "position": [0, 0, 0.5]},
        ],
        "friction": [{"pair": ["stone", "stone"], "coefficient": 0.5}],
    }
    structure = build_structure(mapping, "cube", ".")
    corners = np.array([[x, y, 0.0] for x in (-0.5, 0.5) for y in (-0.5, 0.5)])
    # normal up from the slab to the cube, force on the cube, which is named first
    answer = {
        "time": np.array([1e-3]),
        "position": structure.position[None],
        "rotation": np.tile(np.eye(3), (1, 2, 1, 1)),
        "1_bodies": np.tile([1, 0], (4, 1)),
        "1_point": corners,
        "1_basis": np.tile([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], (4, 1, 1)),
        "1_force": np.tile([0.25 * 1000.0 * 9.81, 0.0, 0.0], (4, 1)),
        "1_velocity": np.zeros((4, 3)),
        "1_gap": np.zeros(4),
    }
    assert law_residual(structure, answer, 1, 1e-3) == (0.0, 0.0)
    # contacts that open under load are off by rho u each, rho the effective mass: of a cube's corner, with
    # J = m / 6 and r = (1/2, 1/2, 1/2), 1 / rho is 4 / m along the normal and at most 5.5 / m across it
    answer["1_velocity"][:, 0] = 1e-3
    residual, deepest = law_residual(structure, answer, 1, 1e-3)
    assert residual == pytest.approx((1000.0 / 5.5 * 1e-3) / (0.25 * 1000.0 * 9.81 * 1e-3), rel=1e-9)
    assert deepest == 0.0
