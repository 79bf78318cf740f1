"""Hard cases, each with the outcome it must have."""
