"""The keywords of solves, by the lists of the keys of scenes: types and defaults.

Written by `UPDATE=1 cargo test -p asperity-scene --test keys`.
"""

KEYS = {
    "Surface": {
        "modulus": 'Quantity | None = None',
        "boundary": 'Literal["periodic", "free"] | None = "periodic"',
        "absent_missing": 'bool | None = False',
        "layer": 'Quantity | None = None',
        "base": 'Literal["bonded", "sliding"] | None = None',
        "coating": 'Quantity | None = None',
        "coating_modulus": 'Quantity | None = None',
        "coating_poisson": 'float | None = None',
        "plate": 'Quantity | None = None',
        "poisson": 'float | None = None',
        "against_modulus": 'Quantity | None = None',
        "shift": 'Quantity | tuple[Quantity, Quantity] | None = None',
        "whole": 'bool | None = False',
    },
    "Adhesion": {
        "law": 'Literal["none", "jkr", "maugis-dugdale", "exponential", "lennard-jones", "morse", "power", "van-der-waals"] | OwnLaw | None = None',
        "work_of_adhesion": 'Quantity | None = None',
        "range": 'Quantity | None = None',
        "exponent": 'float | None = None',
        "hamaker": 'Quantity | None = None',
        "cut_off": 'Quantity | None = None',
        "wall": 'Literal["hard", "none", "penalty", "uzawa"] | Penalty | Uzawa | None = "hard"',
        "wall_stiffness": 'Quantity | None = None',
        "hardness": 'Quantity | ArrayLike | None = None',
    },
    "Solver": {
        "method": 'Literal["default", "rey2017"] | None = "default"',
        "tolerance": 'float | None = None',
        "max_iterations": 'int | None = None',
        "precision": 'Literal["f64", "f32"] | None = "f64"',
        "threads": 'int | None = None',
        "branch": 'Literal["loading", "unloading", "both"] | None = None',
    },
    "Load": {
        "mean_gap": 'Quantity | None = None',
        "mean_pressure": 'Quantity | None = None',
        "normal_force": 'Quantity | None = None',
        "approach": 'Quantity | None = None',
        "spring_stiffness": 'Quantity | None = None',
        "spring_position": 'Quantity | None = None',
        "reduced_pressure": 'float | None = None',
        "contact_fraction": 'float | None = None',
    },
    "Loads": {
        "mean_gaps": 'Iterable[Quantity] | None = None',
        "mean_pressures": 'Iterable[Quantity] | None = None',
        "normal_forces": 'Iterable[Quantity] | None = None',
        "approaches": 'Iterable[Quantity] | None = None',
        "spring_stiffness": 'Quantity | None = None',
        "spring_positions": 'Iterable[Quantity] | None = None',
        "reduced_pressures": 'Iterable[float] | None = None',
    },
    "Fractions": {
        "contact_fractions": 'Iterable[float] | None = None',
    },
    "Nested": {
        "nested": 'bool | None = None',
    },
    "Findings": {
        "stability": 'bool | None = False',
        "leave": 'bool | None = False',
        "stiffness": 'bool | None = False',
    },
    "Stiffness": {
        "stiffness": 'bool | None = False',
    },
    "Conductor": {
        "resistivities": 'tuple[Quantity, Quantity] | None = None',
        "conductivities": 'tuple[Quantity, Quantity] | None = None',
    },
    "Leakage": {
        "leakage": 'float | None = None',
    },
    "Accuracy": {
        "accuracy": 'float | None = None',
        "accuracy_of": 'Literal["area", "gap", "approach", "pressure"] | None = None',
        "memory": 'float | None = None',
    },
    "Path": {
        "steps": 'int | None = 50',
        "smallest_step": 'float | None = None',
        "imbalance": 'float | None = 0.0001',
    },
    "CycleAccuracy": {
        "accuracy": 'float | None = None',
        "accuracy_of": 'Literal["work", "tension"] | None = None',
        "memory": 'float | None = None',
    },
    "PullOff": {
        "preload": 'Quantity | None = None',
        "rtol": 'float | None = 0.02',
        "accuracy": 'float | None = None',
        "memory": 'float | None = None',
    },
}
