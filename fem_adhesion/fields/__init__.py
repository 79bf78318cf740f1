"""What goes on inside the bodies at a state of a curve."""
