"""The parts of an NSCD run as arrays, to be saved and read back."""

from blockshake.dynamics.system import State
from blockshake.solvers.nscd.contact.contacts import Contacts
from blockshake.solvers.nscd.joints import Joints
from blockshake.solvers.nscd.progress import Progress
from blockshake.solvers.record import Record


def pack(progress, contacts, joints, record):
    """Tuples of arrays by name."""
    return {
        "state": progress.state,
        "progress": progress[1:],
        "contacts": contacts,
        "joints": joints,
        "record": record,
    }


def unpack(arrays):
    """Parts of a run."""
    return (
        Progress(State(*arrays["state"]), *arrays["progress"]),
        Contacts(*arrays["contacts"]),
        Joints(*arrays["joints"]),
        Record(*arrays["record"]),
    )
