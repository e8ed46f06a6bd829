"""The parts of a run with deformable bodies as arrays, to be saved and read back."""

from blockshake.solvers.nscd import checkpoint as rigid
from blockshake.solvers.nscd_deformable.elastic_bodies import Deformation
from blockshake.solvers.nscd_deformable.solve.newton import Factor


def pack(progress, deformation, contacts, joints, factor, record):
    """Tuples of arrays by name."""
    return {**rigid.pack(progress, contacts, joints, record), "deformation": deformation, "factor": factor}


def unpack(arrays):
    """Parts of a run."""
    progress, contacts, joints, record = rigid.unpack(arrays)
    return (
        progress,
        Deformation(*arrays["deformation"]),
        contacts,
        joints,
        Factor(*arrays["factor"]),
        record,
    )
