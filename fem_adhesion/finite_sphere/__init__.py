"""Is the half-space good enough for a sphere? The command ``finite-sphere``.

Computation: `cases`, `study`, its `table` of the causes in ``data/causes.csv`` with what the body yields (`bulk`), the
leading terms (`fit`), deviations and materials over the `plane`. What is seen: the `chart`, `figures`, captions with
them, and `page`, whose words are ``data/texts.toml``. And `command`.
"""
