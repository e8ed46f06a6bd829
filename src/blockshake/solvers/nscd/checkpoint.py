"""What an NSCD run leaves on disk to go on from."""

from blockshake.dynamics.system import State
from blockshake.solvers.checkpoint import load_parts, save_parts
from blockshake.solvers.nscd.contacts import Contacts
from blockshake.solvers.nscd.joints import Joints
from blockshake.solvers.nscd.progress import Progress
from blockshake.solvers.record import Record


def save_checkpoint(path, key, progress, contacts, joints, record):
    """Write a run's state, in place of an earlier one only when it is whole."""
    parts = {
        "state": progress.state,
        "progress": progress[1:],
        "contacts": contacts,
        "joints": joints,
        "record": record,
    }
    save_parts(path, key, parts)


def load_checkpoint(path, key):
    """State of this very run, or None where there is none that can be read."""
    parts = load_parts(path, key)
    if parts is None:
        return None
    return (
        Progress(State(*parts["state"]), *parts["progress"]),
        Contacts(*parts["contacts"]),
        Joints(*parts["joints"]),
        Record(*parts["record"]),
    )
