"""Stiffness, damping and friction between bodies, as LS-DEM reads them."""

from typing import NamedTuple

import numpy as np

from blockshake.dynamics.friction import FrictionLaws, assemble_friction, joint_compliance
from blockshake.geometry.reference_block import reference_body
from blockshake.jit import kernel_without_allocation


class Interfaces(NamedTuple):
    """Contact parameters.

    ``k_n``, ``k_s`` (n_bodies,): stiffness per area that a body has against its like [N/m3]; ``layer``
    (n_bodies, n_bodies): normal compliance of the soft layer in each joint [m3/N]; ``inverse_mass`` (n_bodies,): zero
    for driven bodies [1/kg]; ``friction``: Coulomb's laws; ``damping_ratio`` of Eq. (3) and ``shear_damping_ratio``
    [1]; ``per_node`` 1.0 where Eq. (3) is taken literally, node by node, else 0.0; ``least_force``: below which a
    damped force is cut, 0 or (pulling) -inf [N].
    """

    k_n: np.ndarray
    k_s: np.ndarray
    layer: np.ndarray
    inverse_mass: np.ndarray
    friction: FrictionLaws
    damping_ratio: float
    shear_damping_ratio: float
    per_node: float
    least_force: float


def damping_ratio(restitution):
    """Fraction of critical damping of Eq. (3) for a coefficient of restitution.

    Zhou et al. (2023), Eq. (3) after Tsuji et al. (1993), with ``ln C_res^2`` read as ``(ln C_res)^2``: a spring and
    dashpot that may pull then rebounds with exactly ``C_res``. ``C_res = 0`` means critical damping.
    """
    if restitution == 0.0:
        return 1.0
    return -np.log(restitution) / np.sqrt(np.pi**2 + np.log(restitution) ** 2)


def assemble_interfaces(structure, parameters):
    """Contact parameters of a structure.

    The stiffness given holds between bodies of the material of `reference_body`. A material's own stiffness goes
    with its Young's (shear) modulus, and two sides act in series, so that like on like has the stiffness of its
    material.
    """
    file = structure.file
    materials = [file.materials[body.material] for body in file.bodies]
    young = np.array([material.youngs_modulus for material in materials])
    shear = young / (2.0 + 2.0 * np.array([material.poisson_ratio for material in materials]))
    reference = reference_body(structure)
    return Interfaces(
        k_n=parameters.normal_stiffness * young / young[reference],
        k_s=parameters.shear_stiffness * shear / shear[reference],
        layer=joint_compliance(structure),
        inverse_mass=np.where(structure.driven, 0.0, 1.0 / structure.mass),
        friction=assemble_friction(structure),
        damping_ratio=float(damping_ratio(file.restitution)),
        shear_damping_ratio=parameters.shear_damping_ratio,
        per_node=1.0 if parameters.damping == "node" else 0.0,
        least_force=-np.inf if parameters.pulling else 0.0,
    )


@kernel_without_allocation
def in_series(stiffness, a, b):
    """Stiffness between two bodies, each giving half of the compliance: per area [N/m3]."""
    return 2.0 / (1.0 / stiffness[a] + 1.0 / stiffness[b])


@kernel_without_allocation
def normal_stiffness(interfaces, a, b):
    """Stiffness of two bodies and the soft layer between them in series, along the normal: per area [N/m3]."""
    return 2.0 / (1.0 / interfaces.k_n[a] + 1.0 / interfaces.k_n[b] + 2.0 * interfaces.layer[a, b])


@kernel_without_allocation
def dashpot_coefficient(interfaces, a, b, ratio, stiffness, area):
    """Coefficient of one side's dashpot, per area of node [N s/m3] or, literally, per root of it [N s/m2].

    Parameters
    ----------
    interfaces : Interfaces
    a, b : int
        Bodies.
    ratio : float
        Fraction of critical damping [1].
    stiffness : float
        Stiffness of the interface, per area [N/m3].
    area : float
        In touch [m2].

    Notes
    -----
    Zhou et al. (2023), Eq. (3). The damping belongs to the interface: ``2 zeta sqrt(m k / A)`` for the
    mass m effective in a central impact of the two bodies, half of it on each side, so that a face rebounds
    alike however many nodes carry it. Literally, each node has the dashpot ``2 zeta sqrt(m k_node)`` of
    its own stiffness, half of the interface's, and of the same mass.
    """
    if area == 0.0 or ratio == 0.0:
        return 0.0
    mass = 1.0 / (interfaces.inverse_mass[a] + interfaces.inverse_mass[b])
    if interfaces.per_node == 1.0:
        return 2.0 * ratio * np.sqrt(0.5 * mass * stiffness)
    return ratio * np.sqrt(mass * stiffness / area)
