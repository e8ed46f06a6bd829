"""How far contact forces are from the contact law, whoever found them: one measure for all programs."""

import numpy as np

from blockshake.jit import kernel
from blockshake.solvers.nscd.solve.gauss_seidel import contact_residual

# compiled
contact_residual = kernel(contact_residual)


def law_residual(structure, answer, step, time_step):
    """Relative residual of the contact law of one step of a peer.

    Parameters
    ----------
    structure : Structure
    answer : dict
        Contacts of ``step`` and poses, as `lmgc90_blocks` writes them; the last pose kept is that of the step.
    step : int
    time_step : float
        [s]

    Returns
    -------
    residual : float
        That of `solvers.nscd.gauss_seidel.relative_residual`, by which our own steps end [1].
    deepest : float
        Largest penetration [m].

    Notes
    -----
    From the program's own forces, gaps and relative velocities: ``u_n + max(gap, 0) / h`` complementary to ``p_n``,
    friction inside its cone and against the slip. An effective mass, from the levers at the end of the step,
    makes an impulse of a velocity, as in our own measure.
    """
    contacts = {
        name: answer[f"{step}_{name}"] for name in ("bodies", "point", "basis", "force", "velocity", "gap")
    }
    # two driven bodies side by side meet in the wheel, and not in our solver
    real = ~structure.driven[contacts["bodies"]].all(axis=1)
    contacts = {name: values[real] for name, values in contacts.items()}
    row = int(np.argmin(np.abs(answer["time"] - step * time_step)))
    position, rotation = answer["position"][row], answer["rotation"][row]
    inverse_mass = np.where(structure.driven, 0.0, 1.0 / structure.mass)
    inverse_inertia = rotation @ np.linalg.inv(structure.inertia) @ rotation.transpose(0, 2, 1)
    inverse_inertia[structure.driven] = 0.0
    W = np.zeros((len(contacts["gap"]), 3, 3))
    for body in contacts["bodies"].T:
        lever = np.cross((contacts["point"] - position[body])[:, None], contacts["basis"])
        W += inverse_mass[body, None, None] * np.eye(3)
        W += lever @ inverse_inertia[body] @ lever.transpose(0, 2, 1)
    friction = np.nanmax(structure.friction)
    impulse = time_step * contacts["force"]
    velocity = contacts["velocity"].copy()
    velocity[:, 0] += np.maximum(contacts["gap"], 0.0) / time_step
    most = np.maximum(W[:, 0, 0], np.linalg.eigvalsh(W[:, 1:, 1:])[:, -1])
    left = [
        contact_residual(*p, *u, friction, 1.0 / w) for p, u, w in zip(impulse, velocity, most, strict=True)
    ]
    weight = time_step * structure.mass[~structure.driven].min() * np.linalg.norm(structure.file.gravity)
    residual = np.linalg.norm(left) / max(np.linalg.norm(impulse), 1e-3 * weight)
    return float(residual), float(max(-contacts["gap"].min(), 0.0))
