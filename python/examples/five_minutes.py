# %% [markdown]
# # Five minutes with a measured map
#
# From a file with a tilt, missing points and edges that do not meet to a contact map with adhesion. Cells are marked
# by `# %%`: VS Code, Spyder and Jupyter (with jupytext) open this file as a notebook, and Python runs it as it is.

# %%
import numpy as np

import asperity

# %% [markdown]
# A stand-in for a measurement, 2 µm wide, in metres. Yours is a file: `.npy`, `.npz`, `.gsf`, `.xyz` or text, or any of
# the 45 formats of SurfaceTopography, by `asperity.from_topography`.

# %%
rough = asperity.surface.self_affine(512, "4um", rms_height="6nm", hurst=0.8, k_l=2, k_s=40, seed=11)
measured = rough.heights[:256, :256] + 3e-9 * np.linspace(-1, 1, 256)[:, None]
measured[40:44, 100:120] = np.nan
np.savez("measured.npz", heights=measured, lengths=(2e-6, 2e-6), unit="m")

# %%
raw = asperity.read("measured.npz")
raw

# %% [markdown]
# A surface is periodic and complete, a measurement neither. Each step is asked for.

# %%
surface = asperity.prepare(raw, detrend="plane", fill=True, mirror=True)
asperity.surface.statistics(surface)

# %% [markdown]
# Press it against a half-space of E* = 1 GPa by 2 MPa, without adhesion and with a work of adhesion of 20 mJ/m².

# %%
dry = asperity.solve(surface, modulus="1GPa", mean_pressure="2MPa")
law = asperity.JKR(work_of_adhesion="20mJ/m2")
sticky = asperity.solve(surface, modulus="1GPa", mean_pressure="2MPa", law=law, stability=True)
sticky

# %%
print(f"contact: {100 * dry.contact_fraction:.2f} % without adhesion, {100 * sticky.contact_fraction:.2f} % with it")
assert dry.converged and sticky.converged and sticky.contact_fraction > dry.contact_fraction
assert sticky.report["stability"]["verdict"] == "stable"

# %% [markdown]
# Fields are numpy arrays: the ten largest contact clusters, and the greatest pressure.

# %%
clusters = asperity.contact.clusters(sticky.contact)
print(clusters.sizes[:10], f"{sticky.contact_pressure.max() / 1e6:.0f} MPa")

# %%
axes = sticky.plot()
axes[0].figure.savefig("five_minutes.png", dpi=150)
