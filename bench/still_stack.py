"""Blocks at rest for a minute: how far each solver lets them creep and turn, and so do the peers that are there."""

import numpy as np
import peers
from scipy.spatial.transform import Rotation

from blockshake.dynamics.motion import ground_motion
from blockshake.geometry.structure import build_structure
from blockshake.simulation.models import MODELS
from blockshake.simulation.simulate import simulate

DURATION = 60.0  # s
PEER_STEP = 1e-3  # s
# from below: edges of cubes [m] and densities [kg/m3]; LS-DEM's step [s], below half of what is stable
CASES = {
    "eight equal cubes": ((1.0,) * 8, (2400.0,) * 8, 5e-5),
    "on one of a 1,000th of its mass": ((1.0, 1.0), (24.0, 24000.0), 5e-6),
    "on one of a tenth of its edge": ((0.1, 1.0), (2400.0, 2400.0), 2e-5),
    "on one of ten times its edge": ((1.0, 0.1), (2400.0, 2400.0), 2e-5),
}


def stack(edges, densities):
    """Cubes face on face on a slab, with one friction for all."""
    materials = {
        f"of-{density:g}": {
            "density": density, "youngs_modulus": 3.45e10, "poisson_ratio": 0.2, "viscous_modulus": 1.5e8,
        }
        for density in {2400.0, *densities}
    }  # fmt: skip
    bodies = [
        {"name": "slab", "shape": "slab", "material": "of-2400", "position": [0, 0, -0.1], "driven": True}
    ]
    height = 0.0
    for number, (edge, density) in enumerate(zip(edges, densities, strict=True), start=1):
        place = [0.0, 0.0, height + 0.5 * edge]
        bodies.append(
            {
                "name": f"cube-{number}",
                "shape": f"cube-{number}",
                "material": f"of-{density:g}",
                "position": place,
            }
        )
        height += edge
    mapping = {
        "name": "still stack",
        "materials": materials,
        "shapes": {
            "slab": {"box": [3.0, 3.0, 0.2]},
            **{f"cube-{number}": {"box": [edge] * 3} for number, edge in enumerate(edges, start=1)},
        },
        "bodies": bodies,
        "friction": [
            {"pair": [one, other], "coefficient": 0.75}
            for one in materials
            for other in materials
            if one <= other
        ],
    }
    return build_structure(mapping, "still stack", ".")


def measure_still_stack(duration=DURATION, cases=tuple(CASES), models=tuple(MODELS)):
    """Drift, sinking and turn of every case by every model and peer.

    Returns
    -------
    dict of str to dict of str to dict
        By case and program: ``drift`` across and ``sink`` along gravity [m], ``turn`` [rad], each the largest of all
        blocks at all whole seconds since the start; a peer that is not there has its reason as a str.
    """
    return {
        name: {
            **{model: _ours(stack(*CASES[name][:2]), model, CASES[name][2], duration) for model in models},
            **{peer: _theirs(stack(*CASES[name][:2]), peer, duration) for peer in peers.PROGRAMS},
        }
        for name in cases
    }


def _ours(structure, model, step, duration):
    rest = ground_motion("rest", np.array([0.0, 0.1]), {"x": np.zeros(2)}, "acceleration")
    step = step if MODELS[model].calibrated else None
    run = simulate(
        structure, rest, model, time_step=step, duration=duration, output_rate=1.0, accelerometers=False
    )
    if run.attrs["status"] != "completed":
        return f"{run.attrs['status']} {run.attrs['reason']}"
    run = run.isel(body=~structure.driven)
    turns = run["orientation"].to_numpy()
    shape = turns.shape[:2]
    turned = Rotation.from_quat(turns.reshape(-1, 4), scalar_first=True).as_matrix().reshape(*shape, 3, 3)
    return _crept(run["position"].to_numpy(), turned)


def _theirs(structure, peer, duration):
    if peers.peer_version(peer) is None:
        return f"skipped: {peers.MISSING.format(peer)}"
    steps = round(duration / PEER_STEP)
    task = peers.block_task(structure, None, PEER_STEP, steps, record_every=round(1.0 / PEER_STEP))
    answer, free = peers.ask_peer(peer, task), ~structure.driven
    start = structure.position[None, free], np.tile(np.eye(3), (1, free.sum(), 1, 1))
    position, turned = (
        np.concatenate([first, answer[name][:, free]])
        for first, name in zip(start, ("position", "rotation"), strict=True)
    )
    return _crept(position, turned)


def _crept(position, turned):
    """Largest way and turn since the first time; ``position`` (n_times, n_blocks, 3), ``turned`` (..., 3, 3)."""
    way = position - position[0]
    since = np.swapaxes(turned[0], -1, -2) @ turned
    # sine of a turn: half the skew part, which keeps angles that a cosine loses
    skew = 0.5 * np.stack([since[..., i, j] - since[..., j, i] for i, j in ((2, 1), (0, 2), (1, 0))])
    return {
        "drift": float(np.linalg.norm(way[..., :2], axis=-1).max()),
        "sink": float(-way[..., 2].min()),
        "turn": float(np.arcsin(np.minimum(np.linalg.norm(skew, axis=0), 1.0)).max()),
    }
