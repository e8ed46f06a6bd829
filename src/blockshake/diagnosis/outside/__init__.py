"""Forces from outside that are no effect of the registry, in the form in which they act: a file each."""
