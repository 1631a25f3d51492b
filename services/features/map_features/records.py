"""Packed features in a file that is mapped into memory: the operating system keeps in RAM what is used."""

from tempfile import TemporaryFile

import numpy as np

from services.features.map_features.packing import Packing
from services.features.pipeline.interfaces import FeatureSet

FIRST_CAPACITY = 256
"""Nodes that the first file holds; chosen: the map of a house (deploy/MEASURED.md); it doubles as needed."""


class NodeRecords:
    """A growing row of records. The file has no name, so it is gone when nobody uses it."""

    def __init__(self, packing: Packing) -> None:
        self._packing = packing
        self._records = self._mapped(FIRST_CAPACITY)
        self._written = 0

    @property
    def size_bytes(self) -> int:
        """Room of the records written so far: what lies beyond them was never touched."""
        return self._written * self._packing.record.itemsize

    def put(self, slot: int, features: FeatureSet) -> None:
        """Write one node, beyond the end too.

        Raises:
            ValueError: features of another kind than the packing's.
        """
        record = self._packing.pack(features)
        if slot >= len(self._records):
            larger = self._mapped(max(slot + 1, 2 * len(self._records)))
            larger[: len(self._records)] = self._records
            self._records = larger
        self._records[slot] = record
        self._written = max(self._written, slot + 1)

    def get(self, slot: int) -> FeatureSet:
        """Features of one node."""
        return self._packing.unpack(self._records[slot])

    def _mapped(self, capacity: int) -> np.memmap[tuple[int], np.dtype[np.void]]:
        with TemporaryFile() as file:
            file.truncate(capacity * self._packing.record.itemsize)
            return np.memmap(file, dtype=self._packing.record, mode="r+", shape=(capacity,))
