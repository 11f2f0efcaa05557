# %% [markdown]
# # First run
#
# A bar of steel rings in its first mode. The frequency of the simulation is compared with that of the continuum.

# %%
import matplotlib.pyplot as plt
import numpy as np

import pericles as pc

# %% [markdown]
# ## The deck
#
# Numbers are in SI units, texts have units. `check` reports what a run needs.

# %%
deck = pc.Deck.from_dict({
    "title": "Ringing bar",
    "body": {"shape": "bar", "length": "1 m", "spacing": "5 mm"},
    "material": {"density": "7850 kg/m3", "youngs_modulus": "210 GPa", "horizon_ratio": 3},
    "initial": [{"velocity": {"expression": "cos(pi*x)"}}],
    "probe": [{"name": "end", "at": ["1 m"]}],
    "time": {"end": "2 ms"},
    "output": {"history": {"count": 400}, "fields": {"count": 20}},
})
print(deck.check())

# %% [markdown]
# ## The run
#
# `run` writes the files that the program writes. The energy balance is a part of every result.

# %%
result = pc.run(deck, out="ringing", force=True)
print(result)
assert abs(result.audit.balance) < 1e-9 * result.audit.initial_energy

# %% [markdown]
# ## The frequency

# %%
probes = result.table("probes")
print(list(probes))
t = probes["time"]
u = probes[next(name for name in probes if name.startswith("end_u"))]
zeros = t[1:][np.sign(u[1:]) != np.sign(u[:-1])]
frequency = 1 / (2 * np.diff(zeros[1:]).mean())
continuum = np.sqrt(210e9 / 7850) / 2
print(f"{frequency:.0f} Hz; continuum: {continuum:.0f} Hz")
assert abs(frequency / continuum - 1) < 0.02

# %%
figure, (above, below) = plt.subplots(2, 1)
above.plot(1e3 * t, 1e6 * u)
above.set(xlabel="t (ms)", ylabel="u of the end (µm)")
below.plot(result.points[:, 0], 1e6 * result.field("displacement", time=0.1e-3)[:, 0])
below.set(xlabel="x (m)", ylabel="u at 0.1 ms (µm)")
figure.tight_layout()
figure.savefig("ringing.png")
