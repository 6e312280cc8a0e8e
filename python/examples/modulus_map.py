# %% [markdown]
# # From a map of force curves to a map of moduli
#
# A gel with a stiffer inclusion was mapped by 16 x 16 force curves. All of them are fitted at once, on all cores, and the
# figure has the modulus and the width of its 95 % interval, curve by curve.

# %%
import afmformats
import h5py
import matplotlib.pyplot as plt
import numpy as np

import asperity

# %% [markdown]
# In place of a measurement: a sphere of 2 µm on a cantilever of 0.1 N/m presses on a gel of 6 kPa with an inclusion of 15
# kPa, over hills of 200 nm. The curves of a corner stick, with 20 µJ/m², and one has lost its contact. The file has the
# layout of afmformats; a `.jpk-qi-data` or a `.jpk-force-map` file takes its place.

# %%
side, radius, stiffness, rng = 16, 2e-6, 0.1, np.random.default_rng(1)
x, y = np.meshgrid(*[(np.arange(side) + 0.5) / side] * 2, indexing="ij")
moduli = 6e3 + 9e3 / (1 + np.exp(40 * (np.hypot(x - 0.6, y - 0.5) - 0.22)))
heights = 2e-7 * np.sin(3 * x) * np.cos(2 * y)


def curve(modulus, height, work):
    radii = np.linspace(0, 1.5e-6, 2000)
    if work:
        contact = asperity.exact.Jkr(radius, modulus, work).at_contact_radius(radii)
    else:
        contact = asperity.exact.Hertz(radius, modulus).at_contact_radius(radii)
    where = contact.approach + contact.load / stiffness
    z = np.linspace(-1e-6, 0.8e-6, 150)
    there = np.interp(z, np.maximum.accumulate(where), contact.load)
    back = np.interp(z, np.minimum.accumulate(where[::-1])[::-1], contact.load)
    force = np.append(there, back[::-1]) + rng.normal(scale=4e-11, size=300)
    # the head of the microscope comes down: its height falls towards contact
    return {"height (measured)": height - np.append(z, z[::-1]), "force": force}


metadata = {"imaging mode": "force-distance", "spring constant": stiffness}
metadata |= {f"grid shape {axis}": side for axis in "xy"} | {f"grid size {axis}": 10e-6 for axis in "xy"}
with h5py.File("modulus_map.h5", "w") as file:
    for number, place in enumerate(np.ndindex(side, side)):
        made = curve(moduli[place], heights[place], 20e-6 if x[place] + y[place] < 0.4 else 0.0)
        if place == (13, 2):
            made["force"] = rng.normal(scale=4e-11, size=300)
        made["segment"] = np.repeat([0, 1], 150).astype(np.uint8)
        here = {**metadata, "enum": number, "path": "map", "grid index x": place[0], "grid index y": place[1]}
        one = afmformats.AFMForceDistance(made, here)
        one.export_data(file, metadata=True, fmt="hdf5")

# %% [markdown]
# The file brings the grid, its side lengths, and the stiffness of the cantilever. Poisson's ratio makes Young's modulus of
# the contact modulus.

# %%
found = asperity.fit_curves("modulus_map.h5", radius="2um", poisson=0.5)
print(found)
print("at (13, 2):", found.reason[13, 2])

# %% [markdown]
# The intervals hold: of a hundred curves some five are expected to miss what they were made of.

# %%
modulus = found.modulus
missed = (moduli < modulus.lower) | (moduli > modulus.upper)
print(f"{100 * missed.sum() / np.isfinite(modulus.value).sum():.0f} % of the intervals miss the modulus")
assert missed.mean() < 0.09 and np.isnan(modulus.value).sum() == 1
sticks = found.work_of_adhesion.lower > 0
print(f"{sticks.sum()} curves stick, of {(x + y < 0.4).sum()} that were made so")

# %%
figure, axes = plt.subplots(1, 3, figsize=(14, 3.6), layout="constrained")
figure.get_layout_engine().set(wspace=0.12)
found.plot("young", axes[0])
relative = 100 * (modulus.upper - modulus.lower) / modulus.value
image = axes[1].imshow(relative.T, origin="lower", extent=(0, 10, 0, 10), cmap="cividis", vmax=5)
figure.colorbar(image, ax=axes[1], label="width of the interval (%)", extend="max", fraction=0.046, pad=0.04)
axes[1].set(xlabel="x (µm)", ylabel="y (µm)")
found.plot("contact_height", axes[2])
figure.savefig("modulus_map.png", dpi=150)
plt.show()

# %% [markdown]
# `to_dataframe` has a row for each curve, and `to_xarray` all arrays over x and y.
