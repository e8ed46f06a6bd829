"""How a run ended: fallen, still falling or standing, and the sentence that says so."""
