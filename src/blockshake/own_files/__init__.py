"""How own data come in: commands, templates to start from, and schemas for editors."""
