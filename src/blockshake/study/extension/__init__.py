"""An extended study: what a cause that measured tests support changes, in the units of whoever decides."""
