"""Where a motion comes from, in words and as attributes of a file."""


def provenance(attributes):
    """One line for reports and checks: source and format of a motion, assumptions, and the treatment of its baseline.

    Parameters
    ----------
    attributes : dict
        Of a `GroundMotion`; ``source`` alone is needed.
    """
    words = attributes["source"]
    if attributes.get("format", "synthetic") != "synthetic":
        words += f" ({attributes['format']})"
    if attributes.get("assumed"):
        words += f"; assumed: {attributes['assumed']}"
    return words + (f"; baseline: {attributes['baseline']}" if "baseline" in attributes else "")


def plain_attributes(attributes):
    """Attributes as netCDF can hold them: truth values as 0 and 1, all else that is no number as text."""
    plain = {name: int(value) if isinstance(value, bool) else value for name, value in attributes.items()}
    return {name: value if isinstance(value, (float, int)) else str(value) for name, value in plain.items()}
