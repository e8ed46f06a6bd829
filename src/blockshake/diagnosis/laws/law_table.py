"""Every law of the joints: unit, transform, its value where it holds, formula and source."""

from typing import NamedTuple


class Law(NamedTuple):
    """One law.

    Attributes
    ----------
    unit : str
    scale : float
        Of the signed logarithm, in the unit; 0 leaves the value as it is.
    usual : float
        Value of rigid blocks with dry joints, where no simulated draw tells the law; NaN: none is known.
    spread : float
        Standard deviation that goes with it, and least spread of simulated draws in a third of it, after the
        transform: a law in which all draws agree is not for this infinitely sharp.
    formula, source : str
    least : bool
        Whether it is a distance that nothing makes too small: only a larger one breaks the law.
    judged : bool
        Whether a departure tells of an effect. The total of a whole test scatters as its rocking does: it is shown
        beside the draws, and no more.
    """

    unit: str
    scale: float
    usual: float
    spread: float
    formula: str
    source: str
    least: bool = False
    judged: bool = True


_NONE = float("nan")

OF_JOINTS = {
    # an edge is known to some 5 mm: by its chamfer in reality, by the places of nodes in a model
    "lever.short": Law(
        "m", 0.0, 5e-3, 1.2e-2, "half the face's width less the mean lever of both edges at small rotations",
        "Housner (1963)",
    ),
    "lever.bias": Law(
        "m", 0.0, 0.0, 3e-3, "half the difference of the levers of both edges while turned", "statics of a rigid block"
    ),
    "lever.step": Law(
        "m", 0.0, 0.0, 6e-3, "largest change of the levers from an instant on", "statics of a rigid block"
    ),
    "lever.slope": Law(
        "m/rad", 1.0, 0.0, 1.0, "change of the lever with the size of the rotation while turned", "a rounded edge rolls"
    ),
    "lever.stray": Law(
        "1", 1.0, 1.0, 0.4, "root mean square of the lever about its two edges, over its standard deviation",
        "statics of a rigid block", least=True,
    ),
    "friction.loss": Law(
        "1", 0.0, 0.0, 0.13, "1 less shear over normal force while slipping over the structure's coefficient", "Coulomb"
    ),
    # smoothed forces are small where a slip begins and ends: they seem to rise with the rate
    "friction.rate": Law(
        "1", 0.0, 0.1, 0.2, "change of shear over normal force by decade of the slip rate, over the coefficient",
        "Coulomb",
    ),
    "closed.compliance": Law(
        "rad/(N m)", 1e-9, 0.0, 1.5, "slope of a closed joint's rotation on its moment", "Winkler's bed"
    ),
    "impact.kept": Law(
        "1", 0.0, _NONE, 0.1, "angular velocity after over before an impact, median", "Housner (1963)"
    ),
    "impact.ringing": Law(
        "m s/rad", 2e-2, _NONE, 0.45,
        "rms of the lever of the joint above from 0.06 to 0.25 s after an impact, by the angular velocity, median",
        "restitution of impacts",
    ),
    "work.taken": Law(
        "J", 0.0, _NONE, 0.0, "energy that the joint takes out of the motion over the test",
        "wrench times relative velocity", judged=False,
    ),
}  # fmt: skip

OF_TESTS = {
    # a table's own pitch of some 1e-5 rad s2/m moves no lever by a millimetre
    "table.pitch": Law(
        "rad s2/m", 4e-5, 0.0, 1.0, "rotation of the table by its acceleration, beside its moment",
        "Conte and Trombetti (2000)",
    ),
    "table.compliance": Law(
        "rad/(N m)", 1e-10, 0.0, 1.0, "rotation of the table by the moment on it, beside its acceleration",
        "rocking impedance of a base",
    ),
    "unexplained.rms": Law(
        "1", 1e-3, 2e-3, 0.5, "rms of the least unexplained horizontal force over the blocks' weight",
        "residual forces: Ricles and Kosmatka (1992)", least=True,
    ),
    "unexplained.largest": Law(
        "1", 5e-3, 1e-2, 0.6, "largest unexplained horizontal force over the blocks' weight", "as unexplained.rms",
        least=True,
    ),
    "unexplained.mean": Law(
        "1", 0.0, 0.0, 6e-4, "mean unexplained horizontal force over the blocks' weight", "as unexplained.rms"
    ),
}  # fmt: skip


def law_of(name):
    """Entry for a law's full name, such as ``joint2.lever.bias``."""
    head, _, tail = name.partition(".")
    return OF_JOINTS[tail] if head.startswith("joint") else OF_TESTS[name]


def kind_of(name):
    """Name of a law without its joint, such as ``lever.bias``."""
    head, _, tail = name.partition(".")
    return tail if head.startswith("joint") else name
