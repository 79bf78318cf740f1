"""How often the intervals at 95 % of a fitted curve hold the truth, over synthetic curves.

Tabor parameters 0.1 to 5, springs of 0.01 to 1 R dgamma/eps, noise of 0.2, 0.5 and 2 % of the pull-off force with a
correlation of 0.3, offset, drift, a sensitivity that is off by up to 20 % and free. A line for each curve, then the
shares, with what is to be expected of the binomial law.
"""

import json
import math
import time

import numpy as np
from synthetic_curves import synthetic

from fem_adhesion.common.numbers import Measured
from fem_adhesion.fitting.model import Apparatus
from fem_adhesion.fitting.study import fit

RADIUS, WORK, SPACING, POISSON = 50e-9, 0.05, 0.3e-9, 0.3
NOISES = (0.002, 0.005, 0.02)
NAMES = ("work_of_adhesion", "spacing", "sensitivity")


def one(seed):
    """What the fit of a curve says, beside its truth."""
    rng = np.random.default_rng(seed)
    tabor, stiffness = np.exp(rng.uniform(np.log([0.1, 0.01]), np.log([5.0, 1.0]))).tolist()
    modulus = math.sqrt(RADIUS * WORK**2 / (tabor * SPACING) ** 3) * (1 - POISSON**2)
    size = 2 * np.pi * RADIUS * WORK
    sensitivity = rng.uniform(0.8, 1.2)
    spring = stiffness * RADIUS * WORK / SPACING
    truth = Apparatus(RADIUS, modulus, WORK, SPACING, 2e-7, spring, sensitivity, poisson=POISSON)
    offset, drift = 0.05 * size * rng.normal(size=2)
    noise = NOISES[seed % len(NOISES)] * size
    curve = synthetic(truth, rng, noise=noise, correlation=0.3, offset=offset, drift=drift)
    given = {"radius": RADIUS, "modulus": modulus, "poisson": POISSON, "stiffness": truth.stiffness}
    begin = time.process_time()
    found = fit(curve, **given, sensitivity=Measured(1.0, math.inf), models=())
    seconds = time.process_time() - begin
    held, widths = {}, {}
    for name in NAMES:
        value, true = found.values[name], getattr(truth, name)
        held[name] = (value.low is None or value.low <= true) and (value.high is None or true <= value.high)
        widths[name] = [end and end / true for end in (value.low, value.high)]
    told = {"tabor": tabor, "stiffness": stiffness, "noise": NOISES[seed % len(NOISES)], "misfit": found.misfit}
    return {"seed": seed, **told, "cpu": round(seconds, 2), "held": held, "ends": widths}


def judge(count):
    """Fit so many curves; 1 if fewer intervals than chance explains hold the truth."""
    rows, poor = [], 0
    spread = math.sqrt(0.95 * 0.05 / count)
    for seed in range(count):
        rows.append(one(seed))
        print(json.dumps(rows[-1], default=float), flush=True)
    for name in NAMES:
        share = np.mean([row["held"][name] for row in rows])
        print(f"{name}: {100 * share:.1f} % of {count} hold the truth, expected 95 +- {100 * spread:.1f}")
        poor |= share < 0.95 - 3 * spread
    misfits, seconds = (float(np.mean([row[name] for row in rows])) for name in ("misfit", "cpu"))
    print(f"misfit: {100 * misfits:.1f} %; CPU {seconds:.2f} s a curve")
    return int(poor)
