"""Load-approach curves: solved, listed, drawn, filmed, and the command `curve`."""
