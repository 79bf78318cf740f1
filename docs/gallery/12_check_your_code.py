"""
Check your own code
===================

You have written a code for adhesive contact. Solve one of our problems with it, put the numbers into a CSV file,
and the command says how far each is off and what is most likely wrong: a domain too small, a grid too coarse, a
factor of two.

Sheets of problems come from ``fem-adhesion benchmark --problems sheets``. Here a code that took 2γ for γ is graded.
"""

import tempfile
from pathlib import Path

import halfspace
from fem_adhesion import cli

wrong = halfspace.trace(1.0 * 0.5 ** (2 / 3))  # half the work of adhesion: another Tabor parameter, half the load
with tempfile.TemporaryDirectory() as folder:
    file = Path(folder) / "their.csv"
    rows = [f"pull_off_load,{wrong.event('pull_off').load / 2:.5f}"]
    for name in ("pull_off", "zero_load"):
        rows += [f"{name}_approach,{wrong.event(name).approach:.5f}"]
        rows += [f"{name}_contact_radius,{wrong.event(name).contact_radius / 2 ** (1 / 3):.5f}"]
    file.write_text("problem,quantity,value\n" + "".join(f"half-space-1,{row}\n" for row in rows))
    code = cli.main(["benchmark", str(file), "--plot", "their.png"])
print("exit code:", code)
