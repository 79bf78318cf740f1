"""To the accuracy asked for, with the error that is left.

In the order of reading: `trace` (the half-space, from a tolerance to a curve), `refinement` (the ladder of ever finer
stages, and what two of them say of the error), `finite_bodies` (the same for bodies with a length, whose operator
changes with the contact), `fold_birth` (the Tabor parameter at which a pair of folds is born).
"""
