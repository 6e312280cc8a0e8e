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
# A silicon tip of 20 nm on a polymer: its apex as a paraboloid, 22 nm wide. Beyond is nothing, `boundary="free"`, and
# the attraction there has to be small.

# %%
radius, modulus, work, reach = "20nm", "2GPa", "50mJ/m2", "0.3nm"
tip = asperity.surface.paraboloid(48, "22nm", radius=radius)
maugis = asperity.exact.MaugisDugdale(radius, modulus, work, reach)
print(f"Tabor parameter {maugis.tabor_parameter:.1f}: between DMT, below 0.1, and JKR, above 5")

# %% [markdown]
# The cantilever has 2 N/m. Its far end starts 6 nm before the position at which the tip would just touch, moves to 1 nm
# beyond it, and back until the tip is off.

# %%
cycle = asperity.cycle(
    tip,
    modulus=modulus,
    law=asperity.Exponential(work, reach),
    boundary="free",
    springs=[("2N/m", position) for position in ("-6nm", "1nm", "-12nm")],
    steps=40,
)
columns = cycle.columns
jumps = [event for event in cycle.events if event["energy_drop"]]
for event in jumps:
    # energies are per area of the map
    lost = event["energy_drop"] * 22e-9**2
    print(f"{event['event']:>8} at {1e9 * event['control_value']:.2f} nm: {1e18 * lost:.2f} aJ are lost")

# %% [markdown]
# JKR gives the approach at every radius of the contact; DMT is Hertz with the pull-off force 2πwR taken off.

# %%
radii = np.linspace(0.0, 7e-9, 300)[1:]
jkr = asperity.exact.Jkr(radius, modulus, work)
jkr_states, hertz = jkr.at_contact_radius(radii), asperity.exact.Hertz(radius, modulus).at_contact_radius(radii)

pull_off, jkr_pull_off, dmt_pull_off = -columns["normal_force"].min(), -jkr.pull_off().load, 2 * np.pi * 50e-3 * 20e-9
print(f"pull-off: {1e9 * pull_off:.2f} nN, by JKR {1e9 * jkr_pull_off:.2f} nN, by DMT {1e9 * dmt_pull_off:.2f} nN")
assert [jump["event"] for jump in jumps] == ["jump-in", "pull-off"]
assert jkr_pull_off < pull_off < dmt_pull_off and (columns["status"] == "converged").all()

# %%
figure, ax = plt.subplots(figsize=(4.8, 3.6), layout="constrained")
ax.plot(1e9 * jkr_states.approach, 1e9 * jkr_states.load, "k--", linewidth=1, label="JKR")
ax.plot(1e9 * hertz.approach, 1e9 * (hertz.load - dmt_pull_off), "k:", linewidth=1, label="DMT")
cycle.plot(ax)
ax.set(xlim=(-3, 1), ylim=(-7, 2))
ax.legend(frameon=False, loc="lower left")
figure.savefig("afm_tip.png", dpi=150)
