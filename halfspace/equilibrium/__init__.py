"""The contact problem and its curve, whatever operator it stands on.

In the order of reading: `contact` (gap, residual, tangent, load), `acting` (what acts in a state of it), `newton`
(bordered Newton for any control), `path` (pseudo-arclength through the folds), `conditions` (folds, extrema, given
values: the states that meet them), `charts` (grids for its stretches, from one to the next), `search` (which events a
curve has), `events` (pull-off, jumps, zero load as numbers with errors), `states` (any other state, with errors),
`curve` (the result), `devices` (jumps on a spring, cycles of two and more, how far grids must go).
"""
