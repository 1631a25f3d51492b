"""Furniture kinds by name. A kind is a function whose keyword arguments, with defaults, are its options."""

import inspect
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, Literal

import numpy as np
from pydantic import ConfigDict, ValidationError, validate_call

from simulator.assets.folder import AssetFolder
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
    house,
    industry,
    lamps,
    loads,
    lorries,
    mesh,
    office,
    paintings,
    panels,
    pantry,
    plant,
    radiator,
    rug,
    seating,
    shoe_cabinet,
    sideboard,
    street,
    table,
    television,
    trees,
    vehicles,
)
from simulator.scene.parts import Piece
from simulator.world.option_limits import MOST_PARTS, MOST_SIZE_M, check_value, short

FileKind = Literal["model", "picture"]


@dataclass(frozen=True)
class Kind:
    """One kind of furniture."""

    name: str
    function: Callable[..., Piece]
    files: Mapping[str, FileKind] = field(default_factory=dict)  # options that name files

    def options(self) -> list[str]:
        """Names of its options."""
        return [name for name in inspect.signature(self.function).parameters if name != "rng"]

    def opened(self, options: dict[str, Any], folder: AssetFolder | None) -> dict[str, Any]:
        """Put what the files hold in place of their names.

        Raises:
            ValueError: there is no folder to read from, or a file cannot be used.
        """
        read: dict[str, Any] = {}
        for name in self.files.keys() & options.keys():
            value = options[name]
            if value is None or not isinstance(value, str):
                continue
            if folder is None:
                raise ValueError(f"{self.name}.{name}: files are found beside a world file; use load_world")
            try:
                read[name] = folder.model(value) if self.files[name] == "model" else folder.picture(value)
            except ValueError as error:
                raise ValueError(f"{self.name}.{name}: {error}") from error
        return {**options, **read}

    def check(self, options: dict[str, Any]) -> None:
        """Raise ValueError if an option is unknown or does not fit."""
        known = self.options()
        unknown = sorted(str(name) for name in set(options) - set(known))
        if unknown:
            raise ValueError(
                f"{self.name} has no option {', '.join(unknown)[:80]}; it has {', '.join(known) or 'none'}"
            )
        for name, value in options.items():
            check_value(f"{self.name} options: {name}", value)
        try:
            with np.errstate(divide="raise", invalid="raise"):
                piece = self.build(options, 0)
        except ValidationError as error:
            faults = "; ".join(
                f"{e['loc'][0]}: {e['msg']}, got {short(e['input'])}" for e in error.errors() if e["loc"]
            )
            raise ValueError(f"{self.name} options: {faults or error}") from error
        except (ArithmeticError, LookupError, TypeError, ValueError) as error:
            raise ValueError(f"{self.name} cannot be built with these options: {error}") from error
        self._check_piece(piece)

    @cached_property
    def _checked(self) -> Callable[..., Piece]:
        return validate_call(config=ConfigDict(arbitrary_types_allowed=True))(self.function)

    def _check_piece(self, piece: Piece) -> None:
        numbers = [v for part in piece.parts for v in (*part.size_m, *part.centre_m)]
        if len(piece.parts) > MOST_PARTS or not np.isfinite(numbers).all():
            raise ValueError(f"{self.name} must have at most {MOST_PARTS} parts, all of finite size")
        if any(not 0.0 <= side <= MOST_SIZE_M for part in piece.parts for side in part.size_m):
            raise ValueError(f"{self.name} options: sizes must be 0 to {MOST_SIZE_M:g} m; check its options")

    def build(self, options: dict[str, Any], seed: int) -> Piece:
        """Make the piece in its own frame: origin on the floor (or at its anchor), front along +x."""
        return self._checked(np.random.default_rng([seed, *self.name.encode()]), **options)


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
        pantry.kitchen_counter,
        pantry.fridge,
        pantry.vending_machine,
        pantry.water_cooler,
        office.office_chair,
        office.round_table,
        office.whiteboard,
        office.notice_board,
        office.lockers,
        office.copier,
        office.recycling_bins,
        house.house,
        trees.tree,
        trees.hedge,
        trees.flower_bed,
        street.street_light,
        street.bus_stop,
        street.park_bench,
        street.litter_bin,
        street.mailbox,
        street.fountain,
        vehicles.car,
        lorries.truck,
        lorries.forklift,
        loads.pallet_stack,
        loads.drums,
        loads.container,
        industry.machine_tool,
        industry.press,
        industry.workbench,
        industry.pallet_rack,
        industry.pallet_pile,
        industry.conveyor,
        industry.hall_lamp,
        industry.bollard,
        industry.floor_mark,
    )
} | {"mesh": Kind("mesh", mesh.mesh, {"file": "model", "texture": "picture"})}
