"""An extended study: what a cause that measured tests speak for changes, in the units of whoever decides."""
