"""The kinds of campaigns, a row a kind, with the functions by which a check, a diagnosis and a report treat it.

A function is imported when it is called, so that a rule watches just those of its own step (`blockshake.sources`), and
that diagnosis of free flight is a package of its own.
"""

import pkgutil
from collections.abc import Callable
from typing import NamedTuple

from blockshake.errors import InputError


class Late(NamedTuple):
    """A function of a campaign, imported when it is called.

    Raises
    ------
    InputError
        The package of the function is not installed.
    """

    module: str
    name: str

    def __call__(self, campaign, *arguments):
        """Result for a `Campaign`; further arguments are those of the column of `CampaignKind`."""
        try:
            function = pkgutil.resolve_name(f"{self.module}:{self.name}")
        except ModuleNotFoundError as error:
            package = self.module.partition(".")[0]
            if error.name != package:
                raise
            wrong = f"expected a motion of the base in each test; without one the package {package} is needed"
            raise InputError(campaign.folder / "campaign.yaml", "tests", wrong) from None
        return function(campaign, *arguments)


class CampaignKind(NamedTuple):
    """A kind of campaign."""

    holds: Callable  # of a `MeasuredTest`: whether it may be one of such a campaign; the first row that all fit counts
    check: Late  # of the campaign: lines of its content, and then of every inconsistency
    remark: Late  # of the campaign: lines and remarks of `blockshake check` that no other command prints
    decide: Late  # of the campaign, files and effects left out: decision, its evidence and, of sensors, the parity
    measure_gain: Late  # of the campaign, decision, effort and files: `CampaignGain` on the sealed tests
    compose: Late  # of the campaign, folder of results, effort and track record: `Document` of the report
    ensembles: (
        bool  # nominal models are simulated under the open tests, whose readings they are compared with
    )
    batches: bool  # outcomes of all tests are simulated first; the gain is then measured with no cause too


_FLIGHT = "blockshake_flight"
KINDS = (
    # no base motion: one body is filmed as poses over a ground at rest
    CampaignKind(
        holds=lambda test: test.motion is None,
        check=Late(f"{_FLIGHT}.tracked_check", "tracked_lines"),
        remark=Late(f"{_FLIGHT}.tracked_check", "remark"),
        decide=Late(f"{_FLIGHT}.decide", "decide"),
        measure_gain=Late(f"{_FLIGHT}.gain", "measure_gain"),
        compose=Late(f"{_FLIGHT}.section", "compose_flights"),
        ensembles=False,
        batches=False,
    ),
    # binary outcomes: whether the body fell is all that is known of a test
    CampaignKind(
        holds=lambda test: test.outcome is not None,
        check=Late("blockshake.measurement.checks.outcomes", "outcome_lines"),
        remark=Late("blockshake.own_files.check", "remark_outcomes"),
        decide=Late("blockshake.diagnosis.outcomes.decide", "decide"),
        measure_gain=Late("blockshake.diagnosis.outcomes.gain", "measure_gain"),
        compose=Late("blockshake.diagnosis.outcomes.section", "compose_outcomes"),
        ensembles=False,
        batches=True,
    ),
    # base motion, with readings of a stack
    CampaignKind(
        holds=lambda test: True,
        check=Late("blockshake.measurement.checks.campaign_check", "shaken_lines"),
        remark=Late("blockshake.own_files.check", "remark_shaken"),
        decide=Late("blockshake.diagnosis.steps", "decide_shaken"),
        measure_gain=Late("blockshake.diagnosis.steps", "measure_shaken_gain"),
        compose=Late("blockshake.diagnosis.report.report", "compose_shaken"),
        ensembles=True,
        batches=False,
    ),
)


def kind_of(tests):
    """`CampaignKind` of some `MeasuredTest`."""
    return next(kind for kind in KINDS if all(map(kind.holds, tests)))
