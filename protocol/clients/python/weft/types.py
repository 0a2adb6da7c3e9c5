"""What frames and messages hold (PROTOCOL.md sections 3 and 4)."""
from __future__ import annotations

import dataclasses
import typing

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[typing.Any]
Vector = typing.Union[typing.Sequence[float], Array]  #: x, y, z
Turn = typing.Union[typing.Sequence[float], Array]    #: w, x, y, z
Parameter = typing.Union[float, typing.Sequence[float], Array]
Motion = typing.Literal["kinematic", "dynamic"]
Message = typing.Dict[str, typing.Any]  #: JSON
Triple = typing.Tuple[float, float, float]


@dataclasses.dataclass
class Stamp:
    f: int           #: steps since the epoch began
    epoch: int       #: +1 at each reset
    time: float      #: simulated, s
    server_ms: int   #: the server's monotonic clock, ms, modulo 2^32
    paused: bool
    slow: bool       #: the scene's clock runs behind real time


@dataclasses.dataclass(eq=False)
class Cloth:
    cloth: int            #: index in the scene
    level: int            #: of this mesh
    simulated_level: int  #: level at which the cloth is simulated
    quantum: float        #: m; positions are exact to half of it
    positions: npt.NDArray[np.float32]  #: (rows, cols, 3): x, y, z of each node, m; rows along v, columns along u
    #: faces not to be drawn, ascending: row * (cols - 1) + col is the cell right of and below node (row, col)
    torn: typing.List[int] = dataclasses.field(default_factory=list)

    @property
    def rows(self) -> int:
        """Nodes along v."""
        return self.positions.shape[0]

    @property
    def cols(self) -> int:
        """Nodes along u."""
        return self.positions.shape[1]

    def at(self, row: int, col: int) -> Triple:
        """Position of a node, m."""
        x, y, z = self.positions[row, col].tolist()
        return x, y, z


@dataclasses.dataclass
class Ball:
    ball: int
    position: Triple
    radius: float
    motion: Motion


@dataclasses.dataclass
class MovedObstacle:
    obstacle: int  #: its place in the `scene` message
    position: Triple
    quaternion: typing.Tuple[float, float, float, float]  #: w, x, y, z


@dataclasses.dataclass(eq=False)
class Frame:
    stamp: Stamp
    cloths: typing.List[Cloth]
    balls: typing.List[Ball]
    obstacles: typing.List[MovedObstacle]  #: those that are not where `scene` says
