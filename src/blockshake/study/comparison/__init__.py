"""Models held against each other, beside the floor of the numerics of each."""
