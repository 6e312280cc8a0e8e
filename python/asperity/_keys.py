"""The keywords of solves, by the keys of scenes. Written by `UPDATE=1 cargo test -p asperity-scene --test keys`."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal, TypedDict

if TYPE_CHECKING:
    from collections.abc import Iterable

    from numpy.typing import ArrayLike

    from ._types import OwnLaw, Quantity
    from ._wall import Penalty, Uzawa


class SurfaceKeywords(TypedDict, total=False):
    """The surface, the bodies, and the boundary."""

    modulus: Quantity | None
    boundary: Literal["periodic", "free"] | None
    absent_missing: bool | None
    layer: Quantity | None
    base: Literal["bonded", "sliding"] | None
    coating: Quantity | None
    coating_modulus: Quantity | None
    coating_poisson: float | None
    plate: Quantity | None
    poisson: float | None
    against_modulus: Quantity | None
    shift: Quantity | tuple[Quantity, Quantity] | None
    whole: bool | None


class AdhesionKeywords(TypedDict, total=False):
    """The adhesion between the surfaces, the wall, and the hardness."""

    law: Literal["none", "jkr", "maugis-dugdale", "exponential", "lennard-jones", "morse", "power", "van-der-waals"] | OwnLaw | None
    work_of_adhesion: Quantity | None
    range: Quantity | None
    exponent: float | None
    hamaker: Quantity | None
    cut_off: Quantity | None
    wall: Literal["hard", "none", "penalty", "uzawa"] | Penalty | Uzawa | None
    wall_stiffness: Quantity | None
    hardness: Quantity | ArrayLike | None


class SolverKeywords(TypedDict, total=False):
    """The method and the accuracy of a solve."""

    method: Literal["default", "rey2017"] | None
    tolerance: float | None
    max_iterations: int | None
    precision: Literal["f64", "f32"] | None
    threads: int | None
    branch: Literal["loading", "unloading", "both"] | None


class LoadKeywords(TypedDict, total=False):
    """The load of a solve, of which one is given."""

    mean_gap: Quantity | None
    mean_pressure: Quantity | None
    normal_force: Quantity | None
    approach: Quantity | None
    spring_stiffness: Quantity | None
    spring_position: Quantity | None
    reduced_pressure: float | None
    contact_fraction: float | None


class LoadsKeywords(TypedDict, total=False):
    """The loads of a table, a list of one kind."""

    mean_gaps: Iterable[Quantity] | None
    mean_pressures: Iterable[Quantity] | None
    normal_forces: Iterable[Quantity] | None
    approaches: Iterable[Quantity] | None
    spring_stiffness: Quantity | None
    spring_positions: Iterable[Quantity] | None
    reduced_pressures: Iterable[float] | None


class FractionsKeywords(TypedDict, total=False):
    """The contact fractions of a table."""

    contact_fractions: Iterable[float] | None


class NestedKeywords(TypedDict, total=False):
    """The grids of a solve."""

    nested: bool | None


class FindingsKeywords(TypedDict, total=False):
    """The findings after a solution."""

    stability: bool | None
    leave: bool | None
    stiffness: bool | None


class StiffnessKeywords(TypedDict, total=False):
    """The contact stiffness of each row of a table."""

    stiffness: bool | None


class ConductorKeywords(TypedDict, total=False):
    """The conductors, of which the contact stiffness tells the conductance."""

    resistivities: tuple[Quantity, Quantity] | None
    conductivities: tuple[Quantity, Quantity] | None


class LeakageKeywords(TypedDict, total=False):
    """The leakage of a table."""

    leakage: float | None


class AccuracyKeywords(TypedDict, total=False):
    """The accuracy that is asked for."""

    accuracy: float | None
    accuracy_of: Literal["area", "gap", "approach", "pressure", "stiffness"] | None
    memory: float | None


class PathKeywords(TypedDict, total=False):
    """The steps of a cycle."""

    steps: int | None
    smallest_step: float | None
    imbalance: float | None


class PullOffKeywords(TypedDict, total=False):
    """The pull-off that is asked for."""

    preload: Quantity | None
    rtol: float | None
    accuracy: float | None
    memory: float | None


#: The defaults of keywords, and their meanings, by the lists of keys.
KEYS: dict[str, dict[str, tuple[object, str]]] = {
    "Surface": {
        "modulus": (None, "Contact modulus E*, a pressure: E/(1 - nu^2), with Young's modulus E and Poisson's ratio nu of the body that deforms"),
        "boundary": ("periodic", "Surroundings of the map"),
        "absent_missing": (False, "Treat missing points of the file as absent nodes, where nothing faces the half-space, such as around a punch or in a hole; in the files of results their gap is NaN and their pressures are 0"),
        "layer": (None, "Thickness of an elastic layer on a rigid base, instead of a half-space; needs poisson"),
        "base": (None, "Hold of the base on the layer: bonded, or sliding without friction [default: bonded]"),
        "coating": (None, "Thickness of an elastic coating on the half-space; modulus is then that of the substrate; needs coating_modulus, coating_poisson and poisson"),
        "coating_modulus": (None, "Contact modulus E/(1 - nu^2) of the coating, a pressure"),
        "coating_poisson": (None, "Poisson's ratio of the coating"),
        "plate": (None, "Bending stiffness D = E t^3/(12 (1 - nu^2)) of a plate on the half-space; modulus is then that of the half-space"),
        "poisson": (None, "Poisson's ratio of the layer, or of the substrate under a coating"),
        "against_modulus": (None, "Contact modulus E/(1 - nu^2) of the second body, an elastic half-space [default: it is rigid]"),
        "shift": (None, "Shift of the second surface along x and y, also by parts of a node [default: 0 0]; write negative ones with a unit as --shift=-1um,0um"),
        "whole": (False, "Give results on all nodes of a map that asperity prepare has mirrored; without it, fields, pictures, contact and force are those of the original"),
    },
    "Adhesion": {
        "law": (None, "Adhesion law, over the gap g; asperity laws lists the parameters and the source of each"),
        "work_of_adhesion": (None, "Work of adhesion, an energy per area; all that jkr needs"),
        "range": (None, "Range of adhesion, a length; for lennard-jones and van-der-waals the distance of the surfaces in contact"),
        "exponent": (None, "Exponent of the energy of a power law"),
        "hamaker": (None, "Hamaker's constant of van-der-waals, an energy"),
        "cut_off": (None, "Gap at which a law that never ends is cut off, smoothly and with all of its work of adhesion"),
        "wall": ("hard", "What keeps the surfaces apart: a rigid wall, the repulsion of lennard-jones or morse alone, or springs"),
        "wall_stiffness": (None, "Stiffness of the springs of a penalty or uzawa wall, a pressure per length"),
        "hardness": (None, "Hardness, the greatest contact pressure: where it is reached, the surface yields and stays flattened"),
    },
    "Solver": {
        "method": ("default", "Preconditioned conjugate gradients, or the algorithm of Rey et al. (2017)"),
        "tolerance": (None, "Certified relative error at which to stop [default: 1e-6, in f32 1e-4]"),
        "max_iterations": (None, "Iterations after which to give up [default: 2000, with rey2017 20000]"),
        "precision": ("f64", "Precision of the solve, and of the fields it writes"),
        "threads": (None, "Threads; the results do not depend on it [default: one per core]"),
        "branch": (None, "Equilibrium to find where adhesion has several: that of surfaces pressed together from afar, that of surfaces pressed flat before, or with solve both [default: loading; unloading under a tension or at a given mean gap]"),
    },
    "Load": {
        "mean_gap": (None, "Mean gap that is held, a length; with a periodic boundary"),
        "mean_pressure": (None, "Mean external pressure that is held, over the area of the map, compression positive"),
        "normal_force": (None, "Normal force that is held, compression positive: the mean pressure times the area of the map"),
        "approach": (None, "Approach that is held, with a free boundary: how far the bodies have moved towards each other from the position of first touch without deformation; negative before it"),
        "spring_stiffness": (None, "Stiffness of a spring in series, such as a machine or a cantilever, a force per length; needs spring_position"),
        "spring_position": (None, "Position Z of the spring's far end, at which the spring is relaxed: with a free boundary an approach, F = K (Z - D); with a periodic one a mean gap, F = K (G - Z)"),
        "reduced_pressure": (None, "Mean pressure that is held, over the contact modulus and the rms slope of the surface: p/(E* h'rms)"),
        "contact_fraction": (None, "Share of the nodes in contact to search for, to one node or 1 %. Without adhesion the search varies the mean pressure, with adhesion the mean gap, and with adhesion and a free boundary the approach. If the contact jumps past the share, the nearer side of the jump is written, and the exit code is 2"),
    },
    "Loads": {
        "mean_gaps": (None, "Mean gaps, lengths, with a periodic boundary: numbers and ranges FROM:TO:COUNT or FROM:TO:COUNT:log, separated by commas"),
        "mean_pressures": (None, "Mean external pressures over the area of the map, compression positive: a list like that of the gaps"),
        "normal_forces": (None, "Normal forces, compression positive: a list like that of the gaps"),
        "approaches": (None, "Approaches, with a free boundary: how far the bodies have moved towards each other from the position of first touch without deformation, negative before it; a list like that of the gaps. A list that grows from a negative value begins with the bodies apart"),
        "spring_stiffness": (None, "Stiffness of a spring in series, such as a machine or a cantilever, a force per length; needs spring_positions"),
        "spring_positions": (None, "Positions Z of the spring's far end, at which the spring is relaxed: with a free boundary approaches, F = K (Z - D); with a periodic one mean gaps, F = K (G - Z); a list like that of the gaps. With a free boundary a list that grows from a negative value begins with the bodies apart"),
        "reduced_pressures": (None, "Mean pressures over the contact modulus and the rms slope of the surface, p/(E* h'rms): a list like that of the gaps"),
    },
    "Fractions": {
        "contact_fractions": (None, "Shares of the nodes in contact to search for: a list like that of the gaps. The load of each is found like that of asperity solve --contact-fraction, and the table has two more columns, wanted_contact_fraction and reached"),
    },
    "Nested": {
        "nested": (None, "Solve on coarser grids first, if these resolve the adhesion; the default if that is faster"),
    },
    "Findings": {
        "stability": (False, "Find out whether the solution is stable, and write its softest mode to mode.npy"),
        "leave": (False, "Continue from an unstable equilibrium to one that is not, and say how far the energy falls; implies stability"),
        "stiffness": (False, "Find the contact stiffness: how much the mean pressure grows with the approach, pressure per length"),
    },
    "Stiffness": {
        "stiffness": (False, "Find the contact stiffness under each load, in two more columns: contact_stiffness, how much the mean pressure grows with the approach, and normal_stiffness, how much the force does"),
    },
    "Conductor": {
        "resistivities": (None, "Electrical resistivities of both half-spaces: with stiffness these give the electrical conductance of the contact per area, by Barber's identity, and its relative error, including that of the grid"),
        "conductivities": (None, "Thermal conductivities of both half-spaces: the same for heat"),
    },
    "Leakage": {
        "leakage": (None, "Enclose the transmissivity of the gap along x and y under each load between two bounds, like asperity leak; in a table the columns are transmissivity_x_lower and so on. The value is the distance of the bounds as a share of the upper one [default: 1e-3 if leakage has no value]"),
    },
    "Accuracy": {
        "accuracy": (None, "Relative error to reach, such as 0.01: chooses the tolerance, solves on coarser grids too, and interpolates the surface on finer ones until the estimated error is small enough; the results are on the finest grid"),
        "accuracy_of": (None, "Quantity that has the accuracy [default: area]"),
        "memory": (None, "Memory that accuracy may take, in GiB [default: all that is free]"),
    },
    "Path": {
        "steps": (50, "Least number of steps from one turning point to the next"),
        "smallest_step": (1e-4, "Step to which jumps are located, as a share of the way from one turning point to the next"),
        "imbalance": (1e-4, "Imbalance of energy that a step may have, as a share of the change of the energy so far and of twenty times what jumps have dissipated; smaller jumps are not located one by one"),
    },
    "PullOff": {
        "preload": (None, "Mean pressure to which surfaces that come from afar were pressed before; without it they were pressed flat, unless branch or start says otherwise"),
        "rtol": (0.02, "Relative tolerance of the pull-off"),
        "accuracy": (None, "Relative error of the pull-off to reach, such as 0.05, with the law jkr: interpolates the surface on finer grids until the estimated error is small enough"),
        "memory": (None, "Memory that accuracy may take, in GiB [default: all that is free]"),
    },
}
