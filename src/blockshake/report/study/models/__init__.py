"""The section that holds the models against each other."""
