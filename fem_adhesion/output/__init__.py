"""Output: the leaves that draw and write files."""
