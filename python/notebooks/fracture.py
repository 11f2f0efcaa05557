# %% [markdown]
# # Fracture with an inclusion field
#
# A plate of a linear peridynamic solid (LPS) with randomly placed stiff inclusions is pulled apart. A callback stops the run at the first
# breakage; the run then goes on. The picture is made by PyVista, and the load at breakage is compared over three spacings.

# %%
import matplotlib.pyplot as plt
import numpy as np

import pericles as pc

SIZE = np.array([20e-3, 10e-3])

# %% [markdown]
# ## Model
#
# The inclusions are discs whose centres do not depend on the spacing, so that refinement compares the same body.

# %%
random = np.random.default_rng(7)
centres = random.uniform([4e-3, 1.5e-3], [16e-3, 8.5e-3], (12, 2))


def build(spacing):
    axes = (np.arange(spacing / 2, side, spacing) for side in SIZE)
    x = np.stack(np.meshgrid(*axes), axis=-1).reshape(-1, 2)
    inclusions = (np.hypot(*(x[:, None] - centres).transpose(2, 0, 1)) < 0.9e-3).any(axis=1)
    grip = 2e-3
    sets = {"inclusions": inclusions, "left": x[:, 0] < grip, "right": x[:, 0] > SIZE[0] - grip}
    deck = pc.Deck.from_dict({
        "body": {"spacing": spacing, "thickness": "1 mm", "plane": "stress"},
        "material": {
            "model": "state-based", "density": 2440, "youngs_modulus": "72 GPa", "poisson_ratio": 0.22,
            "fracture_energy": "10 J/m2", "horizon": 3 * spacing,
        },
        "materials": {"stiff": {
            "density": 3900, "youngs_modulus": "300 GPa", "poisson_ratio": 0.22,
            "fracture_energy": "40 J/m2",
        }},
        "assign": [{"set": "inclusions", "material": "stiff"}],
        "time": {"end": "16 us"},
        "output": {"history": {"every": 5}},
    })
    model = deck.build(points=x, volumes=spacing**2 * 1e-3, sets=sets)
    speed = 2.0
    for side, sign in (("left", -1), ("right", 1)):
        model.prescribe(
            side, axes="x",
            displacement=lambda t, x, sign=sign: [sign * speed * t, 0],
            velocity=lambda t, x, sign=sign: [sign * speed, 0],
        )
        model.no_fail(side)
    # The body starts in the uniform motion of its ends: no wave runs ahead of the failure.
    model.set_initial(velocity=lambda x: np.c_[speed * np.clip((x[:, 0] - SIZE[0] / 2) / (SIZE[0] / 2 - grip), -1, 1), 0 * x[:, 0]])
    return model


# %% [markdown]
# ## Stop at the first breakage


# %%
def first_breakage(spacing):
    simulation = build(spacing).simulation(keep=["displacement", "damage"], count=16)

    @simulation.every(steps=1)
    def broken(s):
        if s.broken_bonds:
            return pc.STOP

    simulation.run()
    return simulation


simulation = first_breakage(0.5e-3)
print(simulation, simulation.broken_bonds, "bonds broke")
assert 0 < simulation.time < 16e-6
first = simulation.time
while simulation.steps_done < simulation.steps:
    simulation.step(simulation.steps - simulation.steps_done)  # the callback stops every step
    if simulation.time > 1.5 * first:
        break

# %% [markdown]
# ## Picture

# %%
result = simulation.result()
mesh = result.to_pyvista()
damage = mesh.point_data["Damage"]
print(f"largest damage {damage.max():.2f}")
try:
    import pyvista

    plotter = pyvista.Plotter(off_screen=True)
    plotter.add_mesh(mesh, scalars="Damage", point_size=6)
    plotter.view_xy()
    plotter.screenshot("damage.png")
except Exception as error:  # no display and no software renderer
    print(f"no picture by PyVista: {error}")
result.plot("damage")
plt.savefig("damage_matplotlib.png")

# %% [markdown]
# ## Convergence of the strain at breakage
#
# The critical stretch falls with the root of the horizon, s ∝ √(G/(E δ)), and so does the strain at which the first bond breaks.

# %%
spacings = np.array([1e-3, 0.7e-3, 0.5e-3])
length = SIZE[0] - 2 * 2e-3
strains = np.array([2 * 2.0 * first_breakage(spacing).time / length for spacing in spacings])
order = np.polyfit(np.log(spacings), np.log(strains), 1)[0]
print(strains, f"order {order:.2f}; expected about 0.5")
assert 0.2 < order < 0.8

# %%
plt.figure()
plt.loglog(spacings, strains, "o-")
plt.loglog(spacings, strains[-1] * np.sqrt(spacings / spacings[-1]), ":", label="slope 1/2")
plt.xlabel("spacing (m)")
plt.ylabel("strain at the first breakage")
plt.legend()
plt.savefig("strains.png")
