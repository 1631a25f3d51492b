"""Models with damaged bytes: they are read, or refused by an AssetError, and soon."""

from pathlib import Path

import numpy as np
import pytest

from simulator.assets.folder import AssetFolder
from simulator.assets.model import AssetError

MODELS = Path(__file__).parents[4] / "deploy" / "examples" / "worlds" / "models"
ROUNDS = 60


def damaged(data, rng):
    """Some bytes changed, cut out or doubled."""
    kind, at = int(rng.integers(4)), int(rng.integers(min(len(data), 3000)))
    if kind == 0:
        return data[:at]
    if kind == 1:
        return data[:at] + data[at + int(rng.integers(1, 40)) :]
    if kind == 2:
        return data[:at] + bytes(rng.integers(0, 256, 4, np.uint8)) + data[at:]
    changed = bytearray(data)
    for _ in range(int(rng.integers(1, 6))):
        changed[int(rng.integers(min(len(data), 3000)))] = int(rng.choice([*b'0123456789-"{}[],: ', 0, 255]))
    return bytes(changed)


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("name", ["armchair.glb", "vase.glb", "bookcase.obj", "bookcase.mtl"])
def test_damaged_file_is_read_or_refused(tmp_path, name):
    rng = np.random.default_rng([7, *name.encode()])
    for neighbour in MODELS.glob("bookcase.*"):
        (tmp_path / neighbour.name).write_bytes(neighbour.read_bytes())
    target = "bookcase.obj" if name.endswith("mtl") else name
    content = (MODELS / name).read_bytes()
    refused = 0
    for _ in range(ROUNDS):
        (tmp_path / name).write_bytes(damaged(content, rng))
        try:
            model = AssetFolder(tmp_path).model(target)
        except AssetError as error:
            refused += 1
            assert len(str(error)) < 600  # noqa: PT017
        else:
            assert np.isfinite(model.vertices()).all()
    assert refused > 0
