"""What a command leaves of a run for the console: one small JSON file, which the gateway lists."""

import re
from datetime import UTC
from typing import ClassVar

from pydantic import AwareDatetime, BaseModel, ConfigDict, Field

Figure = int | float | str


class CommandRun(BaseModel):
    """One run of a command.

    Attributes:
        command: words after `topnav`, for example "study heading".
        started, ended: times of the machine that ran it, with their zone.
        world: name, or several separated by commas; empty for a command without a world.
        figures: the few that say how it went; "outcome" among them says how it ended.
        file: the full JSON, where one was asked for.
    """

    FOLDER: ClassVar[str] = "runs"
    """Below the data folder of a stack."""

    model_config = ConfigDict(frozen=True, extra="ignore", allow_inf_nan=False)

    command: str = Field(pattern=r"^[a-z]", max_length=100)
    started: AwareDatetime
    ended: AwareDatetime
    world: str = ""
    map: str | None = None
    seed: int | None = None
    figures: dict[str, Figure] = Field(default_factory=dict)
    file: str | None = None

    @property
    def file_name(self) -> str:
        """Names sort by time: the newest are found without reading the others."""
        words = re.sub(r"[^a-z0-9]+", "-", self.command.lower()).strip("-")
        return f"{self.ended.astimezone(UTC):%Y%m%dT%H%M%SZ}-{words}.json"
