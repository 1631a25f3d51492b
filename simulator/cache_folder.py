"""Where results are kept between starts: the simulator's folder if its settings name one, else the user's."""

import os
from pathlib import Path

from simulator.scene.disk_cache import DiskCache
from simulator.settings import SimulationSettings

VARIABLE = "SIMULATOR_CACHE_DIR"  # of service_settings; empty keeps nothing


def user_cache_dir() -> Path | None:
    """Folder for topnav below the user's cache folder, $XDG_CACHE_HOME or ~/.cache; None without a home."""
    base = Path(os.environ.get("XDG_CACHE_HOME", ""))
    try:
        return (base if base.is_absolute() else Path("~/.cache").expanduser()) / "topnav"
    except RuntimeError:
        return None


def user_cache() -> DiskCache:
    """The cache of this process's environment, which a simulator started from it uses as well."""
    named = os.environ.get(VARIABLE)
    folder = user_cache_dir() if named is None else Path(named) if named else None
    return DiskCache(folder, SimulationSettings().cache_limit_mb * 1_000_000)
