"""A second, planar program of the same law: one block on rows of unilateral springs, dashpots and sliders.

Written apart from the solver, for what theory has no closed form for: how the layout of a face's nodes
changes the impact of rocking. Rigid block, springs fixed to its base line, semi-implicit Euler.
"""

import numba
import numpy as np
from dashpot_theory import critical_part

K_N, K_S, DEPTH, H, G = 2.16e10, 9.0e9, 2.4, 0.8, 9.81


@numba.njit
def _fall(x, gap, area, mass, central, pivot, angle, k_n, k_s, mu, zeta, dt, end):
    """Angular momentum about the far pivot at lean -``end``, what gravity took since upright added again."""
    c, s = np.cos(angle), np.sin(angle)
    X, Z, lean = pivot - pivot * c + H * s, pivot * s + H * c, angle
    u = v = w = taken = t = 0.0
    shear, before = np.zeros(x.size), np.zeros(x.size)
    while lean > -end and t < 2.0:
        c, s = np.cos(lean), np.sin(lean)
        depth = -(Z - s * x - c * (H - gap))
        touching = area[depth > 0.0].sum()
        dashpot = 2.0 * zeta * np.sqrt(mass * k_n / touching) if touching > 0.0 else 0.0
        force_x = force_z = moment = 0.0
        for i in range(x.size):
            foot = X + c * x[i] - s * H
            normal = 0.0
            if depth[i] > 0.0:
                normal = max(0.0, area[i] * (k_n * depth[i] - dashpot * (v - w * (foot - X))))
            if t > 0.0:
                shear[i] -= k_s * area[i] * (foot - before[i])
            before[i] = foot
            shear[i] = min(max(shear[i], -mu * normal), mu * normal)
            force_x += shear[i]
            force_z += normal
            moment += (-depth[i] - Z) * shear[i] - (foot - X) * normal
        u += dt * force_x / mass
        v += dt * (force_z / mass - G)
        w += dt * moment / central
        X += dt * u
        Z += dt * v
        lean += dt * w
        t += dt
        if lean < 0.0:
            taken += mass * G * (X + pivot) * dt
    return central * w + mass * (Z * u - (X + pivot) * v) - taken


def kept_by(rocker, x, width, restitution, angle, end, mu=0.9, dt=4e-6, gap=0.0):
    """Part of the angular momentum about the far pivot that the impact of a block let go at ``angle`` keeps.

    ``x``, ``width``: rows of springs [m] over the base's half widths and what each stands for [m]; ``gap``: how far
    each ends above the base's edges [m].
    """
    after = _fall(
        np.asarray(x), np.broadcast_to(gap, np.shape(x)), np.asarray(width) * DEPTH, rocker.mass, rocker.central,
        rocker.pivot, angle, K_N, K_S, mu, float(critical_part(restitution)), dt, end,
    )  # fmt: skip
    return after / (-rocker.inertia * rocker.speed(0.0, angle))
