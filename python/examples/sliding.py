# %% [markdown]
# # One rough surface slides over another
#
# Two elastic bodies with measured or random surfaces, pressed together while the second one is moved along x. Each
# position starts from the gap at the one before.

# %%
import matplotlib.pyplot as plt
import numpy as np

import asperity

# %% [markdown]
# Two polymers of 2 GPa and 6 GPa under 20 MPa, on maps with nodes every 100 nm.

# %%
one, other = (asperity.surface.self_affine(256, "25.6um", rms_slope=0.1, k_l=4, k_s=32, seed=seed) for seed in (1, 2))
bodies = {"against": other, "modulus": "2GPa", "against_modulus": "6GPa", "mean_pressure": "20MPa"}

# %% [markdown]
# How much the start is worth depends on the step: over a quarter of a node, over one, and over eight nodes. The table
# has the mean operator applications of a solve.

# %%
print("| from one position to the next | default start | gap of the position before |\n|---|---|---|")
for step in (25, 100, 800):
    shifts = step * np.arange(9)
    default = [asperity.solve(one, shift=f"{shift}nm", **bodies, nested=False) for shift in shifts]
    found = [default[0]]
    for shift in shifts[1:]:
        found.append(asperity.solve(one, shift=f"{shift}nm", **bodies, start=found[-1]))
    counts = [np.mean([solution.operator_applications for solution in way[1:]]) for way in (default, found)]
    print(f"| {step} nm | {counts[0]:.1f} | {counts[1]:.1f} |")
    assert all(abs(a.contact_fraction - b.contact_fraction) < 1e-3 for a, b in zip(default, found))

# %% [markdown]
# The displacement of each body is in the ratio of the moduli, and their sum is that of the surface between both.

# %%
last = found[-1]
both = last.displacement + last.against_displacement
assert np.ptp(both - last.gap - last.heights) < 1e-14
assert np.allclose(last.displacement, 3.0 * last.against_displacement, atol=1e-14)

# %%
figure, (left, right) = plt.subplots(1, 2, figsize=(7.4, 3.2), layout="constrained")
left.plot(shifts / 1e3, [solution.contact_fraction for solution in found], "o-")
left.set(xlabel="shift (µm)", ylabel="contact fraction", title="sliding along x")
x, middle = 0.1 * (np.arange(256) - 128), 128
surface = 1e9 * (np.asarray(one) - last.displacement)[:, middle]
right.plot(x, surface, label="first body")
right.plot(x, surface + 1e9 * last.gap[:, middle], label="second body")
right.set(xlabel="x (µm)", ylabel="height (nm)", title="a section of the last contact")
right.legend(frameon=False)
figure.savefig("sliding.png", dpi=150)
