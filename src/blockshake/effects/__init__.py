"""Effects that a model may miss: each in a file of its own, acting on what a solver and the sensors are given."""
