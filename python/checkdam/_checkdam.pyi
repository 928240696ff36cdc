from typing import Any, Callable, Dict, List, Optional, Tuple, final

import numpy as np
from numpy.typing import NDArray

__all__ = ["Case", "Simulation", "__version__", "load", "read_table", "read_toml", "run", "study"]
__version__: str

@final
class Case:
    def __getitem__(self, path: str, /) -> Any: ...
    def __setitem__(self, path: str, new: Any, /) -> None: ...
    def __delitem__(self, path: str, /) -> None: ...
    def check(self) -> List[str]: ...
    def to_toml(self) -> str: ...
    def copy(self) -> "Case": ...
    def simulation(self) -> "Simulation": ...
    @property
    def name(self) -> str: ...

@final
class Simulation:
    """A case, driven and read step by step. It belongs to the thread that made it. Arrays are copies: the points are stored
    in blocks that move in memory, so that a view would not stay true."""

    def release(self, threads: Optional[int] = None, progress: Optional[Callable[[Dict[str, Any]], Optional[bool]]] = None) -> None:
        """Settles and tilts, if the case has these stages, then opens gates and inflows and starts the clock."""

    def step(self, count: int = 1) -> None:
        """Makes steps, with the interpreter's lock released."""

    def advance(self, time_s: float) -> None:
        """Steps until a time since the release, s; the last step goes beyond it by less than its length."""

    @property
    def time_s(self) -> float:
        """Time since the release, s; before it, since the start."""

    @property
    def steps(self) -> int:
        """Steps since the start."""

    @property
    def time_step_s(self) -> float:
        """Length of the last step, s."""

    @property
    def bodies(self) -> List[str]:
        """Names of the bodies, in the order of the numbers in ``points()["body"]``."""

    def points(self, body: Optional[str] = None) -> Dict[str, NDArray[Any]]:
        """The material points of all bodies or of one, in the order of bodies and of their numbers.

        body and id (n, int64); x_m (n, 2); velocity_m_per_s (n, 2); stress_pa (n, 4: xx, yy, zz, xy; tension positive);
        volume_ratio_1, current over reference volume; plastic_shear_strain_1; mass_kg. Copies.
        """

    def field(self) -> Dict[str, NDArray[np.float64]]:
        """Means in the cells of the grid that hold what flows.

        x_m, the centres (n, 2); velocity_m_per_s (n, 2); fill_1; pressure_pa, positive in compression; plastic_shear_strain_1. Copies.
        """

    def boundary_forces_n(self) -> Dict[str, NDArray[np.float64]]:
        """Force of each boundary on the material in the last step, N, along x and y."""

    @property
    def barrier_force_n(self) -> Optional[float]:
        """Normal force on the first gauged barrier in the last step, N, positive when it is pushed; None without one."""

    @property
    def barrier_peak(self) -> Optional[Tuple[float, float]]:
        """Largest such force in a step since the release, N, and its time, s."""

    def energy_j(self) -> Dict[str, float]:
        """The energy ledger since the release, J, as in energy.csv, with friction and contact of all surfaces summed up; the residual is
        what is unaccounted for."""

def load(path: str) -> Case: ...
def run(
    case: Case,
    folder: str,
    threads: Optional[int] = None,
    force: bool = False,
    progress: Optional[Callable[[Dict[str, Any]], Optional[bool]]] = None,
) -> bool: ...
def study(
    path: str,
    folder: str,
    threads: Optional[int] = None,
    progress: Optional[Callable[[Dict[str, Any]], Optional[bool]]] = None,
) -> bool: ...
def read_table(path: str) -> Dict[str, Any]: ...
def read_toml(path: str) -> Dict[str, Any]: ...
