# %% [markdown]
# # From a force curve to modulus and adhesion
#
# A force curve of a rough tip, from its file to the contact modulus and the work of adhesion. Roughness holds the bodies
# apart, so that a smooth tip of the same radius would need less adhesion to pull off at the same force. A table of solves
# of the tip's own map, made once, fits all of its curves.

# %%
import warnings

import matplotlib.pyplot as plt
import numpy as np

import asperity

# the asperities of a tip press hard
warnings.filterwarnings("ignore", "hardness", asperity.InputWarning)

# %% [markdown]
# The tip has a radius of 60 nm and a roughness of 0.3 nm. In place of this map take that of your tip, by `asperity.read`.

# %%
sphere = asperity.surface.sphere(64, "60nm", radius="60nm")
rough = asperity.surface.self_affine(64, "60nm", rms_height="0.3nm", k_l=2, k_s=16, seed=4)
tip = asperity.Topography(sphere.heights + rough.heights, sphere.lengths, unit="m")

# %% [markdown]
# In place of a measurement: solves of a body of 2 GPa with a work of adhesion of 50 mJ/m², which the tip approaches and
# leaves on a cantilever of 10 N/m, with noise, in a file with German decimal commas.

# %%
z = np.concatenate([np.linspace(-4, 4, 150), np.linspace(4, -4, 150)])
springs = [("10N/m", f"{position}nm") for position in z]
law = asperity.Exponential("50mJ/m2", "0.5nm")
force = asperity.sweep(tip, modulus="2GPa", law=law, boundary="free", springs=springs).columns["normal_force"]
force = 1e9 * force + np.random.default_rng(1).normal(scale=0.15, size=force.size)
with open("force_curve.csv", "w") as file:
    file.write("Höhe (nm);Kraft (nN)\n")
    file.writelines(f"{x:.4f};{y:.4f}\n".replace(".", ",") for x, y in zip(z, force))

# %% [markdown]
# The table reaches from 5 nm before contact to 4 nm behind it, and to the ratio w/E* of 60 mJ/m² over 1 GPa. Its range
# is that of the law.

# %%
table = asperity.TipTable(
    tip, approaches=("-5nm", "4nm"), modulus="1GPa", law=asperity.Exponential("60mJ/m2", "0.5nm")
)
print(table)

# %%
curve = asperity.read_curve("force_curve.csv")
units = {"spring_stiffness": "10N/m", "length_unit": "m", "force_unit": "N"}
fit = asperity.fit_curve(*curve, tip=table, **units)
print(fit)
assert abs(fit.modulus.value / 2e9 - 1) < 0.03 and abs(fit.work_of_adhesion.value / 0.05 - 1) < 0.02

# %% [markdown]
# A smooth tip fits as well as it can, with a work of adhesion that is too small, and a warning says that the curve is none
# of a smooth tip.

# %%
with warnings.catch_warnings(record=True) as told:
    warnings.simplefilter("always")
    smooth = asperity.fit_curve(*curve, radius="60nm", **units)
print(f"smooth: {1e3 * smooth.work_of_adhesion.value:.0f} mJ/m2, {told[0].message}")
assert smooth.work_of_adhesion.upper < 0.045

# %%
upper, lower = fit.plot()
upper.plot(1e9 * smooth.z, 1e9 * smooth.fitted, "k:", linewidth=1, label="smooth tip")
lower.plot(1e9 * smooth.z, 1e12 * smooth.residuals, "k:", linewidth=0.6)
upper.legend(frameon=False)
upper.figure.savefig("force_curve.png", dpi=150)
plt.show()
