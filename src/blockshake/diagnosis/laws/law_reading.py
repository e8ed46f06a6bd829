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

_LAWS_OF_JOINTS = (lever_law, friction_law, closed_joint_law, impact_law)


NO_LAWS = xr.Dataset(
    {"law_value": ("law", np.empty(0)), "law_error": ("law", np.empty(0))}, {"law": np.empty(0, dtype=str)}
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
        standard error.
    """
    found = {}
    for place, face in enumerate(forces.transmitted.faces):
        number = forces.faces.index(face) + 1
        for law in _LAWS_OF_JOINTS:
            found |= {f"joint{number}.{name}": one for name, one in law(forces, place).items()}
    found |= table_law(forces) | unexplained_law(forces)
    return xr.Dataset(
        {
            "law_value": ("law", np.array([one.value for one in found.values()])),
            "law_error": ("law", np.array([one.error for one in found.values()])),
        },
        {"law": list(found)},
    )
