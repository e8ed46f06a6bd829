"""Which sources make which result: what a workflow rule watches so that an edit reruns what it touches."""

_COMMON = ("errors.py", "files.py", "jit.py", "geometry", "dynamics")
_SOLVERS = {"ls-dem": "solvers/ls_dem", "nscd-rigid": "solvers/nscd"}
_RUN = ("measurement/markers.py", "measurement/accelerometers.py", "study/simulation.py")

MOTION = (*_COMMON,)
DESIGN = ("errors.py", "files.py", "study/distributions.py", "study/sampling.py", "study/correlation_control.py",
          "study/correlation_target.py")  # fmt: skip
STIFFNESS = (*_COMMON, "solvers/ls_dem", "study/stiffness.py")
ENVELOPE = ("errors.py", "files.py", "study/ensemble.py", "study/envelope.py", "study/distributions.py")
COMPARISON = (*ENVELOPE, "study/coverage.py", "measurement/campaign.py", "measurement/virtual_test.py")
REPORT = (*ENVELOPE, "geometry", "report")
KERNELS = ("jit.py", "geometry", "dynamics", "solvers", "measurement", "study")
"""Every floor that holds kernels: the report, which has none, may change without compiling anew."""


def run_sources(model):
    """Sources that make a run of one model."""
    return (*_COMMON, _SOLVERS[model], *_RUN)


def batch_sources(model):
    """Sources that make a batch of samples of one model."""
    return (*run_sources(model), "study/batch.py", "study/ensemble.py", "study/distributions.py")
