"""Laws, profiles and bodies that are hard together, each through `compare`, and others on layers drawn at random.

Long and short ranges, soft and hard cores, tips from nearly a cone to nearly a punch, layers from 0.05 to 100 beta.
"""

import time
from collections import Counter

from drawn_layers import drawn

from fem_adhesion import Coated, HalfSpace, Layer, Layers, Scene
from fem_adhesion.common.jobs import progress_bar, stream
from fem_adhesion.crosscheck import scenes as beside
from fem_adhesion.crosscheck.comparison import VERDICTS, Failure, verdict_of
from halfspace import Stratum
from halfspace.laws import Dlvo, Dugdale, Exponential, Morse, PowerLaw
from halfspace.profiles import Hyperboloid, Power, RoundedPunch, Sphere

RTOL = 1e-4
DRAWN = 12
RUBBER, SLIDING = HalfSpace(poisson=0.4999), Layer(0.5, "sliding")
PLIES = Stratum(2.3, 0.2), Stratum(0.9, 0.37, 0.5), Stratum(0.36, 0.47, 0.24)
SCENES = (
    Scene(1.0, law=PowerLaw(2.1, 2.5)),
    Scene(0.5, law=PowerLaw(20, 60)),
    Scene(5.0, law=Morse(0.3)),
    Scene(0.2, law=Morse(20)),
    Scene(1e-6, law=Morse(3)),
    Scene(0.05, law=Exponential(3)),
    Scene(3.0, law=Dlvo(-0.5, 0.3)),
    Scene(2.0, RUBBER, law=Dlvo(0.3, 1.0)),
    Scene(2.0, RUBBER, law=Morse(3)),
    Scene(1.0, profile=Power(1.5)),
    Scene(0.1, profile=Power(10)),
    Scene(3.0, profile=Power(3)),
    Scene(1.0, profile=Hyperboloid(1)),
    Scene(0.3, RUBBER, profile=Power(6)),
    Scene(1.0, law=PowerLaw(4, 10), profile=Power(10)),
    Scene(1.0, law=Dlvo(0.3, 1.0), profile=Power(4)),
    Scene(1.0, law=PowerLaw(3.5, 9.5), profile=Hyperboloid(0.3)),
    Scene(1.0, law=Exponential(0.5, 4), profile=Power(3)),
    Scene(1.0, law=Morse(3), profile=Power(1.5)),
    Scene(1.0, law=Morse(3), profile=Sphere(30)),
    Scene(2.0, law=PowerLaw(2.5, 9.5), profile=Sphere(10)),
    Scene(0.5, law=Exponential(3), profile=Sphere(3)),
    Scene(1.0, Layer(0.05)),
    Scene(1.0, Layer(2.0), law=Morse(3)),
    Scene(1.0, Layer(100.0), law=Dlvo(0.3, 1.0)),
    Scene(3.0, Layer(1.0, poisson=0.45), law=PowerLaw(4, 10)),
    Scene(1.0, SLIDING, profile=Power(1.5)),
    Scene(1.0, Layer(1.0, poisson=0.4999), profile=Power(4)),
    Scene(0.3, Layer(5.0, poisson=0.0), law=Exponential(3), profile=Power(3)),
    Scene(0.5, SLIDING, law=PowerLaw(2.5, 9.5), profile=Power(4)),
    # Of forty drawn at random, those that did not agree before
    Scene(3.5, Layers(PLIES, "sliding"), profile=RoundedPunch(0.6)),
    Scene(7.0, HalfSpace(poisson=0.45), profile=RoundedPunch(0.4)),
    Scene(9.6, HalfSpace(poisson=0.499), law=Morse(1.8)),
    Scene(7.0, Layer(0.9, "sliding", poisson=0.0), law=Morse(0.9), profile=Hyperboloid(0.7)),
    Scene(4.6, HalfSpace(poisson=0.0), law=Exponential(3.5, 12), profile=Hyperboloid(2.5)),
    Scene(1.0, Coated(thickness=1.0, modulus_ratio=5.0), profile=Hyperboloid(5.0)),
    Scene(1.7, Coated(3.6, 36.0, 0.45, poisson=0.0), profile=RoundedPunch(1.0), law=PowerLaw(4.1, 10.4)),
    Scene(0.97, Coated(72.6, 55.6, poisson=0.0), law=Dugdale(0.36)),
    Scene(0.377, Coated(1.45, 0.088, 0.0, poisson=0.4999), Sphere(755), law=Dlvo(0.16, 4.12)),
    Scene(0.562, Layer(3.76, "sliding", poisson=0.47), Hyperboloid(1.79), law=Dlvo(-0.03, 4.73)),
    Scene(1.53, Layer(0.0653, poisson=0.14), Power(5.31), law=Dugdale(0.338)),
    Scene(0.441, Coated(19.3, 0.461, 0.4999, poisson=0.4999), Hyperboloid(0.526), law=Dugdale(0.169)),
    Scene(0.898, Layer(0.199, poisson=0.42), RoundedPunch(0.246), law=Dlvo(0.05, 1.03)),
    Scene(0.531, Coated(0.0861, 0.0122, 0.4999, poisson=0.0), Power(2.37), law=Exponential(1.44, 8)),
    Scene(8.2, Layers([Stratum(1.86, 0.14), Stratum(3.5, 0.43, 0.443)], "sliding"), Hyperboloid(1.92), law=Morse(1.85)),
)


def verdict(scene):
    """Verdict of a comparison, and the rows that do not agree, or why it failed."""
    (case,) = beside.run([scene], rtol=RTOL)
    rows = [f"{row.quantity} {row.verdict}" for row in case.rows if row.verdict != "agree"]
    return verdict_of(case), ", ".join([*rows, *([case.reason] if isinstance(case, Failure) else [])])


def compared(seed):
    """Compare all scenes, and some drawn on layers, and print what does not agree.

    Of those chosen all must agree; of those drawn a comparison may be left open, but none may disagree or fail.
    """
    kinds = {
        "of law, profile and body": (SCENES, {"agree"}),
        "drawn on layers": (drawn(seed, DRAWN), {"agree", "inconclusive"}),
    }
    held = [_compared(kind, *of_kind) for kind, of_kind in kinds.items()]
    return all(held)


def _compared(kind, scenes, allowed):
    began, found = time.perf_counter(), Counter()
    with progress_bar() as told:
        for k, (scene, (one, why)) in enumerate(stream(verdict, scenes), start=1):
            told("combinations", k, len(scenes))
            found[one] += 1
            if one != "agree":
                print(f"    {one}: {scene}: {why}", flush=True)
    counts = ", ".join(f"{found[one]} {one}" for one in VERDICTS if found[one])
    print(f"combinations {kind}: {counts} of {len(scenes)} in {time.perf_counter() - began:.0f} s", flush=True)
    return found.keys() <= allowed
