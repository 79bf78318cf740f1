"""The contact problem and its curve: equations, Newton's method, the path, its events, states and devices."""
