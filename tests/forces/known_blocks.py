"""Readings of blocks whose motion is known in closed form, so that every force follows by hand."""

import numpy as np
import xarray as xr

from blockshake.geometry.structure import build_structure

GRAVITY = 9.81
HEIGHT, WIDTH, DEPTH = 1.6, 0.8, 2.4
SPAN, BRIDGE = 1.0, 0.8  # m: of a portal, half the distance of its blocks, and the height of its bridge
RATE, RATE_ACC = 200.0, 512.0
DURATION = 6.0
STILL = 0.6  # s
PLACES = {"a": (0.4, 0.0, 0.0), "b": (-0.3, -1.2, 0.65), "c": (0.3, -1.2, -0.65), "d": (-0.3, -1.2, -0.65)}


def stack(n_blocks, friction=0.75):
    """Stack of sharp-edged blocks on a slab, four markers and an accelerometer a block."""
    names = [f"block-{number}" for number in range(1, n_blocks + 1)]
    bodies = [
        {"name": "slab", "shape": "slab", "material": "concrete", "position": [0, 0, -0.1], "driven": True}
    ]
    bodies += [
        {"name": name, "shape": "block", "material": "concrete", "position": [0, 0, HEIGHT * (place + 0.5)]}
        for place, name in enumerate(names)
    ]
    mapping = {
        "name": "known",
        "description": "known",
        "materials": {
            "concrete": {
                "density": 2400.0, "youngs_modulus": 3e10, "poisson_ratio": 0.2, "viscous_modulus": 1e8,
            }
        },
        "shapes": {"slab": {"box": [3.0, 3.0, 0.2]}, "block": {"box": [WIDTH, DEPTH, HEIGHT]}},
        "bodies": bodies,
        "friction": [{"pair": ["concrete", "concrete"], "coefficient": friction}],
        "restitution": 0.5,
        "markers": [
            {"name": f"{name}-{key}", "body": name, "position": list(place)}
            for name in names
            for key, place in PLACES.items()
        ]
        + [
            {"name": f"slab-{key}", "body": "slab", "position": place}
            for key, place in {"a": [1.5, 0, 0], "b": [-1.2, -1.5, 0.05], "c": [1.2, -1.5, 0.05]}.items()
        ],
        "accelerometers": [
            {"name": f"{name}-acc", "body": name, "position": [0.4, 0, 0.7], "axes": ["x", "z"]}
            for name in ["slab", *names]
        ],
    }  # fmt: skip
    return build_structure(mapping, "known.yaml", ".")


def portal():
    """Two blocks 2 m apart, and a third one that bridges them: joints in a loop."""
    structure = stack(3)
    mapping = structure.file.model_dump(mode="json")
    mapping["shapes"]["bridge"] = {"box": [2.0 * SPAN + WIDTH, DEPTH, BRIDGE]}
    left, right, bridge = mapping["bodies"][1:]
    left["position"], right["position"] = [-SPAN, 0.0, 0.5 * HEIGHT], [SPAN, 0.0, 0.5 * HEIGHT]
    bridge |= {"shape": "bridge", "position": [0.0, 0.0, HEIGHT + 0.5 * BRIDGE]}
    return structure.with_mapping(mapping)


def swaying(turn):
    """The blocks of a `portal` that turn alike about their edges, and its bridge that stays level.

    The table moves as it must for that, by the moment of all about the edges: no other force acts.
    """
    mass, carried = WIDTH * HEIGHT, (2.0 * SPAN + WIDTH) * BRIDGE  # over density and depth
    half, high, square = 0.5 * WIDTH, 0.5 * HEIGHT, WIDTH**2 + HEIGHT**2
    step = 5e-4
    grid = np.arange(int((DURATION + 0.1) / step)) * step
    angle = np.array([turn(t) for t in grid])
    side, c, s = np.sign(angle), np.cos(angle), np.sin(angle)
    spun = (2.0 * mass / 3.0 + carried) * square * np.gradient(np.gradient(angle, step), step)
    weight = 2.0 * (mass + carried) * GRAVITY * (side * half * c - high * s)
    along = -(spun + weight) / (2.0 * (mass + carried) * (side * half * s + high * c))
    table = np.cumsum(np.cumsum(np.where(angle != 0.0, along, 0.0))) * step**2
    block = rocking(lambda t: np.interp(t, grid, table), turn)

    def poses(t):
        moved = block(t)
        side = np.sign(turn(t))
        c, s = np.cos(turn(t)), np.sin(turn(t))
        # the corner on which the bridge lies, seen from the edge about which its block turns
        x, z = side * WIDTH * (1.0 - c) + HEIGHT * s, side * WIDTH * s + HEIGHT * (c - 1.0)
        return np.array([*moved, moved[1], [moved[0, 0] + x, z, 0.0]])

    return poses


def shaken(amplitude=1.0, frequency=1.0):
    """Displacement of a table whose acceleration is a sine of an amplitude [m/s2] once it has grown."""

    def moved(t):
        own = np.clip(t - STILL, 0.0, None)
        grown = own**3 / (own**3 + 0.3**3)
        return -amplitude / (2.0 * np.pi * frequency) ** 2 * grown * np.sin(2.0 * np.pi * frequency * own)

    return moved


def rocking(table, turn):
    """One block that rocks about its edges on a table."""
    half, high = 0.5 * WIDTH, 0.5 * HEIGHT

    def poses(t):
        angle = turn(t)
        side = np.sign(angle) if angle else 1.0
        c, s = np.cos(angle), np.sin(angle)
        # the mass centre seen from the edge turns with the block
        x = side * half + (-side * half * c + high * s)
        z = (side * half * s + high * c) - high
        return np.array([[table(t), 0.0, 0.0], [table(t) + x, z, angle]])

    return poses


def sliding(table, mu):
    """One block that Coulomb's friction drags along with a table, by integration."""
    step = 1e-4
    grid = np.arange(int((DURATION + 0.1) / step)) * step
    speed = np.gradient(table(grid), step)
    own = np.zeros_like(grid)
    for row in range(1, len(grid)):
        limit = mu * GRAVITY * step
        own[row] = own[row - 1] + np.clip(speed[row] - own[row - 1], -limit, limit)
    histories = table(grid), np.cumsum(own) * step

    def poses(t):
        at_table, at_block = (np.interp(t, grid, history) for history in histories)
        return np.array([[at_table, 0.0, 0.0], [at_block, 0.0, 0.0]])

    return poses


def readings(structure, poses, noise=0.0, noise_acc=0.0, seed=0):
    """A test file of bodies whose poses are functions of time.

    Parameters
    ----------
    structure : Structure
    poses : callable
        For a time: displacements along x and z of the mass centres [m] and turns about y [rad], (n_bodies, 3).
    noise, noise_acc : float
        White, of markers [m] and accelerometers [m/s2].
    seed : int
    """
    generator = np.random.default_rng(seed)
    time, time_acc = (np.arange(int(DURATION * rate) + 1) / rate for rate in (RATE, RATE_ACC))
    markers = structure.file.markers
    places = np.array([_point(structure, poses(t), marker) for t in time for marker in markers])
    places = places.reshape(len(time), len(markers), 3)
    moved = places - places[0] + generator.normal(0.0, noise, places.shape)
    step, channels, columns = 1e-3, [], []
    for sensor in structure.file.accelerometers:
        for axis in sensor.axes:
            channels.append(f"{sensor.name}-{axis}")
            columns.append([_specific_force(structure, poses, sensor, axis, t, step) for t in time_acc])
    force = np.array(columns).T
    return xr.Dataset(
        {
            "marker_displacement": (("time", "marker", "axis"), moved),
            "accelerometer": (
                ("time_acc", "channel"), force - force[0] + generator.normal(0.0, noise_acc, force.shape)
            ),
        },
        {
            "time": time, "marker": [marker.name for marker in markers], "axis": ["x", "y", "z"],
            "time_acc": time_acc, "channel": channels,
        },
    )  # fmt: skip


def _point(structure, pose, sensor):
    (body,), (arm,) = structure.carriers([sensor]), structure.arms([sensor])
    x, z, turn = pose[body]
    c, s = np.cos(turn), np.sin(turn)
    own = np.array([c * arm[0] + s * arm[2], arm[1], c * arm[2] - s * arm[0]])
    return structure.position[body] + [x, 0.0, z] + own


def _specific_force(structure, poses, sensor, axis, t, step):
    before, now, after = (_point(structure, poses(t + shift), sensor) for shift in (-step, 0.0, step))
    along = (before - 2.0 * now + after) / step**2 + [0.0, 0.0, GRAVITY]
    turn = poses(t)[structure.carriers([sensor])[0], 2]
    c, s = np.cos(turn), np.sin(turn)
    return along @ {"x": [c, 0.0, -s], "z": [s, 0.0, c]}[axis]


def accelerations(poses, t, step=1e-3):
    """Second derivatives of all poses, (n_bodies, 3)."""
    return (poses(t - step) - 2.0 * poses(t) + poses(t + step)) / step**2


def kicked(shares, height=HEIGHT, kick=0.5, table_acceleration=lambda t: 0.0):
    """Turn of a body that is struck at 0.8 s, rocks freely on two edges, and keeps given shares of its spin.

    Housner's (1963) equation ``phi'' = -p^2 (sin(alpha - phi) + a / g cos(alpha - phi))`` on the edge to +x and its
    mirror image, by integration; a negative share turns the body back on the edge from which it came.

    Parameters
    ----------
    shares : list of float
        By impact, the last one for all others [1].
    height : float
        The body [m].
    kick : float
        Spin at first [rad/s].
    table_acceleration : callable
        A time [m/s2].
    """
    half, high = 0.5 * WIDTH, 0.5 * height
    radius, alpha = np.hypot(half, high), np.arctan2(half, high)
    inertia = (WIDTH**2 + height**2) / 12.0 + radius**2
    step = 1e-4
    grid = np.arange(int((DURATION + 0.1) / step)) * step
    turn, angle, spin, side, impacts = np.zeros_like(grid), 0.0, 0.0, 1.0, 0
    for row, time in enumerate(grid):
        if row == round(0.8 / step):
            spin = kick
        if row < round(0.8 / step):
            continue
        pull = GRAVITY * np.sin(alpha - side * angle) + side * table_acceleration(time) * np.cos(
            alpha - side * angle
        )
        faster = spin - step * side * radius * pull / inertia
        angle, spin = angle + 0.5 * step * (spin + faster), faster
        if side * angle < 0.0 and side * spin < 0.0:
            share = shares[min(impacts, len(shares) - 1)]
            impacts += 1
            spin *= share
            angle, side = (0.0, side) if share < 0.0 else (angle, -side)
        turn[row] = angle
    return lambda t: float(np.interp(t, grid, turn))
