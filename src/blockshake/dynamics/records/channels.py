"""The channels of a record's file that become the axes of a motion."""

from blockshake.dynamics.motion import CHANNELS
from blockshake.errors import InputError


def chosen_records(records, channels, where):
    """Records by axis.

    Parameters
    ----------
    records : list of Record
        Of one file.
    channels : dict of str to str, or None
        By axis (``x``, ``y``, ``z``) the name of a channel, or its number in the file, from 1; None takes the only one
        as x.
    where : str
        File that a message names.

    Raises
    ------
    InputError
        Another axis, no such channel, a channel twice, several where none is named, or channels of different steps or
        lengths.
    """
    if channels is None and len(records) == 1:
        return {"x": records[0]}
    listed = "; ".join(f"{number}: {one.channel or 'no name'}" for number, one in enumerate(records, start=1))
    chosen = {}
    for axis, name in (channels or {"x": ""}).items():
        if axis not in CHANNELS[:3]:
            raise InputError("--column", axis, f"expected {', '.join(CHANNELS[:3])}")
        named = [
            one
            for number, one in enumerate(records, start=1)
            if name.strip().lower() in (str(number), one.channel.lower() or None)
        ]
        if len(named) != 1:
            raise InputError(
                where, f"channel '{name}'" if name else "",
                f"expected one of the {len(records)} acceleration channels ({listed}), which "
                "`blockshake convert-motion --column x=NUMBER` chooses",
            )  # fmt: skip
        if any(named[0] is other for other in chosen.values()):
            raise InputError("--column", f"{axis}={name}", "expected every channel for one axis")
        chosen[axis] = named[0]
    first = next(iter(chosen.values()))
    for one in chosen.values():
        if (one.time_step, len(one.acceleration)) != (first.time_step, len(first.acceleration)):
            raise InputError(where, "", f"expected channels of the same time step and length ({listed})")
    return chosen
