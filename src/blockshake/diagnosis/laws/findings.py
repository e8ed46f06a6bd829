"""Which laws a campaign breaks, and which effects break just these."""

from blockshake.validation import Strict


class LawFinding(Strict):
    """One law over all open tests.

    Attributes
    ----------
    name, unit : str
    joint : str
        Name of the joint, empty for a law of the whole test.
    beneath : bool
        Whether the joint carries all free bodies.
    value, error : float
        Mean departure from the nominal model over the tests that tell it, and its standard error, on the law's scale.
    measured, errors : dict of str to float
        By test: the value that was read and its standard error, in its unit.
    expected, spreads : dict of str to float
        By test: mean and standard deviation of nominal draws, on the law's scale, as of `tamed`.
    departures : dict of str to float
        By test: departure in standard deviations.
    together : float
        Sum of the departures in its own standard deviation, with what the tests share.
    broken : bool
    """

    name: str
    unit: str
    joint: str = ""
    beneath: bool = False
    value: float
    error: float
    measured: dict[str, float]
    errors: dict[str, float]
    expected: dict[str, float]
    spreads: dict[str, float]
    departures: dict[str, float]
    together: float
    broken: bool


class OutsideForce(Strict):
    """A force from outside that accounts for the broken laws.

    Attributes
    ----------
    bodies : tuple of str
        Blocks on any of which it may act, as a force along x; the best first.
    height : float
        Of its line above the mass centre of that block: at the centre or at the top [m].
    law : str
        ``steady`` throughout, ``constant`` from an instant on, ``pulse``, ``spring``, ``damper`` or ``proportional``.
    scores : dict of str to float
        By law: information criterion less that of the best, summed over tests.
    amplitude, lower, upper : float
        Of the law on the first body, with an interval of 90 % over the tests [N, N/m, N s/m].
    unit : str
    tests : dict of str to dict of str to float
        By test that shows it: ``start`` and ``end`` [s], and a spring's ``gap`` [m] and ``side``, with ``other_gap``
        and ``other_amplitude`` [N/m] of a second spring on the other side.
    """

    bodies: tuple[str, ...]
    height: float = 0.0
    law: str
    scores: dict[str, float]
    amplitude: float
    lower: float
    upper: float
    unit: str
    tests: dict[str, dict[str, float]]


class LawFindings(Strict):
    """Laws of a campaign.

    Attributes
    ----------
    laws : tuple of LawFinding
        By falling departure.
    isolated : tuple of str
        Effects whose own law is broken and that account for all others that are.
    outside : OutsideForce or None
        Where no effect of the registry accounts for the broken laws and a force from outside does.
    outside_of_stop : OutsideForce or None
        Force of the stop, where a contact with a stop is isolated.
    readable : tuple of str
        Laws that have a null distribution in some test, whether a measured test tells them or not.
    shown : tuple of LawFinding
        Laws that are told beside the draws and not judged, see `Law.judged`.
    shares : dict of str to float
        By free body: its share of the weight of all of them [1].
    p : float
        Chance of departures as large as the largest by the nominal model, at most: their number times the chance of one
        (Bonferroni) [1].
    """

    laws: tuple[LawFinding, ...]
    isolated: tuple[str, ...]
    outside: OutsideForce | None
    outside_of_stop: OutsideForce | None = None
    readable: tuple[str, ...] = ()
    shown: tuple[LawFinding, ...] = ()
    shares: dict[str, float]
    p: float

    @property
    def broken(self):
        """Laws that are broken."""
        return tuple(one for one in self.laws if one.broken)
