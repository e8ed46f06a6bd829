"""Rigid rocking after Housner (1963): geometry of a block, its equation between impacts, a release pose."""

import numpy as np
from both_solvers import leans
from scipy.integrate import solve_ivp

G = 9.81
H = 0.8  # m, half height of `block` and `sharp`
HALF_WIDTH = 0.4  # m


class Rocker:
    """Sharp block, 0.8 m wide unless said, 2.4 m deep and 1.6 m high, that pivots about its outermost nodes.

    ``pivot`` half distance of the two pivots [m]; ``alpha`` slenderness angle [rad]; ``radius`` from the
    pivot to the mass centre [m]; ``inertia`` about the pivot [kg m2]; ``p2`` squared frequency [1/s2];
    ``housner`` ratio of angular velocities in a plastic impact at the far pivot.
    """

    def __init__(self, inset, width=2.0 * HALF_WIDTH):
        self.pivot = 0.5 * width - inset
        self.mass = width * 2.4 * 1.6 * 2400.0
        self.central = self.mass * (width**2 + 1.6**2) / 12.0
        self.alpha, self.radius = np.arctan(self.pivot / H), np.hypot(self.pivot, H)
        self.inertia = self.central + self.mass * self.radius**2
        self.p2 = self.mass * G * self.radius / self.inertia
        self.housner = 1.0 - 2.0 * self.mass * self.pivot**2 / self.inertia

    def speed(self, angle, released):
        """Angular speed at lean ``angle`` of a block let go at ``released`` [rad/s]; energy."""
        return np.sqrt(2.0 * self.p2 * (np.cos(self.alpha - released) - np.cos(self.alpha - angle)))

    def quarter(self, angle):
        """Time from rest at a lean to upright [s]: ``theta'' = -p^2 sin(alpha - theta)``, by integration."""

        def upright(_, y):
            return y[0]

        upright.terminal = True
        run = solve_ivp(
            lambda _, y: [y[1], -self.p2 * np.sin(self.alpha - y[0])], (0.0, 10.0), [angle, 0.0], events=upright,
            rtol=1e-11, atol=1e-13,
        )  # fmt: skip
        return run.t[-1]

    def ratio(self, resultant):
        """Ratio of angular velocities when the impulse acts at ``resultant`` times the pivot's distance.

        Angular momentum about the point of the base where the impulse acts is kept, and the block goes on
        about the far pivot without a bounce: 1 gives Housner's ratio, 0 (the middle of the base) gives 1.
        """
        core, share = self.central + self.mass * H**2, resultant * self.mass * self.pivot**2
        return (core - share) / (core + share)

    def body(self, angle):
        """The block at rest, leaning by ``angle`` to +x about the nodes on that side of a base at z = 0."""
        c, s = np.cos(angle), np.sin(angle)
        return {
            "name": "b", "shape": "sharp", "orientation": [np.cos(angle / 2), 0.0, np.sin(angle / 2), 0.0],
            "position": [self.pivot - self.pivot * c + H * s, 0.0, self.pivot * s + H * c],
        }  # fmt: skip

    def kept(self, run, lean):
        """Angular momentum about the far pivot over that before the impact, read at lean -``lean`` [1].

        The part that gravity took since the block stood upright is added again. No force at the far pivot
        changes it, so that bounces there do not: it does not matter when it is read.
        """
        angle = leans(run)
        x, z = run.position[:, 1, 0], run.position[:, 1, 2]
        v, spin = run.velocity[:, 1], run.angular_velocity[:, 1, 1]
        about = self.central * spin + self.mass * (z * v[:, 0] - (x + self.pivot) * v[:, 2])
        after = np.flatnonzero(angle < 0.0)[0]
        here = np.flatnonzero(angle < -lean)[0]
        upright = run.time[after] - angle[after] / spin[after]
        weight = self.mass * G * (x[after : here + 1] + self.pivot)
        lost = np.trapezoid(weight, run.time[after : here + 1]) + weight[0] * (run.time[after] - upright)
        return (about[here] - lost) / (-self.inertia * self.speed(0.0, angle[0]))


def rock(rocker, acceleration, duration, ratio):
    """Event-driven rocking of a block on a base with ``acceleration(t)`` [m/s2]: Housner's full equation.

    ``theta'' = -p^2 (sin(alpha sgn(theta) - theta) + a/g cos(alpha sgn(theta) - theta))`` while it leans
    (lean to +x positive), from rest until the base pulls more than ``g tan(alpha)``; each impact keeps
    ``ratio`` of the angular velocity.

    Returns
    -------
    overturned : bool
        Lean beyond a right angle.
    impacts : int
        Before that, or before ``duration``.
    """
    t, impacts = 0.0, 0
    threshold = G * np.tan(rocker.alpha)
    grid = np.linspace(0.0, duration, 20001)
    start = grid[np.abs(acceleration(grid)) > threshold]
    if start.size == 0:
        return False, 0
    t = start[0]
    # the base accelerates to +x and the block leans to -x
    side, speed = -np.sign(acceleration(t)), 0.0
    while t < duration:

        def slope(s, y, side=side):
            gap = rocker.alpha * side - y[0]
            return [y[1], -rocker.p2 * (np.sin(gap) + acceleration(s) / G * np.cos(gap))]

        def upright(_, y, side=side):
            return side * y[0]

        def fallen(_, y, side=side):
            return side * y[0] - 0.5 * np.pi

        upright.terminal = fallen.terminal = True
        upright.direction = -1.0
        run = solve_ivp(
            slope, (t, duration), [side * 1e-12, speed], events=(upright, fallen), rtol=1e-9, atol=1e-12,
            max_step=0.01,
        )  # fmt: skip
        if run.t_events[1].size > 0:
            return True, impacts
        if run.t_events[0].size == 0:
            return False, impacts
        t, speed = run.t[-1], ratio * run.y[1][-1]
        impacts += 1
        if abs(speed) < 1e-3:
            return False, impacts
        side = np.sign(speed)
    return False, impacts
