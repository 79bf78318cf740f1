"""Greenwood (1997), computed again. The command ``greenwood``.

`study` computes what the settings in `facts` ask for, with `tables`, where the criteria stand too, and `numerics_1997`;
`facts` holds what it found. The claims of the paper stand in ``data/claims.csv``, each with the expression that tests
it: `measures` has its words, `claims` the rule that decides. The figures stand in ``data/figures.toml``: `figures`
makes their lines, `drawing` draws these and writes them as CSV. All is shown on `page`, whose words are
``data/texts.toml``. And `command`.
"""
