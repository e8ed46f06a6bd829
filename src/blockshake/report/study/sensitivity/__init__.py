"""The section on sensitivities."""
