"""Load-approach curves to look at and to keep. The command ``curve``.

`solve`; `lines` and `scales`, of which everything is drawn; `figure` with its panels `load`, `profiles` and `mesh`;
`terminal`; `record`; `still` and `movie`; `command`.
"""
