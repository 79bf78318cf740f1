"""Events, energies and losses over many Tabor parameters, as one table. The command ``sweep``.

`study` (in parallel, each curve kept as soon as it is there, and the table), `command`.
"""
