"""Which sources make which result: what a workflow rule watches so that an edit reruns what it touches."""

_ROOT = ("errors.py", "files.py", "validation.py")
_COMMON = (*_ROOT, "geometry", "dynamics")
_SOLVERS = {"ls-dem": "solvers/ls_dem", "nscd-rigid": "solvers/nscd"}
_BOTH_SOLVERS = ("solvers/__init__.py", "solvers/record.py", "solvers/checkpoint.py")
_STATISTICS = (
    *_ROOT,
    "study/ensemble.py",
    "study/envelope.py",
    "study/intervals.py",
    "study/distributions.py",
)

KERNELS = (*_COMMON, "solvers", "measurement/kalman.py", "study/correlation_control.py")
"""All that holds kernels: the rest may change without compiling anew."""

MOTION = _COMMON
DESIGN = (
    *_ROOT,
    "study/distributions.py",
    "study/sampling.py",
    "study/correlation_control.py",
    "study/correlation_target.py",
)
STIFFNESS = (
    *_COMMON,
    *DESIGN,
    *_BOTH_SOLVERS,
    _SOLVERS["ls-dem"],
    "study/stiffness.py",
    "study/wave_step.py",
    "study/sample_parameters.py",
)
ENVELOPE = _STATISTICS
COMPARISON = (
    "geometry",
    "dynamics",
    "measurement",
    *_STATISTICS,
    "study/coverage.py",
    "study/compared_curves.py",
)
SENSITIVITY = (
    *_STATISTICS,
    *_COMMON,
    "study/sensitivity.py",
    "study/sensitivity_histories.py",
    "study/sensitivity_measures.py",
    "study/sample_parameters.py",
    *DESIGN,
)
REPORT = (
    *_STATISTICS,
    *DESIGN,
    "geometry",
    "dynamics",
    "measurement",
    "study/convergence_table.py",
    "report",
)


def kernel_sources(model):
    """Sources of the kernels of one model."""
    return (*_COMMON, *_BOTH_SOLVERS, _SOLVERS[model])


def run_sources(model):
    """Sources that make a run of one model."""
    return (*kernel_sources(model), "measurement", "study/simulation.py")


def batch_sources(model):
    """Sources that make a batch of samples of one model."""
    return (*run_sources(model), *DESIGN, "study/batch.py", "study/ensemble.py", "study/sample_parameters.py")


LADDER = (
    *run_sources("ls-dem"),
    *DESIGN,
    "solvers/nscd",
    "study/ladder.py",
    "study/config.py",
    "study/friction_settings.py",
    "study/convergence_settings.py",
)
CONVERGENCE = (
    *run_sources("ls-dem"),
    "solvers/nscd",
    "study/convergence.py",
    "study/convergence_runs.py",
    "study/convergence_settings.py",
    "study/convergence_table.py",
)
DEFINITIONS = (*run_sources("ls-dem"), *STIFFNESS, "solvers/nscd", "study/stiffness_definitions.py")
VIRTUAL_CAMPAIGN = (
    *run_sources("ls-dem"),
    *run_sources("nscd-rigid"),
    *STIFFNESS,
    "effects",
    "virtual",
    "study/ensemble.py",
    "study/placement.py",
)


def friction_sources(model):
    """Sources of the friction calibration by one model; LS-DEM's stiffness is imported in any case."""
    return (
        *batch_sources(model),
        *COMPARISON,
        *STIFFNESS,
        "study/friction_search.py",
        "study/friction_settings.py",
        "study/replicates.py",
        "study/friction_calibration.py",
        "study/scores.py",
    )


_READ_OFF = (
    *_COMMON,
    "effects",
    "measurement",
    "study/distributions.py",
    "study/placement.py",
    "study/ensemble.py",
    "study/compared_curves.py",
    *(
        f"diagnosis/{name}.py"
        for name in (
            "body_frame",
            "body_poses",
            "candidates",
            "coloured_regression",
            "excursions",
            "feature_table",
            "features",
            "joint_features",
            "joint_histories",
            "library",
            "null_model",
            "outliers",
            "phases",
            "planned_test",
            "reading",
            "reconstructed_base",
            "top_motion",
        )
    ),
)
LIBRARY = (*_READ_OFF, *run_sources("ls-dem"), *run_sources("nscd-rigid"))
"""What simulates tests for a diagnosis and reads them off."""

CALIBRATION = (
    *LIBRARY,
    *(
        f"diagnosis/{name}.py"
        for name in (
            "calibration",
            "candidate_scores",
            "constancy",
            "feature_scales",
            "library_scores",
            "model_evidence",
            "response",
            "tamed_features",
        )
    ),
)
"""What scores the draws of libraries against each other."""

DIAGNOSIS = (
    *LIBRARY,
    *_STATISTICS,
    "study/coverage.py",
    "study/scores.py",
    "diagnosis",
)
"""What judges them: all that is above the solvers in a diagnosis."""
