"""Is the half-space good enough for a sphere? The command ``finite-sphere``.

Computation: `cases`, `records`, `study`; of its `table`, the `points`, what the body yields (`bulk`), the leading terms
(`fit`), the `chart` and `materials` on it. What is seen: `chart_figure`, `cause_figure` and `dependence_figures`, each
figure with its caption, `findings` and `page`. And `command`.
"""
