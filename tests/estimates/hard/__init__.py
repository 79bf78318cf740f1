"""Hard cases, each with the outcome it must have.

`cases` (what must come of which), attempted by `contacts`, `bodies` and `spheres` with `measured` errors; `run`,
`table`. `make hard` is ``__main__``, and `test_hard` the same among the tests.
"""
