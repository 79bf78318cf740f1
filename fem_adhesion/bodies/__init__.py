"""Bodies with a length of their own, as elastic operators for the contact problem.

`sized` (hemisphere and held sphere, in their grips), `pair` (two of them against each other), `user_mesh` (from a
file).
"""
