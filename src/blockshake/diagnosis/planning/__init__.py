"""A plan of tests: what motions and sensors would tell, from simulated nominal tests and their rows alone."""
