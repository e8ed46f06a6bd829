"""Laws of a joint: Coulomb's coefficient by materials, slip rate, slip and direction; compliance of a soft layer."""

from typing import NamedTuple

import numpy as np

from blockshake.jit import kernel_without_allocation

# Columns of a law
COEFFICIENT, RATE_DROP, RATE_SCALE, SLIP_DROP, SLIP_SCALE, ASYMMETRY, N_LAW = 0, 1, 2, 3, 4, 5, 6


class FrictionLaws(NamedTuple):
    """Friction of every pair of bodies.

    ``material`` int64 (n_bodies,); ``law`` float64 (n_materials, n_materials, N_LAW), symmetric;
    ``joint`` int64 (n_own, 2) and ``factor`` (n_own,): joints, first body below second by index,
    with a factor of their own on the coefficient [1].
    """

    material: np.ndarray
    law: np.ndarray
    joint: np.ndarray
    factor: np.ndarray


def assemble_friction(structure):
    """Friction laws of a structure file; the coefficient alone acts unless it states more."""
    file = structure.file
    names = list(file.materials)
    law = np.zeros((len(names), len(names), N_LAW))
    law[:, :, [RATE_SCALE, SLIP_SCALE]] = 1.0
    for entry in file.friction:
        a, b = (names.index(material) for material in entry.pair)
        law[a, b] = law[b, a] = (
            entry.coefficient, entry.rate_drop, entry.rate_scale, entry.slip_drop, entry.slip_scale, entry.asymmetry,
        )  # fmt: skip
    bodies = structure.body_names
    pairs = [sorted(bodies.index(name) for name in joint.bodies) for joint in file.joints]
    return FrictionLaws(
        material=np.array([names.index(body.material) for body in file.bodies]),
        law=law,
        joint=np.array(pairs, dtype=np.int64).reshape(-1, 2),
        factor=np.array([joint.friction_factor for joint in file.joints], dtype=float),
    )


@kernel_without_allocation
def friction_coefficient(laws, a, b, slip_rate, slip):
    """Coulomb's coefficient of the joint of two bodies ``a`` and ``b``, before its direction is known [1].

    ``slip_rate`` at the step before [m/s]; ``slip`` that the joint has made so far, either way [m].

    Notes
    -----
    ``mu (1 - D_v (1 - exp(-v / v_c))) (1 - D_S (1 - exp(-S / S_c)))``: the first bracket is the
    Stribeck form of rate weakening, the second a slip weakening of the same form; ``D = 0`` leaves
    the coefficient as it is, to the bit. docs/method.md has the literature on concrete.
    """
    first, second, law = laws.material[a], laws.material[b], laws.law
    mu = law[first, second, COEFFICIENT]
    rate_drop, slip_drop = law[first, second, RATE_DROP], law[first, second, SLIP_DROP]
    if rate_drop > 0.0:
        mu *= 1.0 - rate_drop * (1.0 - np.exp(-slip_rate / law[first, second, RATE_SCALE]))
    if slip_drop > 0.0:
        mu *= 1.0 - slip_drop * (1.0 - np.exp(-slip / law[first, second, SLIP_SCALE]))
    for joint in range(laws.factor.size):
        if (laws.joint[joint, 0] == a and laws.joint[joint, 1] == b) or (
            laws.joint[joint, 0] == b and laws.joint[joint, 1] == a
        ):
            mu *= laws.factor[joint]
    return mu


@kernel_without_allocation
def friction_asymmetry(laws, a, b):
    """Share by which the coefficient is larger for slip along +x of the joint's first body, smaller along -x [1]."""
    return laws.law[laws.material[a], laws.material[b], ASYMMETRY]


def joint_compliance(structure):
    """Normal compliance of the layer in each joint, for either solver.

    Returns
    -------
    float64 array, shape (n_bodies, n_bodies)
        Symmetric, zero where there is no layer: closing per pressure [m3/N].
    """
    compliance = np.zeros((len(structure.mass), len(structure.mass)))
    for joint in structure.file.joints:
        a, b = (structure.body_names.index(name) for name in joint.bodies)
        compliance[a, b] = compliance[b, a] = joint.compliance
    return compliance
