# %% [markdown]
# # Contact area over load, compared with Persson's theory
#
# Persson (2001): the contact fraction of a random surface under the mean pressure p̄ is erf(√2 p̄/(E* h'rms)).

# %%
import matplotlib.pyplot as plt
import numpy as np

import asperity

# %%
rms_slope, modulus = 0.1, 1.0
rough = asperity.surface.self_affine(256, 1.0, rms_slope=rms_slope, hurst=0.8, k_l=4, k_s=32, seed=1)
reduced = np.geomspace(0.01, 1.5, 16)  # p̄/(E* h'rms)
sweep = asperity.sweep(rough, modulus=modulus, mean_pressures=reduced * modulus * rms_slope)

# %% [markdown]
# The columns are those of the tool's table; `pandas.DataFrame(sweep.columns)` takes them as they are. The corrected
# fraction is without the excess that a map of nodes has along the edge of the contact.

# %%
columns = sweep.columns
area = columns["corrected_contact_fraction"]
persson = asperity.exact.Persson(rms_slope, modulus).contact_fraction(columns["mean_pressure"])
assert (columns["status"] == "converged").all()
# the theory is an approximation: at light loads its slope is √(8/π) = 1.6, and that of solved surfaces about 2
assert np.all((area / persson)[area < 0.1] < 1.4) and np.all(np.abs(area / persson - 1)[area > 0.9] < 0.05)

# %%
figure, ax = plt.subplots(figsize=(4.6, 3.6), layout="constrained")
ax.loglog(reduced, area, "o", markersize=4, label="asperity, corrected area")
ax.loglog(reduced, columns["contact_fraction"], "x", markersize=4, color="0.6", label="nodes in contact")
ax.loglog(reduced, persson, "k-", linewidth=1, label="Persson (2001)")
ax.set_xlabel(r"mean pressure $\bar p / (E^* h'_\mathrm{rms})$")
ax.set_ylabel("contact fraction")
ax.legend(frameon=False)
figure.savefig("area_over_load.png", dpi=150)
