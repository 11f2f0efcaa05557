# %% [markdown]
# # A study
#
# The first natural frequency of a bar over three spacings, at a fixed ratio of horizon to spacing. A sweep that was interrupted
# continues where it stopped.

# %%
import matplotlib.pyplot as plt
import numpy as np

import pericles as pc

# %%
bar = {
    "body": {"shape": "bar", "length": "1 m", "spacing": "40 mm"},
    "material": {"density": 7850, "youngs_modulus": "210 GPa", "horizon_ratio": 3},
    "initial": [{"velocity": {"expression": "cos(pi*x)"}}],
    "time": {"end": "1 ms"},
    "output": {"history": {"every": 1}},
}
spacings = ["40 mm", "20 mm", "10 mm"]

# %% [markdown]
# ## Natural frequencies
#
# They approach that of the continuum with the square of the spacing and horizon.

# %%
continuum = np.sqrt(210e9 / 7850) / 2
errors = []
for spacing in spacings:
    found = pc.modes(bar, count=1, set={"body.spacing": spacing})
    errors.append(abs(found.frequencies[0] / continuum - 1))
print(errors)
h = np.array([0.04, 0.02, 0.01])
order = np.polyfit(np.log(h), np.log(errors), 1)[0]
print(f"order {order:.2f}")
# Second order; 2.1 was measured between these coarse spacings before the bounds were chosen.
assert 1.8 < order < 2.3

# %% [markdown]
# ## Runs
#
# The exchange of kinetic and elastic energy has twice the frequency.

# %%
found = []
for point in pc.sweep(bar, {"body.spacing": spacings}, out="bars"):
    history = point.result.history
    kinetic, t = history["kinetic_energy"], history["time"]
    first = t[np.argmin(kinetic[: np.searchsorted(t, 0.15e-3)])]
    found.append(1 / (4 * first))
    print(point.values, f"{found[-1]:.0f} Hz")
assert all(abs(f / continuum - 1) < 0.08 for f in found)
again = list(pc.sweep(bar, {"body.spacing": spacings}, out="bars"))
assert [p.result.folder for p in again]

# %%
plt.loglog(h, errors, "o-")
plt.xlabel("spacing (m)")
plt.ylabel("relative error of the first frequency")
plt.savefig("study.png")
