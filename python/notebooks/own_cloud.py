# %% [markdown]
# # An own cloud of points
#
# Points, volumes and sets come from NumPy: a disc with random points and a stiff inclusion, pulled by a function of time.

# %%
import matplotlib.pyplot as plt
import numpy as np

import pericles as pc

# %% [markdown]
# ## Points
#
# A jittered lattice in a disc. Every point has the area of its cell.

# %%
spacing, radius = 0.5e-3, 10e-3
random = np.random.default_rng(1)
axis = np.arange(-radius + spacing / 2, radius, spacing)
x = np.stack(np.meshgrid(axis, axis), axis=-1).reshape(-1, 2)
x = x[np.hypot(*x.T) < radius]
x = x + random.uniform(-0.1, 0.1, x.shape) * spacing
sets = {
    "core": np.hypot(*x.T) < 0.3 * radius,
    "right": x[:, 0] > radius - 4 * spacing,
    "left": x[:, 0] < -radius + 4 * spacing,
}

# %%
deck = pc.Deck.from_dict({
    "body": {"spacing": spacing, "thickness": "1 mm", "plane": "stress"},
    "material": {"density": 2440, "youngs_modulus": "72 GPa", "horizon_ratio": 3},
    "materials": {"stiff": {"density": 4000, "youngs_modulus": "300 GPa"}},
    "assign": [{"set": "core", "material": "stiff"}],
    "time": {"end": "10 us"},
})
model = deck.build(points=x, volumes=spacing**2 * 1e-3, sets=sets)
print(model)

# %% [markdown]
# ## Loads by functions
#
# The right side is pushed, the left one is held. The load is a ramp of 2 µs. A function is called once for each time.


# %%
def push(t, x):
    return [2e10 * min(t / 2e-6, 1), 0]


model.load("right", body_force=push)
model.prescribe("left", displacement=lambda t, x: [0, 0], velocity=lambda t, x: [0, 0])
simulation = model.simulation(keep=["displacement", "strain_energy_density"], count=20)
result = simulation.run().result()

# %% [markdown]
# ## Results
#
# Arrays have the order of the rows of `x`. The core deforms less than its surroundings.

# %%
assert np.array_equal(result.points, x)
u = result.field("displacement")
assert np.abs(u[sets["left"]]).max() == 0


def stretch(mask):
    """Return the slope of u_x over x."""
    return np.polyfit(x[mask, 0], u[mask, 0], 1)[0]


ring = ~sets["core"] & (np.hypot(*x.T) < 0.6 * radius)
print(f"mean strain: core {stretch(sets['core']):.2e}, around it {stretch(ring):.2e}")
assert abs(stretch(sets["core"])) < abs(stretch(ring))
result.plot("displacement", scale=50)
plt.savefig("disc.png")
