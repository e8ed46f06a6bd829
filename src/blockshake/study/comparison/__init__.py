"""Models held against each other, against the floor of the numerics of each."""
