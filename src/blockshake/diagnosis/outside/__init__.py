"""Forces from outside that are no effect of the registry, in the form in which they act: a file each.

Every search is given a `Likelihood` and `Points`, or `JointRows` by test with a place; ``weight`` is that of the block
[N]. Its `Explanation` is averaged over all that it tries.
"""
