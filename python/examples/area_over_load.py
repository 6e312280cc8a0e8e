# %% [markdown]
# # Contact area over load, compared with Persson's theory
#
# Persson (2001): the contact fraction of a random surface under the mean pressure p̄ is erf(√2 p̄/(E* h'rms)).
# The picture has the theory of Greenwood and Williamson as well.

# %%
import numpy as np

import asperity

# %% [markdown]
# A polymer of E* = 1 GPa on a surface of ten micrometres with an rms slope of 0.1.

# %%
rough = asperity.surface.self_affine(256, "10um", rms_slope=0.1, hurst=0.8, k_l=4, k_s=32, seed=1)
pressures = [f"{pressure}MPa" for pressure in np.geomspace(1, 150, 16)]
sweep = asperity.sweep(rough, modulus="1GPa", mean_pressures=pressures)

# %% [markdown]
# The columns are those of the tool's table; `pandas.DataFrame(sweep.columns)` takes them as they are. The corrected
# fraction is without the excess that a map of nodes has along the edge of the contact.

# %%
columns = sweep.columns
area = columns["corrected_contact_fraction"]
persson = asperity.exact.Persson.of(rough, modulus="1GPa").contact_fraction(columns["mean_pressure"])
assert (columns["status"] == "converged").all()
# the theory is an approximation: at light loads its slope is √(8/π) = 1.6, and that of solved surfaces about 2
assert np.all((area / persson)[area < 0.1] < 1.4) and np.all(np.abs(area / persson - 1)[area > 0.9] < 0.05)

# %%
sweep.plot(theory=True).figure.savefig("area_over_load.png", dpi=150)
