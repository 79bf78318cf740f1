"""Is the half-space good enough for a sphere? The command ``finite-sphere``.

Computation: `cases`, `study`, its `table` of the causes in ``data/causes.csv`` with what the body yields (`bulk`), the
leading terms (`fit`). What is seen: the `chart` of deviations and materials, `figures`, captions with them, and `page`,
whose words are ``data/texts.toml``. And `command`.
"""
