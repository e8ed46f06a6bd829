"""Where a motion comes from, in words."""


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
