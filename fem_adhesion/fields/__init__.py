"""What goes on inside the bodies at a state of a curve: `discretise`, `state`, and `beside`, the half-space's own."""
