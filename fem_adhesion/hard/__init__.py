"""Hard cases, each with the outcome it must have, and the command `hard`."""
