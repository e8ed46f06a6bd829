"""Where a motion comes from, in words and as attributes of a file."""


def plain_attribute(value):
    """Attribute as netCDF can hold it: truth values as 0 and 1, all else that is no number as text."""
    if isinstance(value, bool):
        return int(value)
    return value if isinstance(value, (str, float, int)) else str(value)


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
