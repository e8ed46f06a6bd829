"""Status codes that both time loops return, and the entries that both clocks share."""

from blockshake.dynamics.system import Status

COMPLETED, COLLAPSED, DIVERGED, PAUSED = 0, 1, 2, 3
STATUS = {COMPLETED: Status.COMPLETED, COLLAPSED: Status.COLLAPSED, DIVERGED: Status.DIVERGED}
# First entries of a solver's ``clock``: next step (so the number of steps made), and next record
STEP, NEXT_RECORD = 0, 1
# m/s; nothing that falls or shakes comes near it: a faster body means that the run has diverged
SPEED_LIMIT = 1e3
