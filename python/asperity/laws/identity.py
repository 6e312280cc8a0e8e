"""The arrays of an adhesion law, by which tables in files are known again."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from .._asperity import Law
from .composite import CutOff, Varying
from .tabulated import Tabulated


def fields(law: Any) -> tuple[NDArray[np.float64] | None, NDArray[np.float64] | None, bool]:
    """Gaps and tractions and the works of adhesion of a law, and whether it may differ from others of its name."""
    law, works = unwrap(law)
    table = np.column_stack([law.gaps, law.tractions]) if isinstance(law, Tabulated) else None
    own = law is not None and not isinstance(law, Law)
    if works is None:
        return table, None, own
    # the law that varies may be one of another work of adhesion than the largest
    return table, np.atleast_2d(works), own or getattr(law, "work_of_adhesion", None) != np.max(works)


def unwrap(law: Any) -> tuple[Any, Any]:
    """The law inside a law that ends or varies, and its works of adhesion."""
    works = None
    while isinstance(law, (CutOff, Varying)):
        if isinstance(law, Varying):
            works = law.work_of_adhesion
        law = law.law
    return law, works
