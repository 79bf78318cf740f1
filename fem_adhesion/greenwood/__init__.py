"""Greenwood (1997), computed again: figures, tables, page, and the command `greenwood`."""
