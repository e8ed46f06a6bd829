"""The bench's results as text."""

import force_evaluation
import nscd_step
import simulated_second
import still_stack
import walls


def as_text(result):
    """Table of all parts that were measured."""
    machine, versions = result["machine"], result["versions"]
    lines = [
        f"{machine['processor']} ({machine['instruction_set']}), {machine['cores']} cores, "
        f"{machine['clock_ghz']['median']:.2f} GHz at work",
        ", ".join(f"{name.replace('_', ' ')} {value}" for name, value in versions.items()),
    ]
    for part, write in PARTS.items():
        if part in result:
            lines += ["", *write(result[part])]
    return "\n".join(lines) + "\n"


def _range(values, digits):
    """Median with its quartiles."""
    median, low, high = (values[key] for key in ("median", "lower_quartile", "upper_quartile"))
    return f"{median:.{digits}f} ({low:.{digits}f} to {high:.{digits}f})"


def _force_evaluation(result):
    yield "Cost of a node evaluation [ns], all contact work of a three-block stack over its listed nodes"
    yield f"  {'level set':<16}{'median (quartiles)':<26}{'target':<15}{'node alone':<12}{'pair':<8}nodes, pairs"
    for name, cost in result.items():
        target = _beside(cost["ns_per_node"]["median"], force_evaluation.TARGET_NS[name])
        yield (
            f"  {name:<16}{_range(cost['ns_per_node'], 2):<26}{target:<15}"
            f"{cost['ns_per_node_alone']:<12.2f}{cost['ns_per_pair']:<8.0f}{cost['nodes']}, {cost['pairs']}"
        )


def _arithmetic(result):
    peak = result["peak_gflops"]
    yield "Share of the core's peak, exact distance"
    loops = result["loops"]
    operations = ", ".join(f"{loop['operations_per_node']:.0f}" for loop in loops)
    yield (
        f"  loops of {operations} operations a node, at least "
        f"{100 * min(loop['packed_share'] for loop in loops):.0f} % packed, "
        f"{min(loop['vector_bits'] for loop in loops)} bits"
        f"{', some with gathers' if any(loop['gathers'] for loop in loops) else ''}"
    )
    yield (
        f"  peak {peak['fused']['median']:.1f} Gflop/s fused, {peak['separate']['median']:.1f} separate; "
        f"reached {result['reached_gflops']:.1f}: {100 * result['share_of_peak']:.0f} % of the peak"
    )


def _simulated_second(result):
    yield "CPU seconds per simulated second, 1 Hz, 1.5 m/s2"
    steps = next(iter(result.values()))
    yield f"  {'':<18}" + "".join(f"{step:<28}" for step in steps) + f"target at {next(iter(steps))}"
    for name, costs in result.items():
        cells = "".join(f"{_range(cost, 3):<28}" for cost in costs.values())
        first = next(iter(costs.values()))["median"]
        yield f"  {name:<18}{cells}{_beside(first, simulated_second.TARGETS[name])}"


def _walls(result):
    yield "Bonded walls: cost of a step for a block, dt 1e-5 s"
    yield f"  {'blocks':<8}{'us a step and block':<26}{'joints a block':<16}{'us a step and joint':<21}MiB"
    for wall in result["sizes"]:
        joints = wall["joints"] / wall["blocks"]
        cost = wall["us_per_step_and_block"]
        yield (
            f"  {wall['blocks']:<8}{_range(cost, 3):<26}{joints:<16.2f}{cost['median'] / joints:<21.3f}"
            f"{wall['peak_memory_mib']:.0f}"
        )
    for unit in ("block", "joint"):
        yield f"  by {unit}: {_growth(result[f'spread_by_{unit}'])}"
    yield (
        f"  a step grows as blocks^{result['exponent']:.2f}; "
        f"memory {result['memory_kib_per_block']:.0f} KiB a block"
    )


def _nscd_step(result):
    yield "Nonsmooth contact dynamics: CPU us of a step of 1 ms, 1 Hz, 1.5 m/s2"
    yield f"  {'':<35}{'median (quartiles)':<28}{'iterations':<12}{'capped':<9}worst residual"
    for name, cost in result.items():
        target = nscd_step.TARGETS_US.get(name)
        told = f"      target {_beside(cost['us_per_step']['median'], target)}" if target else ""
        yield f"  {name:<35}{_solved(cost, 1)}{told}"


def _nscd_walls(result):
    yield "Nonsmooth contact dynamics: bonded walls, CPU us of a step of 1 ms"
    yield (
        f"  {'blocks':<8}{'us a block':<12}{'median (quartiles)':<28}{'iterations':<12}{'capped':<9}"
        f"{'worst residual':<17}MiB"
    )
    for wall in result["sizes"]:
        each = wall["us_per_step"]["median"] / wall["blocks"]
        yield f"  {wall['blocks']:<8}{each:<12.2f}{_solved(wall, 0)}{'':<12}{wall['peak_memory_mib']:.0f}"
    yield f"  by block: {_growth(result['spread_by_block'])}"
    yield f"  a step grows as blocks^{result['exponent']:.2f}"


def _still_stack(result):
    yield f"At rest for {still_stack.DURATION:g} s: largest drift and sinking [um], and rotation [urad], of any block"
    yield f"  of {'; '.join(result)}"
    yield f"  {'':<20}{'drift':<12}{'sink':<12}rotation"
    for program in next(iter(result.values())):
        found = [programs[program] for programs in result.values()]
        measured = [tuple(one.values()) for one in found if isinstance(one, dict)]
        told = (
            "".join(f"{1e6 * max(0.0, *values):<12.2g}" for values in zip(*measured, strict=True))
            if len(measured) == len(found)
            else next(one for one in found if not isinstance(one, dict))
        )
        yield f"  {program:<20}{told}".rstrip()


def _beside(value, target):
    """A target, and whether the value is at most as large."""
    return f"{target:g}, {'met' if value <= target else 'missed'}"


def _growth(spread):
    """Dearest over cheapest size in words, held against the target."""
    verdict = "linear" if spread <= walls.LINEAR_WITHIN else "not linear"
    return f"dearest size {100 * spread:.0f} % above the cheapest, {verdict} within {100 * walls.LINEAR_WITHIN:.0f} %"


def _solved(cost, digits):
    """Time of a step and how it was solved."""
    return (
        f"{_range(cost['us_per_step'], digits):<28}{cost['iterations']:<12.1f}"
        f"{100 * cost['capped']:>4.0f} %   {cost['max_residual']:.0e}"
    )


PARTS = {
    "force_evaluation": _force_evaluation,
    "arithmetic": _arithmetic,
    "simulated_second": _simulated_second,
    "walls": _walls,
    "nscd_step": _nscd_step,
    "nscd_walls": _nscd_walls,
    "still_stack": _still_stack,
}
