# %% [markdown]
# # One rough surface slides over another
#
# Two elastic bodies with measured or random surfaces, pressed together while the second one is moved along x. Each
# position starts from the gap at the one before.

# %%
import matplotlib.pyplot as plt
import numpy as np

import asperity

# %%
one, other = (asperity.surface.self_affine(256, 1.0, rms_slope=0.1, k_l=4, k_s=32, seed=seed) for seed in (1, 2))
bodies = {"against": other, "modulus": 2.0, "against_modulus": 6.0, "mean_pressure": 0.02}
spacing = 1.0 / 256

# %% [markdown]
# How much the start is worth depends on the step: over a quarter of a node, over one, and over eight nodes. The table
# has the mean operator applications of a solve.

# %%
worth = {}
print("| nodes from one position to the next | default start | gap of the position before |\n|---|---|---|")
for step in (0.25, 1.0, 8.0):
    shifts = step * spacing * np.arange(9)
    default = [asperity.solve(one, shift=shift, **bodies, nested=False) for shift in shifts]
    found = [default[0]]
    for shift in shifts[1:]:
        found.append(asperity.solve(one, shift=shift, **bodies, start=found[-1]))
    counts = [np.mean([solution.operator_applications for solution in way[1:]]) for way in (default, found)]
    worth[step] = counts
    print(f"| {step:g} | {counts[0]:.1f} | {counts[1]:.1f} |")
    assert all(abs(a.contact_fraction - b.contact_fraction) < 1e-3 for a, b in zip(default, found))

# %% [markdown]
# The displacement of each body is in the ratio of the moduli, and their sum is that of the surface between both.

# %%
last = found[-1]
both = last.displacement + last.against_displacement
assert np.ptp(both - last.gap - last.heights) < 1e-9
assert np.allclose(last.displacement, 3.0 * last.against_displacement)

# %%
figure, (left, right) = plt.subplots(1, 2, figsize=(7.4, 3.2), layout="constrained")
left.plot(shifts / spacing, [solution.contact_fraction for solution in found], "o-")
left.set_xlabel("shift (nodes)")
left.set_ylabel("contact fraction")
x, middle = (np.arange(256) - 128) * spacing, 128
surface = (np.asarray(one) - last.displacement)[:, middle]
left.set_title("sliding along x", fontsize=10)
right.plot(x, surface, label="first body")
right.plot(x, surface + last.gap[:, middle], label="second body")
right.set_xlabel("x")
right.set_ylabel("height")
right.set_title("a section of the last contact", fontsize=10)
right.legend(frameon=False)
figure.savefig("sliding.png", dpi=150)
