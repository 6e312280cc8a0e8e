# %% [markdown]
# # 200 scenes over processes, one table
#
# Fifty surfaces of four Hurst exponents, ten micrometres wide, are pressed on a polymer of E* = 1 GPa by 5 MPa: how much
# does the contact of one surface differ from that of another?

# %%
import itertools
from concurrent.futures import ProcessPoolExecutor

import matplotlib.pyplot as plt
import pandas as pd

import asperity


def contact(scene):
    """A row of the table. One thread each: the processes share the cores."""
    hurst, seed = scene
    rough = asperity.surface.self_affine(128, "10um", rms_slope=0.1, hurst=hurst, k_l=4, k_s=20, seed=seed)
    solution = asperity.solve(rough, modulus="1GPa", mean_pressure="5MPa", threads=1)
    return {"hurst": hurst, "seed": seed, **solution.report}


# %% [markdown]
# Threads would do as well, by `ThreadPoolExecutor`: a solve does not hold the interpreter's lock. joblib is
# `Parallel(n_jobs=-1)(delayed(contact)(scene) for scene in scenes)`.

# %%
if __name__ == "__main__":
    scenes = list(itertools.product([0.3, 0.5, 0.7, 0.9], range(50)))
    with ProcessPoolExecutor() as pool:
        table = pd.DataFrame(pool.map(contact, scenes, chunksize=10))
    assert len(table) == 200 and (table.status == "converged").all()
    area = table.groupby("hurst").corrected_contact_fraction
    print(area.agg(["mean", "std"]))

    # %%
    figure, ax = plt.subplots(figsize=(4.6, 3.4), layout="constrained")
    ax.boxplot([100 * values for _, values in area], tick_labels=[f"{hurst}" for hurst, _ in area], showfliers=False)
    ax.set_xlabel("Hurst exponent")
    ax.set_ylabel("contact area (%)")
    figure.savefig("many_scenes.png", dpi=150)
