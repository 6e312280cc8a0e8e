# %% [markdown]
# # The force–distance curve of an AFM tip
#
# A tip on a cantilever comes down on a sample, jumps into contact, is pressed, and is pulled off again. At jump-in and
# pull-off there is no equilibrium nearby: the cycle locates them, with the energy that they cost. The curve is compared
# with the two limits of a sphere on a half-space: JKR, for a range of adhesion that is short compared with the
# deformation, and DMT, for a long one.

# %%
import matplotlib.pyplot as plt
import numpy as np

import asperity

# %% [markdown]
# A silicon tip of 20 nm on a polymer, in SI units: its apex as a paraboloid, 22 nm wide. Beyond is nothing,
# `boundary="free"`, and the attraction there has to be small.

# %%
radius, modulus = 20e-9, 2e9
side, nodes = 22e-9, 48
x = side * (np.arange(nodes) / nodes - 0.5)
tip = asperity.prepare(-(x[:, None] ** 2 + x**2) / (2 * radius), side, unit="m")
law = asperity.Exponential(work_of_adhesion=0.05, range=0.3e-9)

maugis = asperity.exact.MaugisDugdale(radius, modulus, law.work_of_adhesion, law.range)
print(f"Tabor parameter {maugis.tabor_parameter:.1f}: between DMT, below 0.1, and JKR, above 5")

# %% [markdown]
# The cantilever has 2 N/m. Its far end starts 6 nm before the position at which the tip would just touch, goes 1 nm
# beyond it, and back until the tip is off.

# %%
stiffness = 2.0
cycle = asperity.cycle(
    tip,
    modulus=modulus,
    law=law,
    boundary="free",
    springs=[(stiffness, position) for position in (-6e-9, 1e-9, -12e-9)],
    steps=40,
)
columns = cycle.columns
for event in cycle.events:
    if event["energy_drop"]:
        # energies are per area of the map
        lost = event["energy_drop"] * side**2
        print(f"{event['event']:>8} at {1e9 * event['control_value']:.2f} nm: {1e18 * lost:.2f} aJ are lost")

# %% [markdown]
# JKR gives the approach at every radius of the contact; DMT is Hertz with the pull-off force 2πwR taken off.

# %%
radii = np.linspace(0.0, 7e-9, 300)[1:]
jkr = asperity.exact.Jkr(radius, modulus, law.work_of_adhesion)
hertz = asperity.exact.Hertz(radius, modulus).at_contact_radius(radii)
jkr_states, dmt_load = jkr.at_contact_radius(radii), hertz.load - 2 * np.pi * law.work_of_adhesion * radius

pull_off = -columns["normal_force"].min()
jkr_pull_off, dmt_pull_off = -jkr.pull_off().load, 2 * np.pi * law.work_of_adhesion * radius
print(f"pull-off: {1e9 * pull_off:.2f} nN, by JKR {1e9 * jkr_pull_off:.2f} nN, by DMT {1e9 * dmt_pull_off:.2f} nN")
assert [event["event"] for event in cycle.events if event["energy_drop"]] == ["jump-in", "pull-off"]
assert jkr_pull_off < pull_off < dmt_pull_off and (columns["status"] == "converged").all()

# %%
figure, ax = plt.subplots(figsize=(4.8, 3.6), layout="constrained")
nano = 1e9
ax.plot(nano * jkr_states.approach, nano * jkr_states.load, "k--", linewidth=1, label="JKR")
ax.plot(nano * hertz.approach, nano * dmt_load, "k:", linewidth=1, label="DMT")
cycle.plot(ax, force_unit="N")
ax.set_xlim(-3, 1.1 * nano * columns["approach"].max())
ax.set_ylim(-1.1 * nano * dmt_pull_off, 1.2 * nano * columns["normal_force"].max())
ax.legend(frameon=False)
figure.savefig("afm_tip.png", dpi=150)
