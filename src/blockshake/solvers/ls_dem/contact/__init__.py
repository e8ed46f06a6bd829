"""Contact of level sets: candidates, penetration, forces."""
