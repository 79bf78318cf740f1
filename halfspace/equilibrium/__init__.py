"""The contact problem and its curve, whatever operator it stands on.

In the order of reading: `contact` (gap, residual, tangent, load), `newton` (bordered Newton for any control), `path`
(pseudo-arclength through the folds), `events` (pull-off, jumps, zero load: each solved for), `curve` (the result),
`states` (any other state of it, with errors), `devices` (jumps on a spring, cycles of two and more), `reach` (how far
grids must go), `relaxation` (the iterations of 1997, as baselines).
"""
