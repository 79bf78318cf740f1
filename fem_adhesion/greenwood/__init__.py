"""Greenwood (1997), computed again. The command ``greenwood``.

`settings` say what is computed, `study` computes it with `tables`, `criteria` and `numerics_1997`. The claims of the
paper stand in ``data/claims.csv``, each with the expression that tests it: `measures` has its words, `facts` what they
are measured on, `claims` the rule that decides. The figures stand in ``data/figures.toml``: `figures` makes their
lines, `drawing` draws these and writes them as CSV. All is shown on `page`, whose words are ``data/texts.toml``. And
`command`.
"""
