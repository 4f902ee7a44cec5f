"""Flows that turn round: a stream as one law per direction, or refused where nothing says what comes in from behind."""

from dataclasses import dataclass

import numpy as np

from geom.errors import InputError
from lumped.transfer.laws import CLOCK, Array, Inputs, Wrapped

SLACK = 0.02  # of the largest flow: a meter's zero, read as such


@dataclass(frozen=True)
class OneWay(Wrapped):
    """Another law of a flow whose column must not turn negative: its stream has one direction.

    column : the input that carries the flow;  where, right : what is declared one-way, and what to do about it
    usual : size of the flow in the column's unit, besides the largest of the record
    """

    column: str
    where: str
    right: str
    usual: float = 0.0

    def factor(self, inputs: Inputs) -> Array | float:
        flow = np.ravel(np.asarray(inputs[self.column], float))
        back = flow < -SLACK * max(self.usual, float(np.abs(flow).max(initial=0.0)))
        if np.any(back):
            at = int(np.argmax(back))
            time = np.ravel(np.asarray(inputs[CLOCK], float)) if CLOCK in inputs else np.empty(0)
            when = f"t = {time[at]:.6g} s" if at < time.size else f"sample {at + 1}"
            raise InputError(f"the flow turns round: {self.column} = {flow[at]:.4g} at {when}", self.where, self.right)
        return self.base.factor(inputs)


@dataclass(frozen=True)
class Direction(Wrapped):
    """Another law of a flow, in one of its two directions only: `way` +1 as declared, -1 backwards."""

    column: str
    way: int

    def factor(self, inputs: Inputs) -> Array | float:
        flow = np.asarray(inputs[self.column], float)
        return np.asarray(self.base.factor(inputs) * (self.way * flow > 0.0))
