"""The drawings of one round: the plan with the way taken, and what both robots saw at the end."""

from collections.abc import Iterable, Mapping
from pathlib import Path

from services.launcher.drawing.pictures import save_picture
from services.launcher.drawing.plans import Way, draw_way
from services.launcher.evaluation.rounds import Game, Round
from shared.messages.maps import Edge
from shared.messages.simulation import Pose
from simulator.world.world_file import WorldFile


def way_of(played: Round) -> Way:
    """What the plan of a round shows."""
    points = tuple((t.pose.x_m, t.pose.y_m) for t in played.run.truths)
    return Way(points, played.start, played.hider, played.run.via)


def draw_round(
    folder: Path,
    world: WorldFile,
    played: Round,
    poses: Mapping[int, Pose],
    edges: Iterable[Edge],
    game: Game,
) -> None:
    """Write path.png, goal.png, seeker_final.png and hider_final.png into a folder."""
    folder.mkdir(parents=True, exist_ok=True)
    draw_way(folder / "path.png", world, poses, edges, way_of(played))
    save_picture(folder / "goal.png", played.goal)
    save_picture(folder / "seeker_final.png", game.view())
    save_picture(folder / "hider_final.png", game.experimenter.look(played.hider))
