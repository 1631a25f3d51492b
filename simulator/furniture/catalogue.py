"""Furniture kinds by name. A kind is a function whose keyword arguments, with defaults, are its options."""

import inspect
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from pydantic import ConfigDict, ValidationError, validate_call

from simulator.furniture import (
    basket,
    bench,
    bookshelf,
    chair,
    clock,
    coat_rack,
    coffee_table,
    console,
    curtained_window,
    door,
    lamps,
    paintings,
    panels,
    plant,
    radiator,
    rug,
    seating,
    shoe_cabinet,
    sideboard,
    table,
    television,
)
from simulator.parts import Piece


@dataclass(frozen=True)
class Kind:
    """One kind of furniture."""

    name: str
    function: Callable[..., Piece]

    def check(self, options: dict[str, Any]) -> None:
        """Raise ValueError if an option is unknown or does not fit."""
        known = [name for name in inspect.signature(self.function).parameters if name != "rng"]
        unknown = sorted(set(options) - set(known))
        if unknown:
            raise ValueError(
                f"{self.name} has no option {', '.join(unknown)}; it has {', '.join(known) or 'none'}"
            )
        try:
            self.build(options, 0)
        except ValidationError as error:
            faults = "; ".join(f"{e['loc'][0]}: {e['msg']}, got {e['input']!r}" for e in error.errors())
            raise ValueError(f"{self.name} options: {faults}") from error

    def build(self, options: dict[str, Any], seed: int) -> Piece:
        """Make the piece in its own frame: origin on the floor (or at its anchor), front along +x."""
        checked = validate_call(config=ConfigDict(arbitrary_types_allowed=True))(self.function)
        return checked(np.random.default_rng([seed, *self.name.encode()]), **options)


FURNITURE: dict[str, Kind] = {
    function.__name__: Kind(function.__name__, function)
    for function in (
        seating.sofa,
        seating.armchair,
        seating.pouf,
        table.dining_table,
        chair.chair,
        coffee_table.coffee_table,
        bookshelf.bookshelf,
        bench.tv_bench,
        television.television,
        sideboard.sideboard,
        console.console_table,
        rug.rug,
        paintings.picture,
        lamps.ceiling_light,
        lamps.floor_lamp,
        lamps.table_lamp,
        curtained_window.window,
        door.door,
        plant.plant,
        radiator.radiator,
        coat_rack.coat_rack,
        shoe_cabinet.shoe_cabinet,
        panels.thermostat,
        panels.switch,
        panels.fuse_box,
        panels.mirror,
        clock.clock,
        basket.basket,
    )
}
