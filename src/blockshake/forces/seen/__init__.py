"""A test as its sensors show it: states of the faces, and rows of its equations without any force of a joint."""
