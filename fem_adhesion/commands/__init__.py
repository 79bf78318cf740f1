"""One module a command: its arguments, and the one study or output that it calls.

What computes is imported inside the functions, so that ``--help`` answers at once.
"""
