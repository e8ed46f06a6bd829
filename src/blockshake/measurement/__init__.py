"""What instruments see of a structure: markers, accelerometers, noise."""
