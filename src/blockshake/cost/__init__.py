"""How long a study or a diagnosis takes on this machine, from short trials of its simulations."""
