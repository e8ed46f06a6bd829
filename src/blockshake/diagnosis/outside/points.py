"""Points at which forces from outside are tried: two heights of every free body."""

from dataclasses import dataclass

from blockshake.forces.seen.point_rows import point_rows

_HEIGHTS = (0.0, 0.42)  # above the mass centre, over the block's height


@dataclass(frozen=True)
class Points:
    """A point of one body in all tests.

    Attributes
    ----------
    place : str
        Body, and height above its centre over its own height.
    body : int
    by_test : list of PointRows
    tests : list of str
    """

    place: str
    body: int
    by_test: list
    tests: list


def force_points(tests):
    """`Points` of all free bodies on which a force makes rows."""
    seen = tests[0].seen
    found = []
    for body in seen.free:
        name = seen.structure.body_names[body]
        for height in _HEIGHTS:
            rows = [point_rows(test.seen, name, height) for test in tests]
            if any(one.unit.any() for one in rows):
                found.append(
                    Points(f"{name}@{height:g}", int(body), rows, [test.seen.name for test in tests])
                )
    return found
