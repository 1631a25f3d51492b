"""`topnav study`: the thesis's studies and ours."""

import typer

from experiments.studies.disturbance import main as run_disturbance
from experiments.studies.disturbance_matches import main as disturbance_matches
from experiments.studies.failures import main as failures
from experiments.studies.heading import main as heading
from experiments.studies.heading_frames import main as heading_frames
from experiments.studies.matching import main as matching
from experiments.studies.recovery import main as recovery
from experiments.studies.scale import main as scale
from services.launcher.client.run_record import on_record

app = typer.Typer(add_completion=False, pretty_exceptions_enable=False, no_args_is_help=True)
app.command("heading")(on_record("study heading", heading))
app.command("heading-frames")(on_record("study heading-frames", heading_frames))
app.command("disturbance")(on_record("study disturbance", run_disturbance))
app.command("disturbance-matches")(on_record("study disturbance-matches", disturbance_matches))
app.command("failures")(on_record("study failures", failures))
app.command("matching")(on_record("study matching", matching))
app.command("recovery")(on_record("study recovery", recovery))
app.command("scale")(on_record("study scale", scale))


@app.callback()
def choose() -> None:
    """Studies of the heading methods and the matching."""
