"""
A coating
=========

A stiff film on a soft substrate, or the other way round. The film is 2 β thick and its modulus is a given number of
times that of the substrate. Both layers are elastic and stick to each other. Units follow the contact modulus E* of
the film.
"""

import matplotlib.pyplot as plt

import halfspace

ratios = [0.3, 1.0, 3.0, 10.0]  # modulus of the film over that of the substrate
for ratio in ratios:
    coated = halfspace.Coated(thickness=2.0, modulus_ratio=ratio)
    path = halfspace.trace(1.0, body=coated, rtol=1e-3).resampled(150)
    print(f"film {ratio:4g} times as stiff: pull-off force {-path.event('pull_off').load:.3f} R dgamma")
    plt.plot(path.approach, path.load, label=f"{ratio:g}")
plt.xlim(-8, 8)
plt.xlabel("approach (ε)")
plt.ylabel("load (R Δγ)")
plt.legend(title="film/substrate")
