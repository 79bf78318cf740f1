"""Is the half-space good enough for a sphere? Cases, chart, fits, page, and the command `finite-sphere`."""
