"""Effects that only the sensors have: the blocks move as the model says."""
