"""Laws of a test read off: rules that dry joints of rigid blocks keep, and by how much they are not kept."""

import numpy as np
import xarray as xr

from blockshake.forces.joint_forces import gives_forces, joint_forces
from blockshake.forces.laws.closed_joint import closed_joint_law
from blockshake.forces.laws.friction import friction_law
from blockshake.forces.laws.impact import impact_law
from blockshake.forces.laws.lever import lever_law
from blockshake.forces.laws.table import table_law
from blockshake.forces.laws.unexplained import unexplained_law
from blockshake.forces.laws.work import work_law

_LAWS_OF_JOINTS = (lever_law, friction_law, closed_joint_law, impact_law, work_law)


NO_LAWS = xr.Dataset(
    {"law_value": ("law", np.empty(0)), "law_error": ("law", np.empty(0))},
    {
        "law": np.empty(0, dtype=str),
        "law_joint": ("law", np.empty(0, dtype=str)),
        "law_beneath": ("law", np.empty(0, bool)),
    },
)


def law_values(test, structure, sensors):
    """Laws of a test as from `read_laws`; none where the structure or the sensors give no joint forces."""
    if not gives_forces(test, structure, sensors):
        return NO_LAWS
    return read_laws(joint_forces(test, structure, sensors))


def read_laws(forces):
    """Statistics of all laws of one test.

    Parameters
    ----------
    forces : JointForces

    Returns
    -------
    xarray.Dataset
        Along ``law``: ``law_value`` in the unit of the table, NaN where the test does not tell, and ``law_error``, its
        standard error; coordinates ``law_joint``, the joint's name, empty for laws of the whole test, and
        ``law_beneath``, whether the joint carries all free bodies.
    """
    found, joint, beneath = {}, [], []
    n_free = np.count_nonzero(~forces.structure.driven)
    for place, face in enumerate(forces.transmitted.faces):
        number = forces.faces.index(face) + 1
        own = {}
        for law in _LAWS_OF_JOINTS:
            own |= {f"joint{number}.{name}": one for name, one in law(forces, place).items()}
        joint += [face.name] * len(own)
        beneath += [len(forces.transmitted.carried[place]) == n_free] * len(own)
        found |= own
    of_test = table_law(forces) | unexplained_law(forces)
    found |= of_test
    return xr.Dataset(
        {
            "law_value": ("law", np.array([one.value for one in found.values()])),
            "law_error": ("law", np.array([one.error for one in found.values()])),
        },
        {
            "law": list(found),
            "law_joint": ("law", joint + [""] * len(of_test)),
            "law_beneath": ("law", beneath + [False] * len(of_test)),
        },
    )
